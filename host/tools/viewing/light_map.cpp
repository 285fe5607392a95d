#include "tools/viewing/light_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "image/heat_map.hpp"
#include "kernels/shared.h"
#include "shadow/maps/draw_shadow_maps.hpp"
#include "shadow/maps/shadow_maps.hpp"

namespace luciole {
namespace {

/// The distance of a reversed depth above 0: the inverse of the lookups' (kernels/maps/shadow.clh).
double metresOf(const ShadowMap& map, float depth) {
  if (map.kind == kParallelMap) return (1 - double(depth)) / double(map.depth_offset);
  return double(map.depth_scale) / (double(depth) - double(map.depth_offset));
}

LightFace namedFace(const ShadowMap& map, std::size_t face) {
  if (map.kind == kParallelMap) return {fmt::format("cascade{}", face), "", {}};
  if (map.kind != kCubeMap) return {};
  constexpr const char* kAxes[]{"x", "y", "z"};
  return {fmt::format("{}_{}", face % 2 ? "negative" : "positive", kAxes[face / 2]),
          kAxes[(face / 2 + 1) % 3],
          {}};
}

}  // namespace

LightMap drawLightMap(const Scene& scene, const View& camera_view, std::uint32_t light,
                      const ShadowLimits& limits) {
  ShadowMaps maps = planShadowMaps(scene, camera_view, ShadowMethod::kHard, limits);
  LightMap result;
  const std::uint32_t number = maps.map_of_light[light];
  if (number == kNoShadow) return result;
  const ShadowMap& map = maps.maps[number];
  std::vector<std::uint32_t> needed(maps.bin_count, kNotNeeded);
  for (std::size_t i = map.first_face; i < map.first_face + map.face_count; ++i) {
    const ShadowFace& face = maps.faces[i];
    std::fill_n(needed.begin() + face.first_bin, face.bins * face.bins, 0u);  // down to the depth 0
  }
  drawNeeded(scene, needed, maps);
  for (std::size_t i = 0; i < map.face_count; ++i) {
    const ShadowFace& face = maps.faces[map.first_face + i];
    LightFace drawn = namedFace(map, i);
    result.size = maps.planned[map.first_face + i].view.size.x;
    for (int y = 0; y < result.size; ++y)
      for (int x = 0; x < result.size; ++x) {
        const float depth = maps.texels[uint(face.first + uint(y) * face.width + uint(x))].depth;
        drawn.metres.push_back(depth > 0 ? float(metresOf(map, depth))
                                         : std::numeric_limits<float>::infinity());
      }
    result.faces.push_back(std::move(drawn));
  }
  return result;
}

Image lightMapPicture(const LightMap& map, const std::string& title) {
  /// Pixels a side of a face in a picture of several: of larger maps only some texels are shown.
  constexpr int kLargestShown = 512;
  const int step = (map.size + kLargestShown - 1) / kLargestShown, side = (map.size + step - 1) / step;
  std::vector<ValuePanel> panels;
  for (const LightFace& face : map.faces) {
    std::string label = face.name;
    std::replace(label.begin(), label.end(), '_', ' ');
    if (!face.up.empty()) label += ", up is " + face.up;
    panels.push_back({label, {}});
    for (int y = 0; y < map.size; y += step)
      for (int x = 0; x < map.size; x += step)
        panels.back().values.push_back(face.metres[std::size_t(y) * map.size + x]);
  }
  const int columns = panels.size() == 6 ? 3 : 2;
  return valueSheet(side, side, panels, columns,
                    title + (step > 1 ? fmt::format(", 1 texel of {} x {}", step, step) : ""));
}

}  // namespace luciole
