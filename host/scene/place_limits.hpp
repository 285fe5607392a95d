#pragma once

#include "scene/scene.hpp"

namespace luciole {

/// Refuses what lies farther than kLargestNumber from the origin along an axis once everything is placed, and
/// pictures that are larger: what scene files can't say, mesh files and products of transforms can. Squares
/// of coordinates are then finite floats. Throws InputError.
void checkPlaces(const Scene& scene);

}  // namespace luciole
