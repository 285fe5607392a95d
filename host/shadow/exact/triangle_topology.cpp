#include "shadow/exact/triangle_topology.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <memory>
#include <tuple>

namespace luciole {
namespace {

/// From this depth on a node's triangles are divided in halves, which bounds the depth. A half of b blocks
/// has at most ⌈b/2⌉, and the largest part is divided first, so a child has at most ⌈b/16⌉. 2²⁷ triangles are
/// 2²³ blocks, and 6 levels divide them into single ones.
constexpr int kHalvingDepth = 24;
static_assert(kHalvingDepth + 6 <= kMaxTreeDepth);

/// Nodes with fewer triangles are built by one thread.
constexpr std::uint32_t kTask = 1 << 12;

/// Where a child's triangles lie, as in TriangleSet, and the node that divides them if they aren't a block.
struct Branch;
struct Child {
  std::uint32_t begin, end;
  int array;
  std::unique_ptr<Branch> branch;
};
struct Branch {
  int count = 0;
  std::array<Child, kTreeWidth> children;
};

/// Whether b rather than a is divided next: the one of larger surface area, which more rays hit; in halves,
/// of more triangles. Single blocks are never divided.
bool isSplitFirst(const TriangleSet& a, const TriangleSet& b, bool halving) {
  if (a.size() <= kTreeWidth || b.size() <= kTreeWidth || halving) return a.size() < b.size();
  const float area_a = halfArea(a.box), area_b = halfArea(b.box);
  return area_a != area_b ? area_a < area_b : a.size() < b.size();
}

std::unique_ptr<Branch> grow(const TriangleSet& all, int depth, TriangleBoxes (&arrays)[2]) {
  const bool halving = depth >= kHalvingDepth;
  std::array<TriangleSet, kTreeWidth> sets{all};
  int count = 1;
  while (count < kTreeWidth) {
    const auto largest =
        std::max_element(sets.begin(), sets.begin() + count,
                         [&](const auto& a, const auto& b) { return isSplitFirst(a, b, halving); });
    if (largest->size() <= kTreeWidth) break;
    std::tie(*largest, sets[count]) =
        halving ? splitInHalves(*largest, arrays) : splitByArea(*largest, arrays);
    ++count;
  }
  // A walk visits the last child first: blocks before nodes, because a block may end the walk.
  std::stable_sort(sets.begin(), sets.begin() + count,
                   [](const TriangleSet& a, const TriangleSet& b) { return a.size() > b.size(); });
  auto branch = std::make_unique<Branch>();
  branch->count = count;
  const auto growChild = [&](int i) {
    const TriangleSet& set = sets[i];
    branch->children[i] = {set.begin, set.end, set.array,
                           set.size() > kTreeWidth ? grow(set, depth + 1, arrays) : nullptr};
  };
  if (all.size() >= kTask)
    tbb::parallel_for(0, count, growChild);
  else
    for (int i = 0; i < count; ++i) growChild(i);
  return branch;
}

struct Counts {
  std::size_t nodes = 0, blocks = 0;
};
void addCounts(const Child& child, Counts& counts) {
  if (!child.branch) {
    ++counts.blocks;
    return;
  }
  ++counts.nodes;
  for (int i = 0; i < child.branch->count; ++i) addCounts(child.branch->children[i], counts);
}

/// Numbers nodes and blocks depth first.
int number(const Child& child, TriangleTree& tree, Counts& next, std::vector<const Child*>& blocks) {
  if (!child.branch) {
    blocks[next.blocks] = &child;
    return ~int(next.blocks++);
  }
  const std::size_t node = next.nodes++;
  for (int i = 0; i < kTreeWidth; ++i)
    tree.children[node * kTreeWidth + i] =
        i < child.branch->count ? number(child.branch->children[i], tree, next, blocks) : 0;
  return int(node);
}

}  // namespace

void growTopology(TriangleBoxes boxes, TriangleTree& tree) {
  TriangleBoxes arrays[2] = {std::move(boxes), {}};
  arrays[1].resize(arrays[0].size());
  const TriangleSet all = wholeSet(arrays[0]);
  const Child top{all.begin, all.end, all.array, all.size() > kTreeWidth ? grow(all, 0, arrays) : nullptr};
  Counts counts, next;
  addCounts(top, counts);
  std::vector<const Child*> blocks(counts.blocks);
  tree.children.resize(counts.nodes * kTreeWidth);
  tree.root = number(top, tree, next, blocks);
  tree.triangles.resize(counts.blocks * kTreeWidth);
  tree.block_bits.resize(counts.blocks);
  tbb::parallel_for(std::size_t(0), counts.blocks, [&](std::size_t i) {
    const Child& block = *blocks[i];
    for (std::uint32_t slot = 0; slot < kTreeWidth; ++slot)
      tree.triangles[i * kTreeWidth + slot] =
          arrays[block.array][std::min(block.begin + slot, block.end - 1)].number();
    tree.block_bits[i] = (1u << (block.end - block.begin)) - 1;
  });
}

}  // namespace luciole
