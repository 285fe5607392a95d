#pragma once

#include <span>
#include <vector>

#include "luciole/scene.hpp"
#include "luciole/settings.hpp"
#include "raster/view.hpp"
#include "shade/features.hpp"

namespace luciole {

/// How much a light's shadows would be to do, in a whole picture. Estimated in O(1) from the light's reach,
/// the scene's bounds and the view; nothing is drawn for it.
struct ShadowWork {
  double points = 0;     ///< that are shaded in the light's reach
  double triangles = 0;  ///< in its reach
  double faces = 0;      ///< of its map
  double texels = 0;     ///< of its map
};

/// Milliseconds of a scene's shadows by either way, about, on kEstimateMachine.
struct ShadowCosts {
  double tree = 0;              ///< of the triangle tree, which all beams share
  double plan = 0;              ///< of what all maps share
  std::vector<double> beams{};  ///< of each light; 0 for those without shadows
  std::vector<double> maps{};
};

/// The points that are shaded for a pixel that shows a surface, about. shared: see sharesSamples.
double shadedPoints(const Scene& scene, glm::ivec2 size, int samples, bool shared);

/// The work of each light with a shadow; zeros for others. view: of the whole picture, whatever its crop.
std::vector<ShadowWork> shadowWork(const Scene& scene, const View& view, double points_a_pixel,
                                   const ShadowLimits& limits);

/// triangles: of the scene; holes: textures have some, through which rays must look.
ShadowCosts shadowCosts(double triangles, bool holes, std::span<const ShadowWork> work);

/// The cheapest way of each light that casts shadows, where maps' times count kMapsPayFrom times.
std::vector<ShadowWay> cheapestWays(const ShadowCosts& costs, const std::vector<bool>& casts);

/// The way of each light by ShadowMethod::kAuto: beams, which are exact, unless maps are at least
/// kMapsPayFrom times as fast. No time is measured and the crop doesn't matter, so the same scene and
/// settings give the same ways everywhere. Where not even the coarsest maps fit into limits.bytes all are
/// beams. view, points_a_pixel, limits: see shadowWork. O(vertices + lights).
std::vector<ShadowWay> shadowWays(const Scene& scene, const View& view, double points_a_pixel,
                                  const ShadowLimits& limits);

inline constexpr double kMapsPayFrom = 2;

}  // namespace luciole
