#include "shadow/exact/split_triangles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace luciole::test {
namespace {

TriangleBoxes randomBoxes(std::uint32_t count) {
  std::mt19937 random(count);
  std::uniform_real_distribution<float> anywhere(-1, 1), size(0, 0.1f);
  TriangleBoxes boxes(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Quad middle = Quad{anywhere(random), 3 * anywhere(random), anywhere(random), 0};
    const Quad half = Quad{size(random), size(random), size(random), 0};
    boxes[i].low = middle - half;
    boxes[i].minus_high = -(middle + half);
    boxes[i].setNumber(i);
  }
  return boxes;
}

Quad centreOf(const TriangleBox& box) { return box.low - box.minus_high; }

void expectEqual(const QuadBox& a, const QuadBox& b) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(a.low[i], b.low[i]);
    EXPECT_EQ(a.minus_high[i], b.minus_high[i]);
  }
}

/// The set's boxes are around what it holds. Returns its triangles.
std::vector<std::uint32_t> expectTight(const TriangleSet& set, const TriangleBoxes (&arrays)[2]) {
  QuadBox box, centres;
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = set.begin; i < set.end; ++i) {
    const TriangleBox& one = arrays[set.array][i];
    box.add(one);
    centres.add({centreOf(one), -centreOf(one)});
    numbers.push_back(one.number());
  }
  expectEqual(set.box, box);
  expectEqual(set.centres, centres);
  return numbers;
}

TEST(SplitTriangles, PartsByAreaAreTightAndKeepTheOrder) {
  for (const std::uint32_t count : {17u, 100u, 5000u, 100000u}) {
    TriangleBoxes arrays[2] = {randomBoxes(count), TriangleBoxes(count)};
    const auto [left, right] = splitByArea(wholeSet(arrays[0]), arrays);
    std::vector<std::uint32_t> all = expectTight(left, arrays), others = expectTight(right, arrays);
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    EXPECT_TRUE(std::is_sorted(others.begin(), others.end()));
    EXPECT_EQ(left.end, right.begin);
    all.insert(all.end(), others.begin(), others.end());
    std::sort(all.begin(), all.end());
    for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(all[i], i);
  }
}

TEST(SplitTriangles, AreaDecidesWhereGroupsLieApart) {
  TriangleBoxes arrays[2] = {randomBoxes(1000), TriangleBoxes(1000)};
  for (std::uint32_t i = 0; i < 1000; i += 4) {
    arrays[0][i].low[2] += 100;
    arrays[0][i].minus_high[2] -= 100;
  }
  const auto [left, right] = splitByArea(wholeSet(arrays[0]), arrays);
  EXPECT_EQ(left.size(), 750u);
  EXPECT_EQ(right.size(), 250u);
}

// What the limit of the tree's depth rests on.
TEST(SplitTriangles, HalvesHaveHalfOfTheBlocksAndLieInOrder) {
  for (const std::uint32_t count : {17u, 32u, 33u, 49u, 1000u, 99999u}) {
    TriangleBoxes arrays[2] = {randomBoxes(count), TriangleBoxes(count)};
    const auto [left, right] = splitInHalves(wholeSet(arrays[0]), arrays);
    expectTight(left, arrays);
    expectTight(right, arrays);
    EXPECT_EQ(left.size(), (blocksFor(count) + 1) / 2 * 16);
    EXPECT_EQ(left.size() + right.size(), count);
    EXPECT_GT(right.size(), 0u);
    EXPECT_LE(-left.centres.minus_high[1], right.centres.low[1]) << "the boxes spread most along y";
  }
}

}  // namespace
}  // namespace luciole::test
