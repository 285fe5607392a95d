#include "shadow/maps/shadow_maps.hpp"

#include "raster/bins.hpp"
#include "scene/bounds.hpp"

namespace luciole {

ShadowMaps planShadowMaps(const Scene& scene, const View& camera_view, ShadowMethod method,
                          const ShadowLimits& limits, std::span<const ShadowWay> ways) {
  ShadowMaps result;
  result.method = method;
  result.map_of_light.assign(scene.lights.size(), kNoShadow);
  const PlanInput input{camera_view, method, glm::inverse(camera_view.world_to_view), sceneBounds(scene),
                        ways};
  if (input.bounds.low.x > input.bounds.high.x) return result;

  const ShadowSizes chosen = chooseSizes(scene, input, limits);
  result.reduced_lights = chosen.reduced_lights;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const int size = chosen.sizes[i];
    if (size == 0) continue;
    PlannedMap map = planMap(scene.lights[i], input, size);
    map.lookup.first_face = static_cast<uint>(result.faces.size());
    map.lookup.face_count = static_cast<uint>(map.faces.size());
    result.map_of_light[i] = static_cast<std::uint32_t>(result.maps.size());
    result.maps.push_back(map.lookup);
    for (ShadowFace face : map.faces) {
      face.bins = uint((size + kBinSize - 1) / kBinSize);
      face.first_bin = uint(result.bin_count);
      result.bin_count += std::size_t(face.bins) * face.bins;
      result.faces.push_back(face);
    }
    for (const View& view : map.views)
      result.planned.push_back({.light = static_cast<std::uint32_t>(i), .view = view, .farthest = {}});
    result.planned_texels += map.views.size() * std::size_t(size) * size;
  }
  if (!result.maps.empty()) result.meshlets = findMeshlets(scene);
  return result;
}

}  // namespace luciole
