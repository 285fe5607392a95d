#pragma once

#include <glm/glm.hpp>
#include <span>

#include "scene/scene.hpp"

namespace luciole {

/// The smallest range with which a point has at least `density` of the lights nearer to it than that, in the
/// mean over the points; with which every point has every light, if there are fewer. At least 1e-18 m;
/// infinite where there are no lights or no points. Exact, and the same for any order and number of threads:
/// a pair counts where the square of its distance, computed in double as dx² + dy² + dz², is below the
/// range's. Lights have positions, within ±1e18 as the points. `density` > 0.
float rangeForDensity(std::span<const Light> lights, std::span<const glm::dvec3> points, double density);

/// Where a light that fades with the square of the distance, without a window, has faded to `cutoff` > 0: the
/// root of its brightest diffuse channel / cutoff. From 1e-18 to 1e18 m.
float rangeForCutoff(const Light& light, double cutoff);

}  // namespace luciole
