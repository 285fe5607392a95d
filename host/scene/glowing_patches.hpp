#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// A part of a glowing surface, which a light stands for. World, metres.
struct GlowingPatch {
  glm::dvec3 place{0.0};     ///< on the surface
  glm::dvec3 normal{0.0};    ///< unit
  glm::vec3 radiance{0.0f};  ///< the mean over its area
  double area = 0;           ///< m²
  bool double_sided = false;
};

/// Whether some triangle's material has an emission. O(triangles).
bool glows(const Scene& scene, const Object& object);

/// Divides an object's triangles that glow, of one material or, if empty, of all, into `count` parts at most:
/// triangles, or pieces of them about as large as a texel of what they emit, in the order of a Z curve, cut
/// so that parts share ∫ L dA evenly, L the luminance. Textures count texel by texel, as far as 2²² pieces
/// go. Deterministic. O(pieces · log pieces).
std::vector<GlowingPatch> glowingPatches(const Scene& scene, const Object& object,
                                         std::optional<std::uint32_t> material, std::uint32_t count);

}  // namespace luciole
