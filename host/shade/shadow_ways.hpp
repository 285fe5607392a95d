#pragma once

#include <span>
#include <vector>

#include "luciole/scene.hpp"
#include "luciole/settings.hpp"
#include "raster/view.hpp"
#include "shade/features.hpp"

namespace luciole {

/// The work of a light's shadows in a whole picture, estimated in O(1) from the light's reach, the scene's
/// bounds and the view.
struct ShadowWork {
  double points = 0;     ///< shaded points in the light's reach
  double triangles = 0;  ///< in its reach
  double faces = 0;      ///< of its map
  double texels = 0;     ///< of its map
};

/// Estimated milliseconds of a scene's shadows by either way, on two cores of an AMD EPYC of 2024.
struct ShadowCosts {
  double tree = 0;              ///< of the triangle tree, for all beams
  double plan = 0;              ///< of planning all maps
  std::vector<double> beams{};  ///< of each light; 0 for those without shadows
  std::vector<double> maps{};
};

/// The estimated number of shaded points of a pixel that shows a surface. shared: samples of the same surface
/// share a point.
double shadedPoints(const Scene& scene, glm::ivec2 size, int samples, bool shared);

/// The work of each light with a shadow; zeros for others. view: of the whole picture, whatever its crop.
std::vector<ShadowWork> shadowWork(const Scene& scene, const View& view, double points_a_pixel,
                                   const ShadowLimits& limits);

/// Estimated milliseconds of a light's beams: ShadowCosts::beams.
double beamMilliseconds(const ShadowWork& work, bool holes);

/// triangles: of the scene. holes: some materials have holes, which take rays.
ShadowCosts shadowCosts(double triangles, bool holes, std::span<const ShadowWork> work);

/// The cheapest way of each light that casts shadows, with the times of maps multiplied by kMapsPayFrom.
std::vector<ShadowWay> cheapestWays(const ShadowCosts& costs, const std::vector<bool>& casts);

/// The way of each light with ShadowMethod::kAuto: beams, which are exact, unless maps are estimated to be at
/// least kMapsPayFrom times as fast. Nothing is timed and the crop doesn't matter, so the same scene and
/// settings give the same ways on every machine. If not even the coarsest maps fit into limits.bytes all are
/// beams. view, points_a_pixel, limits: see shadowWork. casts: of each light whether it needs a way.
/// O(vertices + lights).
std::vector<ShadowWay> shadowWays(const Scene& scene, const View& view, double points_a_pixel,
                                  const ShadowLimits& limits, const std::vector<bool>& casts);

inline constexpr double kMapsPayFrom = 2;

}  // namespace luciole
