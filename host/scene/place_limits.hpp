#pragma once

#include "luciole/scene.hpp"

namespace luciole {

/// The largest magnitude of a number in a scene; its square is a finite float.
inline constexpr double kLargestNumber = 1e18;

/// Throws InputError if a vertex, a light or a camera has a world coordinate beyond ±kLargestNumber, or if
/// half the height of an orthographic picture is larger. Needed for mesh files and products of transforms;
/// other numbers of scene files are limited when they are read. O(vertices of the meshes + objects), and
/// O(vertices) for each object whose bounding box exceeds the limit.
void checkPlaces(const Scene& scene);

}  // namespace luciole
