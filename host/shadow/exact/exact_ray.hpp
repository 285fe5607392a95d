#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "kernels/shared.h"
#include "shadow/exact/triangle_tree.hpp"

namespace luciole {

/// Whether a triangle, counted through all objects in order, has a hole where its corners have these weights,
/// which are ≥ 0 and have a sum of 1.
using HoleTest = std::function<bool(std::uint32_t triangle, const glm::dvec3& weights)>;

/// How many of some lights nothing blocks at `start`, a point in the tree's space: the answer for single
/// pairs that the kernels of beams give for many. lights: BeamLight::place of each, up to kMostSoftSamples;
/// all have a place, or none has. They are asked about together, so it is fast where they are close to each
/// other. A triangle blocks a light if and only if
/// - it isn't edge-on, and the start lies in the cone from the light through it, rim included: decided
///   exactly (kernels/exact/exact_sign.h) from the corners as the tree has them;
/// - the start lies behind its plane by more than POINT_ERROR times |x| + |y| + |z| of the start and
///   CORNER_ROUNDING times that of its farthest corner, evaluated in float;
/// - the start isn't in front of its corners, decided exactly. Planes aren't rounded as corners are, so along
///   the triangle the two rules may differ;
/// - its material has no holes, or is_hole says that there is none. It is asked about no other triangle.
///
/// Nothing blocks the light at the very place of it. likely: a block of the tree that is asked first; set to
/// one that blocks, if any does. The answer doesn't depend on it.
std::size_t countUnblocked(const TriangleTree& tree, const glm::vec3& start, std::span<const float4> lights,
                           const HoleTest& is_hole, std::optional<std::size_t>& likely);

/// Whether something blocks the light, whose size doesn't matter, at `start`.
bool isBlocked(const TriangleTree& tree, const glm::vec3& start, const BeamLight& light,
               const HoleTest& is_hole);

}  // namespace luciole
