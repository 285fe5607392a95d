#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "rays/ray_cast.hpp"

namespace luciole {

/// A pixel and a light that may shine on it.
struct LightPair {
  std::uint32_t pixel;  ///< its place in the G-buffer's planes
  std::uint32_t light;  ///< index into Scene::lights
  bool operator==(const LightPair&) const = default;
};

/// All pairs that a shadow decides about: the light has `shadow`, the pixel shows a surface whose normal
/// faces it, and the surface is nearer than the light's range and inside its cutoff. Ordered by tile, then by
/// light, then by the pixels' Z order, so that rays of neighbouring pairs are similar. O(tiles · lights +
/// pairs), on all cores.
std::vector<LightPair> facingPairs(const Scene& scene, const GBuffer& gbuffer);

struct TracedShadows {
  std::vector<std::uint8_t> lit;  ///< for each pair, 1: nothing is between the pixel and the light
  /// Wall-clock time from the G-buffer and the pairs to `lit`. It includes making the rays, as any user of
  /// Embree must, but not building `rays`.
  double milliseconds = 0;
};

/// The truth about the pairs' shadows, by rays from the pixels to the lights' middles, as if lights had no
/// size. rays: by buildShadowRays() for this scene and the G-buffer's eye.
TracedShadows traceTruth(const Scene& scene, const RayScene& rays, const GBuffer& gbuffer,
                         std::span<const LightPair> pairs);

/// Returns the metres, > 0, that a texel of a light's map covers at a point, measured across the light's
/// rays. Many threads call it at once.
using TexelSide = std::function<double(std::uint32_t light, const glm::dvec3& world_point)>;

/// The largest distance along the light's rays back to the plane in nearEdges(), in texels. On surfaces at a
/// slope of less than 1/20 to the rays a texel covers more than any map can resolve.
inline constexpr double kLongestWayBack = 20;

/// For each pair, 1 if the truth changes within a texel of it, so that no map can be expected to get it
/// right. Eight points around the pair's are traced. Each is a texel away across the light's rays, then moved
/// along the rays back to the plane of the pixel's triangle, but by at most kLongestWayBack texels. If shadow
/// tests start on the smooth surface above the triangle, its tangent plane is taken. The points may lie
/// beyond the triangle's rim. flat_normals: a G-buffer of the same view with Shading::kFlat; lit: by
/// traceTruth().
std::vector<std::uint8_t> nearEdges(const Scene& scene, const RayScene& rays, const GBuffer& gbuffer,
                                    const GBuffer& flat_normals, std::span<const LightPair> pairs,
                                    std::span<const std::uint8_t> lit, const TexelSide& texel_side);

/// Numbers of pairs by the truth about them, and how many of those a shadow map gets wrong.
struct ShadowErrors {
  std::uint64_t lit = 0, dark = 0;  ///< away from edges
  std::uint64_t wrongly_dark = 0;   ///< of `lit`
  std::uint64_t wrongly_lit = 0;    ///< of `dark`
  std::uint64_t edges = 0, wrong_edges = 0;
  double brighter = 0;  ///< the sum over all pairs of visibility minus truth
  bool operator==(const ShadowErrors&) const = default;
};

/// Counts the errors of a shadow map. For each pair: lit by traceTruth(), edge by nearEdges(), and the map's
/// visibility in [0, 1], where 0.5 and more count as lit.
ShadowErrors judge(std::span<const std::uint8_t> lit, std::span<const std::uint8_t> edge,
                   std::span<const float> visibility);

}  // namespace luciole
