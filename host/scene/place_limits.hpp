#pragma once

#include "scene/scene.hpp"

namespace luciole {

/// In magnitude, of any number of a scene: its square is a finite float.
inline constexpr double kLargestNumber = 1e18;

/// Refuses what lies farther than kLargestNumber from the origin along an axis once everything is placed, and
/// pictures that are larger: what scene files can't say, mesh files and products of transforms can. Throws
/// InputError.
void checkPlaces(const Scene& scene);

}  // namespace luciole
