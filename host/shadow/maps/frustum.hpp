#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "raster/view.hpp"
#include "scene/bounds.hpp"

namespace luciole {

/// A convex hexahedron in world space, metres: a box, or what a view can see. Corner i has bit 0: x, bit 1:
/// y, bit 2: z at its high side.
using Corners = std::array<glm::dvec3, 8>;

/// The corners of an axis-aligned box.
Corners boxCorners(const Bounds& box);

/// The corners of a view's frustum, without its crop. Axes are those of normalized device coordinates with
/// reversed depth: corners 0 to 3 lie on the far plane, and corner i + 4 on the near plane in front of corner
/// i. An infinite far plane is replaced by one at `farthest` metres.
Corners viewCorners(const View& view, double farthest);

/// Points whose convex hull is the intersection of two hexahedra. Points may repeat. None: they don't
/// intersect.
std::vector<glm::dvec3> commonCorners(const Corners& a, const Corners& b);

/// The planes around the part of space that a view's crop shows: left, right, bottom, top, near, far. World
/// space (n, d) with n·p + d ≥ 0 inside; n has any length.
std::array<glm::dvec4, 6> cropPlanes(const View& view);

}  // namespace luciole
