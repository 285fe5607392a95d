#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gbuffer/gbuffer.hpp"
#include "rays/ray_cast.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// A pixel and a light that may shine on it.
struct LightPair {
  std::uint32_t pixel;  ///< its place in the G-buffer's planes
  std::uint32_t light;  ///< index into Scene::lights
  bool operator==(const LightPair&) const = default;
};

/// Every pair that a shadow decides about: the light has `shadow`, and would light the pixel if nothing were
/// in its way, because the pixel shows a surface whose normal leans towards the light, nearer than its range
/// and inside its cutoff. By tile, in it by light, and under that in the pixels' Z order, so that rays of
/// pairs that follow each other go much the same way.
std::vector<LightPair> facingPairs(const Scene& scene, const GBuffer& gbuffer);

struct TracedShadows {
  std::vector<std::uint8_t> lit;  ///< one a pair, 1: nothing is between the pixel and the light
  /// What it took, from the G-buffer and the pairs to `lit`: as any user of Embree must, it makes the rays, a
  /// few packets at a time. Building `rays` is not in it.
  double milliseconds = 0;
};

/// The truth about the pairs' shadows, by rays from the pixels to the lights' middles: as if they had no
/// size. `rays`: by buildShadowRays for this scene and the G-buffer's eye.
TracedShadows traceTruth(const Scene& scene, const RayScene& rays, const GBuffer& gbuffer,
                         std::span<const LightPair> pairs);

/// Metres across the light's rays that one texel of that light's map covers at a point, > 0. Called by many
/// threads at once.
using TexelSide = std::function<double(std::uint32_t light, const glm::dvec3& world_point)>;

/// Longest way back into the plane in nearEdges, in texels: where a surface leans from the light's rays by
/// less than 1/20, a texel covers more of it than any map could do right.
inline constexpr double kLongestWayBack = 20;

/// One a pair, 1: the truth changes within a texel of it, so that a map can't be held to it. Eight points
/// around it are asked: one texel away across the light's rays, and from there along them back into the plane
/// of the pixel's triangle, or of the smooth surface above it where shadow tests start there, or
/// kLongestWayBack texels towards it where that is less. They may lie beyond the triangle's rim.
/// `flat_normals`: a G-buffer of the same view by Shading::kFlat. `lit`: what traceTruth says of the pairs.
std::vector<std::uint8_t> nearEdges(const Scene& scene, const RayScene& rays, const GBuffer& gbuffer,
                                    const GBuffer& flat_normals, std::span<const LightPair> pairs,
                                    std::span<const std::uint8_t> lit, const TexelSide& texel_side);

/// Pairs by what is true of them, and how many of those a shadow map gets wrong.
struct ShadowErrors {
  std::uint64_t lit = 0, dark = 0;  ///< away from edges
  std::uint64_t wrongly_dark = 0;   ///< of `lit`
  std::uint64_t wrongly_lit = 0;    ///< of `dark`
  std::uint64_t edges = 0, wrong_edges = 0;
};

/// `lit` and `edge` as traceTruth and nearEdges give them; `visibility`: the share of the light that the map
/// lets through, of which from 0.5 on it says lit. All one a pair.
ShadowErrors judge(std::span<const std::uint8_t> lit, std::span<const std::uint8_t> edge,
                   std::span<const float> visibility);

}  // namespace luciole
