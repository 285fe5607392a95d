#pragma once

#include <glm/glm.hpp>
#include <span>

#include "luciole/scene.hpp"

namespace luciole {

/// The smallest range, in metres, with which a point has on average at least `density` lights within it; if
/// there are fewer lights, the range with which every point has all. At least 1e-18; infinite without lights
/// or points. Exact, and independent of order and number of threads: a pair counts where the square of its
/// distance, computed in double as dx² + dy² + dz², is below the range's square. Lights must have positions;
/// positions and points are world space, within ±1e18. `density` > 0. O(lights · points) at worst, in
/// parallel.
float rangeForDensity(std::span<const Light> lights, std::span<const glm::dvec3> points, double density);

/// The distance, in metres, where a light that fades with the square of the distance, without a window, has
/// faded to `cutoff` > 0: √(brightest diffuse channel / cutoff), from 1e-18 to 1e18.
float rangeForCutoff(const Light& light, double cutoff);

/// The default density: lights in whose range a point lies, on average.
inline constexpr double kUsualDensity = 8;

/// Makes lights with positions reach everywhere, fading with the square of the distance: attenuation (0,0,1),
/// no range. All colours are multiplied by one factor, with which the light that arrives at the points on
/// average (all channels, whatever the surface's direction) stays what it was with the lights' own ranges and
/// attenuations. A point nearer than a hundredth of a light's range counts as being that far off, so that no
/// pair outshines the others. Black lights stay black, and lights without points keep their colours. Throws
/// InputError where lights reached no point before. The same for any number of threads. O(lights · points),
/// in parallel.
void removeRanges(std::span<Light> lights, std::span<const glm::dvec3> points);

/// The same of lights whose range is the one with which kUsualDensity of them reach a point: so the points
/// are about as bright by any number of lights.
void spreadEverywhere(std::span<Light> lights, std::span<const glm::dvec3> points);

}  // namespace luciole
