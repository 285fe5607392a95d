#include "render/pair_visibility.hpp"

#include <algorithm>

namespace luciole {

std::vector<float> pairVisibility(Device& device, const std::string& defines, const GBuffer& gbuffer,
                                  const ShadowMaps& shadows, std::span<const MapPair> pairs) {
  // A row of lanes shares its map; what a row has no pair for repeats the one before.
  const std::size_t lanes = std::size_t(device.description.lanes);
  std::vector<std::size_t> first_of_row, rows_end;
  for (std::size_t i = 0; i < pairs.size();) {
    std::size_t end = i + 1;
    while (end < pairs.size() && end < i + lanes && pairs[end].map == pairs[i].map) ++end;
    first_of_row.push_back(i);
    rows_end.push_back(end);
    i = end;
  }
  const std::size_t slots = first_of_row.size() * lanes, stride = gbuffer.pixels();
  Plane points(3 * slots), normals(3 * slots), lifts(slots), seen(slots);
  PackedNormals facets(slots);
  std::vector<cl_uint> map_of_row;
  for (std::size_t row = 0; row < first_of_row.size(); ++row) {
    map_of_row.push_back(pairs[first_of_row[row]].map);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t pixel = pairs[std::min(first_of_row[row] + lane, rows_end[row] - 1)].pixel;
      const std::size_t slot = row * lanes + lane;
      for (std::size_t c = 0; c < 3; ++c) {
        points[c * slots + slot] = gbuffer.position[c * stride + pixel];
        normals[c * slots + slot] = gbuffer.normal[c * stride + pixel];
      }
      facets[slot] = gbuffer.facet[pixel];
      if (!gbuffer.lift.empty()) lifts[slot] = gbuffer.lift[pixel];
    }
  }
  const cl::Buffer position = inputBuffer(device, points), normal = inputBuffer(device, normals);
  const cl::Buffer facet = inputBuffer(device, facets), lift = inputBuffer(device, lifts);
  const cl::Buffer result = outputBuffer(device, seen.data(), slots * sizeof(float));
  const cl::Buffer map_buffer = inputBuffer(device, map_of_row), maps = inputBuffer(device, shadows.maps),
                   faces = inputBuffer(device, shadows.faces), texels = inputBuffer(device, shadows.texels);
  Kernel kernel = makeKernel(device, "pair_visibility.cl", "pair_visibility", defines);
  kernel.setArg(0, static_cast<cl_uint>(slots));
  kernel.setArg(1, position);
  kernel.setArg(2, normal);
  kernel.setArg(3, facet);
  kernel.setArg(4, lift);
  kernel.setArg(5, map_buffer);
  kernel.setArg(6, maps);
  kernel.setArg(7, faces);
  kernel.setArg(8, texels);
  kernel.setArg(9, static_cast<cl_uint>(std::max<std::size_t>(shadows.texels.size(), 1)));
  kernel.setArg(10, result);
  launch(device, kernel, first_of_row.size(), 1);
  readBuffer(device, result, seen.data(), slots * sizeof(float));
  std::vector<float> visibility;
  for (std::size_t row = 0; row < first_of_row.size(); ++row)
    for (std::size_t i = first_of_row[row]; i < rows_end[row]; ++i)
      visibility.push_back(seen[row * lanes + i - first_of_row[row]]);
  return visibility;
}

}  // namespace luciole
