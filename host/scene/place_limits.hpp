#pragma once

#include "luciole/scene.hpp"

namespace luciole {

/// The largest magnitude of a number in a scene; its square is a finite float.
inline constexpr double kLargestNumber = 1e18;

/// Throws InputError where a vertex, a light's position or a camera has a world coordinate beyond
/// ±kLargestNumber, or half an orthographic picture's height is larger. Numbers of scene files are limited
/// already, but those of mesh files and products of transforms aren't. O(vertices of the meshes + objects),
/// and O(vertices) for each object whose bounding box is beyond.
void checkPlaces(const Scene& scene);

}  // namespace luciole
