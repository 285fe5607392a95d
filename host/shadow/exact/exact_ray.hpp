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

/// The number of lights that no triangle blocks at `start`, a point in the tree's space. It is the result of
/// the beam kernels, for single pairs. lights: BeamLight::place of each, up to kMostSoftSamples; all are
/// positions, or all are directions. One walk tests all of them, so it is fast if they are close to each
/// other. A triangle blocks a light if and only if
/// - it isn't edge-on, and the start lies in the cone from the light through it, rim included: decided
/// exactly
///   (kernels/exact/exact_sign.h) from the tree's float corners;
/// - the start lies behind its plane by more than POINT_ERROR times |x| + |y| + |z| of the start and
///   CORNER_ROUNDING times that of its farthest corner, evaluated in float;
/// - the start isn't in front of the plane through its corners, decided exactly. This plane and the rounded
/// one of the
///   rule before may differ near the triangle;
/// - its material has no holes, or is_hole returns false. is_hole is called for no other triangle.
///
/// At its own position a light is unblocked. likely: a block of the tree to be tested first; set to a block
/// that blocks a light, if any does. The result doesn't depend on it.
std::size_t countUnblocked(const TriangleTree& tree, const glm::vec3& start, std::span<const float4> lights,
                           const HoleTest& is_hole, std::optional<std::size_t>& likely);

/// Whether a triangle blocks the light's centre at `start`.
bool isBlocked(const TriangleTree& tree, const glm::vec3& start, const BeamLight& light,
               const HoleTest& is_hole);

}  // namespace luciole
