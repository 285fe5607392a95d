#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "shadow/maps/shadow_maps.hpp"

// Where shadow maps are looked up, in double and by the views that their faces were drawn with, whatever the
// kernels make of it.
namespace luciole::test {

/// A place on a face.
struct TexelPlace {
  std::size_t face;   ///< index into ShadowMaps::faces
  glm::dvec2 texel;   ///< of the whole face, from its top left corner
  double depth;       ///< reversed, of the point
  double depth_step;  ///< of depth, for a metre along the axis that the face looks along
  double side;        ///< of a texel there, metres across the axis that the face looks along
  double from_limit;  ///< texels to where another face, or none, would be looked up
};

/// Where a face shows a world-space point, in texels; nothing behind the light.
inline std::optional<glm::dvec2> texelOn(const PlannedFace& face, const glm::dvec3& point) {
  const glm::dvec4 clip = face.view.projection * (face.view.world_to_view * glm::dvec4(point, 1));
  if (!(clip.w > 0)) return std::nullopt;
  return 0.5 * glm::dvec2(face.view.size) * glm::dvec2(1 + clip.x / clip.w, 1 - clip.y / clip.w);
}

/// Where a map is looked up for a world-space point.
inline std::optional<TexelPlace> placeOf(const ShadowMaps& maps, const ShadowMap& map,
                                         const glm::dvec3& point) {
  for (std::size_t i = map.first_face; i < map.first_face + map.face_count; ++i) {
    const PlannedFace& face = maps.planned[i];
    const auto texel = texelOn(face, point);
    if (!texel) continue;
    const double limit = maps.faces[i].high;
    const double inside =
        std::min(std::min(texel->x, texel->y) - int(map.filter_radius), limit - std::max(texel->x, texel->y));
    if (inside < 0) continue;
    const glm::dvec4 seen = face.view.world_to_view * glm::dvec4(point, 1);
    const glm::dvec4 clip = face.view.projection * seen;
    const bool parallel = map.kind == kParallelMap;
    const double side = (parallel ? 1 : -seen.z) / maps.faces[i].scale;
    const double step = parallel ? std::abs(face.view.projection[2][2])
                                 : std::abs(face.view.projection[3][2]) / (seen.z * seen.z);
    return TexelPlace{i, *texel, clip.z / clip.w, step, side, inside};
  }
  return std::nullopt;
}

/// All of every face, however far away: see findNeeded().
inline std::vector<std::uint32_t> everything(const ShadowMaps& maps) {
  return std::vector<std::uint32_t>(maps.bin_count, 0u);
}
inline std::vector<std::uint32_t> nothing(const ShadowMaps& maps) {
  return std::vector<std::uint32_t>(maps.bin_count, kNotNeeded);
}

/// Down to which depth the bin that holds a texel was drawn; infinity: not drawn.
inline float drawnDownTo(const ShadowMaps& maps, std::size_t face, const glm::ivec2& texel) {
  const std::vector<float>& farthest = maps.planned[face].farthest;
  const glm::ivec2 bin = texel / int(kShadowBin);
  return farthest.empty() ? std::numeric_limits<float>::infinity()
                          : farthest.at(std::size_t(bin.y) * maps.faces[face].bins + bin.x);
}

/// A texel of a face that was drawn.
inline const ShadowTexel& texelOf(const ShadowMaps& maps, std::size_t face, int x, int y) {
  return maps.texels.at(maps.faces[face].first + uint(y) * maps.faces[face].width + uint(x));
}

}  // namespace luciole::test
