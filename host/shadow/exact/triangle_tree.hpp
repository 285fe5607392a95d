#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared.h"
#include "luciole/array_memory.hpp"
#include "luciole/scene.hpp"

namespace luciole {

/// The tree of boxes over a scene's triangles, with kTreeWidth children a node, and leaves of up to
/// kTreeWidth triangles, the blocks.
///
///     nodes      box┬box┬box┬ …           16 boxes a node
///     children    1 │~0 │ 2 │ …           16 a node: a node's index, or ~(a block's index), or 0 where there
///     is none blocks         └ corners and planes of 16 triangles
///
/// A node comes before its children, and of these those with more triangles come first. Coordinates are
/// float((world − origin) · scale).
struct TriangleTree {
  glm::dvec3 origin{0.0};  ///< world
  /// A power of two that keeps coordinates of triangles and lights within 2⁴⁰, so that products of three are
  /// finite. Mostly 1.
  float scale = 1;
  RawArray<float> nodes;   ///< kNodeRows · kTreeWidth a node (kernels/shared.h)
  RawArray<int> children;  ///< kTreeWidth a node
  RawArray<float> blocks;  ///< kBlockRows · kTreeWidth a block. Unused slots repeat the last triangle
  RawArray<std::uint32_t> triangles;  ///< kTreeWidth a block: counted through all objects in order
  RawArray<std::uint32_t>
      block_bits;  ///< of a block: bit i: slot i is used; bit 16 + i: its material has holes
  int root = 0;    ///< as in `children`. Without triangles an empty node
};

/// The tree over all triangles of the scene at its pose. Planes are computed in double from corners that
/// aren't rounded, so their normal and offset are right to a float's rounding, and have the orientation of
/// the rounded corners; they are 0 where there is none. O(n log n) on all cores, and the same whatever their
/// number. Throws MachineError where memory doesn't suffice, and for more than 2²⁷ triangles.
TriangleTree buildTriangleTree(const Scene& scene, const glm::dvec3& origin);

/// Whether the tree has this origin and the scale that the scene's lights and objects need. O(vertices).
bool isPlacedFor(const Scene& scene, const glm::dvec3& origin, const TriangleTree& tree);

/// The sum of the surface areas of all children's boxes, in the tree's space: proportional to the expected
/// number of boxes that a ray intersects.
double boxArea(const TriangleTree& tree);

/// Refits the tree to another pose of the same scene and another origin: recomputes boxes, corners and
/// planes, and keeps the structure. O(n), on all cores.
void refitTriangleTree(const Scene& scene, const glm::dvec3& origin, TriangleTree& tree);

}  // namespace luciole
