#pragma once

#include "shadow/exact/split_triangles.hpp"
#include "shadow/exact/triangle_tree.hpp"

namespace luciole {

/// Builds the tree's structure from the boxes of one triangle or more: fills `children`, `triangles`, the
/// used bits of `block_bits`, and `root`. Consumes `boxes`. No path from the root has more than kMaxTreeDepth
/// nodes.
void growTopology(TriangleBoxes boxes, TriangleTree& tree);

}  // namespace luciole
