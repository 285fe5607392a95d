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

/// The view volume, whatever the crop; its axes are those of normalized device coordinates. Depth is
/// reversed, so corners 0 to 3 lie on the far plane and i + 4 on the near plane before i. Of a view without
/// end that plane is taken for `farthest` metres away.
Corners viewCorners(const View& view, double farthest);

/// The intersection of two hexahedra, as points whose convex hull it is. Points may repeat; there are none
/// where the hexahedra don't intersect.
std::vector<glm::dvec3> commonCorners(const Corners& a, const Corners& b);

/// The planes around the part of space that a view's crop shows: left, right, bottom, top, near, far. World
/// space (n, d) with n·p + d ≥ 0 inside; n has any length.
std::array<glm::dvec4, 6> cropPlanes(const View& view);

}  // namespace luciole
