#pragma once

#include <cstdint>

#include "kernels/shared.h"
#include "luciole/scene.hpp"
#include "shadow/exact/triangle_tree.hpp"

namespace luciole {

/// Textures that classify points of triangles with holes as solid, hole or unknown, without an exact lookup:
/// see kernels/exact/hole_masks.clh.
struct HoleMasks {
  /// The rows of each mask: 255 times each texel's opacity, alpha or the code of a grey map.
  RawArray<unsigned char> texels;
  RawArray<HoleTriangle> triangles;  ///< of the bits of holes in block_bits, by block and slot
  RawArray<uint> first_triangle;     ///< of each block
  /// TriangleTree::block_bits, but with unused slots for triangles that are holes everywhere, and without the
  /// bits of holes for those that are solid everywhere.
  RawArray<uint> block_bits;
};

/// The masks of a tree over the scene. Triangles whose opacity is the product of two textures, or depends on
/// vertex colours, have none. O(texels + triangles), on all cores. Throws MachineError where memory doesn't
/// suffice.
HoleMasks makeHoleMasks(const Scene& scene, const TriangleTree& tree);

}  // namespace luciole
