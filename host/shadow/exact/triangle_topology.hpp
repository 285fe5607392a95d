#pragma once

#include "shadow/exact/split_triangles.hpp"
#include "shadow/exact/triangle_tree.hpp"

namespace luciole {

/// Divides triangles by their boxes, at least one: fills `children`, `triangles`, the used bits of
/// `block_bits`, and `root`. `boxes` is used up. No way from the root has more than kMaxTreeDepth nodes.
void growTopology(TriangleBoxes boxes, TriangleTree& tree);

}  // namespace luciole
