#include "tools/bench/pair_visibility.hpp"

#include <algorithm>

#include "cl/launch.hpp"
#include "shade/shade.hpp"

namespace luciole {

std::vector<float> pairVisibility(OpenedDevice& device, const std::string& defines, const GBuffer& gbuffer,
                                  const ShadowMaps& shadows, std::span<const MapPair> pairs) {
  // A row of lanes shares its map. Lanes without a pair repeat the row's last one.
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
  PackedNormals surface_normals(slots);
  std::vector<uint> map_of_row;
  for (std::size_t row = 0; row < first_of_row.size(); ++row) {
    map_of_row.push_back(pairs[first_of_row[row]].map);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t pixel = pairs[std::min(first_of_row[row] + lane, rows_end[row] - 1)].pixel;
      const std::size_t slot = row * lanes + lane;
      for (std::size_t c = 0; c < 3; ++c) {
        points[c * slots + slot] = gbuffer.position[c * stride + pixel];
        normals[c * slots + slot] = gbuffer.normal[c * stride + pixel];
      }
      surface_normals[slot] = surfaceNormals(gbuffer)[pixel];
      if (!gbuffer.lift.empty()) lifts[slot] = gbuffer.lift[pixel];
    }
  }
  const Buffer<float> visible = borrowedForOutput(device, seen);
  Kernel kernel = makeKernel(device, "maps/pair_visibility.cl", "pair_visibility", defines);
  launch(device, kernel,
         {{"stride", uint(slots)},
          {"position", borrowed(device, points)},
          {"normal", borrowed(device, normals)},
          {"surface_normal", borrowed(device, surface_normals)},
          {"lift", borrowed(device, lifts)},
          {"map_of_row", borrowed(device, map_of_row)},
          {"maps", borrowed(device, shadows.maps)},
          {"faces", borrowed(device, shadows.faces)},
          {"texels", borrowed(device, shadows.texels)},
          {"texel_count", uint(std::max<std::size_t>(shadows.texels.size(), 1))},
          {"visibility", visible}},
         {.items = first_of_row.size()});
  download(device, visible, seen);
  std::vector<float> visibility;
  for (std::size_t row = 0; row < first_of_row.size(); ++row)
    for (std::size_t i = first_of_row[row]; i < rows_end[row]; ++i)
      visibility.push_back(seen[row * lanes + i - first_of_row[row]]);
  return visibility;
}

}  // namespace luciole
