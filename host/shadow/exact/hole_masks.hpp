#pragma once

#include <cstdint>

#include "kernels/shared.h"
#include "luciole/scene.hpp"
#include "shadow/exact/triangle_tree.hpp"

namespace luciole {

/// Where triangles with holes are solid and where they aren't, as far as that is known without a lookup: see
/// kernels/exact/hole_masks.clh.
struct HoleMasks {
  /// Of each mask its rows: 255 times each texel's alpha, or linear red where a grey map's code is the
  /// opacity.
  AlignedArray<unsigned char> texels;
  AlignedArray<HoleTriangle> triangles;  ///< of the bits of holes in block_bits, by block and slot
  AlignedArray<uint> first_triangle;     ///< of each block
  /// TriangleTree::block_bits. Without the bits of triangles that are hole all over, and without the bits of
  /// holes of those that are solid all over.
  AlignedArray<uint> block_bits;
};

/// The masks of a tree over the scene. Triangles whose opacity is the product of two textures, or depends on
/// vertex colours, have none. O(texels + triangles), on all cores. Throws MachineError where memory doesn't
/// suffice.
HoleMasks makeHoleMasks(const Scene& scene, const TriangleTree& tree);

}  // namespace luciole
