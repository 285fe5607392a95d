#include "shadow/exact/exact_ray.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "kernels/exact/exact_sign.h"
#include "shadow/exact/loose_triangles.hpp"

namespace luciole::test {
namespace {

TriangleTree treeOver(const std::vector<Triangle>& triangles, std::uint32_t material = 0) {
  return buildTriangleTree(looseScene(triangles, material), glm::dvec3(0));
}

/// A triangle of the tree.
struct Slot {
  std::array<float4, 3> corners;
  glm::vec4 plane;
  float rounding;
};
std::vector<Slot> slotsOf(const TriangleTree& tree) {
  std::vector<Slot> slots;
  for (std::size_t i = 0; i < tree.triangles.size(); ++i) {
    const std::size_t block = i / kTreeWidth, slot = i % kTreeWidth;
    if ((tree.block_bits[block] >> slot & 1) == 0) continue;
    const auto at = [&](int row) {
      return tree.blocks[(block * kBlockRows + std::size_t(row)) * kTreeWidth + slot];
    };
    Slot& one = slots.emplace_back();
    for (int k = 0; k < 3; ++k) one.corners[k] = {at(3 * k), at(3 * k + 1), at(3 * k + 2), 0};
    for (int k = 0; k < 4; ++k) one.plane[k] = at(kPlaneRows + k);
    one.rounding = at(kRoundingRow);
  }
  return slots;
}

/// Whether any triangle blocks, by the definition, where `volume(p, q, r)` has the sign of the volume of p,
/// q, r and the light.
template <class Volume>
bool isBlockedByAny(const std::vector<Slot>& slots, const glm::vec3& start, const Volume& volume) {
  const float4 s{start.x, start.y, start.z, 0};
  const float error = POINT_ERROR * ((std::abs(start.x) + std::abs(start.y)) + std::abs(start.z));
  for (const Slot& slot : slots) {
    const auto& [a, b, c] = slot.corners;
    const int side = volume(a, b, c);
    const float height =
        std::fma(slot.plane.x, start.x,
                 std::fma(slot.plane.y, start.y, std::fma(slot.plane.z, start.z, -slot.plane.w)));
    if (side == 0 || !(float(side) * height > std::max(error, slot.rounding))) continue;
    if (orientation(a, b, c, s) == side) continue;
    if (side * volume(a, b, s) >= 0 && side * volume(b, c, s) >= 0 && side * volume(c, a, s) >= 0)
      return true;
  }
  return false;
}

int signOf(double value) { return (value > 0) - (value < 0); }

glm::dvec3 toDouble(const float4& v) { return {v.x, v.y, v.z}; }

/// Exact for small integers.
struct PlainVolume {
  float4 light;
  int operator()(const float4& p, const float4& q, const float4& r) const {
    const glm::dvec3 l = toDouble(light), a = toDouble(p), b = toDouble(q), c = toDouble(r);
    if (light.w == 0) return -signOf(glm::dot(glm::cross(a - c, b - c), l));
    return signOf(glm::dot(glm::cross(a - l, b - l), c - l));
  }
};

/// Exact for all.
struct ExactVolume {
  float4 light;
  int operator()(const float4& p, const float4& q, const float4& r) const {
    return light.w == 0 ? orientation_along(p, q, r, light) : orientation(p, q, r, light);
  }
};

TEST(ExactRay, ATriangleBlocksWhatIsBehindItFromEitherSide) {
  const glm::vec3 a(-1, 0, -1), b(2, 0, -1), c(-1, 0, 2);
  for (const Triangle& triangle : {Triangle{a, b, c}, Triangle{a, c, b}}) {
    const TriangleTree tree = treeOver({triangle});
    for (const float up : {1.0f, -1.0f})
      for (const BeamLight& light : {pointAt({0, 3 * up, 0}), towards({0, up, 0})}) {
        EXPECT_TRUE(isBlocked(tree, {0, -2 * up, 0}, light, neverAsked));
        EXPECT_TRUE(isBlocked(tree, {-1, -2 * up, 0}, towards({0, up, 0}), neverAsked)) << "the rim counts";
        EXPECT_FALSE(isBlocked(tree, {0, 2 * up, 0}, light, neverAsked)) << "in front of it";
        EXPECT_FALSE(isBlocked(tree, {0, 4 * up, 0}, light, neverAsked)) << "beyond the light";
        EXPECT_FALSE(isBlocked(tree, {0, 0, 0}, light, neverAsked)) << "on it";
        EXPECT_FALSE(isBlocked(tree, {3, -2 * up, 3}, light, neverAsked)) << "beside it";
      }
    EXPECT_FALSE(isBlocked(tree, {0, -1, 0}, pointAt({0, -1, 0}), neverAsked)) << "at the light";
    EXPECT_FALSE(isBlocked(tree, {0, -1, 0}, pointAt({5, 0, 0}), neverAsked)) << "edge-on";
  }
}

TEST(ExactRay, OnAGridOfIntegersItIsWhatTheDefinitionSays) {
  // Few places, so many pairs meet corners, edges and planes exactly, and many triangles have no area.
  std::mt19937 random(1);
  std::uniform_int_distribution<int> place(-4, 4);
  const auto vector = [&] { return glm::vec3(place(random), place(random), place(random)); };
  int blocked = 0, pairs = 0;
  for (int round = 0; round < 40; ++round) {
    std::vector<Triangle> triangles;
    for (int i = 0; i < 2 + 3 * round; ++i) {
      const glm::vec3 middle = 2.0f * vector();
      const auto near = [&] { return middle + glm::trunc(vector() / 2.0f); };
      triangles.push_back({near(), near(), near()});
    }
    const TriangleTree tree = treeOver(triangles);
    const std::vector<Slot> slots = slotsOf(tree);
    for (int i = 0; i < 200; ++i) {
      glm::vec3 start = vector(), light = vector(), way = light;
      if (i % 2 == 0) {  // through a corner
        const glm::vec3 corner = triangles[i % triangles.size()][i % 3];
        way = vector() + 2.0f * vector();
        start = corner - float(1 + i % 5) * way;
        light = corner + float(1 + i % 7) * way;
      }
      for (const BeamLight& beam : {pointAt(light), towards(way)}) {
        if (start == light || way == glm::vec3(0)) continue;
        const bool truth = isBlockedByAny(slots, start, PlainVolume{beam.place});
        ASSERT_EQ(isBlocked(tree, start, beam, neverAsked), truth);
        blocked += truth;
        ++pairs;
      }
    }
  }
  EXPECT_GT(blocked, pairs / 4);
  EXPECT_LT(blocked, pairs * 3 / 4);
}

TEST(ExactRay, NoBoxHidesATriangleThatBlocks) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> anywhere(-1, 1);
  const auto vector = [&] { return glm::vec3(anywhere(random), anywhere(random), anywhere(random)); };
  int blocked = 0, pairs = 0;
  for (const float reach : {1.0f, 1e-18f, 1e11f}) {
    std::vector<Triangle> triangles = randomTriangles(3000, 0.05f, 3);
    // Walls along the axes are boxes without a thickness, and some lights and starts lie in them.
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < 100; ++i)
        for (glm::vec3& corner : triangles[200 * std::size_t(axis) + std::size_t(i)])
          corner[axis] = 0.125f * float(axis);
    for (Triangle& triangle : triangles)
      for (glm::vec3& corner : triangle) corner *= reach;
    const TriangleTree tree = treeOver(triangles);
    const std::vector<Slot> slots = slotsOf(tree);
    for (int i = 0; i < 300; ++i) {
      glm::vec3 start = vector(), light = vector();
      const int axis = i % 9 / 3;
      if (i % 3 == 0) start[axis] = light[axis] = 0.125f * float(axis);
      if (i % 5 == 0) light[i % 2] = start[i % 2];
      if (i % 7 == 0) light *= 1e3f;
      for (const BeamLight& beam : {pointAt(light * reach), towards(glm::normalize(light - start))}) {
        const bool truth = isBlockedByAny(slots, start * reach, ExactVolume{beam.place});
        ASSERT_EQ(isBlocked(tree, start * reach, beam, neverAsked), truth);
        blocked += truth;
        ++pairs;
      }
    }
  }
  EXPECT_GT(blocked, pairs / 4);
  EXPECT_LT(blocked, pairs);
}

TEST(ExactRay, CornersBehindAStartBehindThePlaneDoNotBlock) {
  // Triangles so small that rounding turns them. Seen along a direction between their plane and their
  // corners', the start is behind the one and in front of the others by far more than rounding.
  Scene scene = looseScene(randomTriangles(500, 1e-3f, 7));
  scene.objects[0].object_to_world[3] = {50, 60, 70, 1};
  const TriangleTree tree = buildTriangleTree(scene, glm::dvec3(0));
  const std::vector<Slot> slots = slotsOf(tree);
  int behind_plane = 0;
  for (const Slot& slot : slots) {
    const glm::dvec3 a = toDouble(slot.corners[0]), b = toDouble(slot.corners[1]),
                     c = toDouble(slot.corners[2]);
    const glm::dvec3 turned = glm::cross(b - a, c - a), normal(slot.plane);
    const glm::dvec3 axis = glm::cross(turned, normal);
    if (glm::length(axis) == 0) continue;
    const glm::dvec3 between =
        glm::normalize(glm::cross(axis, glm::normalize(turned) + glm::normalize(normal)));
    for (const double side : {1.0, -1.0}) {
      const glm::vec3 start = (a + b + c) / 3.0 + 20 * side * between,
                      beyond = glm::dvec3(start) + 5 * side * between;
      for (const BeamLight& beam : {pointAt(beyond), towards(side * between)}) {
        const float4 s{start.x, start.y, start.z, 0};
        const auto& [p, q, r] = slot.corners;
        const int turn = ExactVolume{beam.place}(p, q, r);
        const float height =
            std::fma(slot.plane.x, start.x,
                     std::fma(slot.plane.y, start.y, std::fma(slot.plane.z, start.z, -slot.plane.w)));
        const bool before_corners = orientation(p, q, r, s) == turn;
        behind_plane += before_corners && float(turn) * height > 0x1p-10f;
        ASSERT_EQ(isBlocked(tree, start, beam, neverAsked),
                  isBlockedByAny(slots, start, ExactVolume{beam.place}));
      }
    }
  }
  EXPECT_GT(behind_plane, 100);
}

/// Where the segment from the start to the light meets a triangle: weights of the corners, and the way there
/// as a share of the segment.
glm::dvec4 meeting(const Triangle& triangle, const glm::dvec3& start, const glm::dvec3& light) {
  const glm::dvec3 a = triangle[0], ab = glm::dvec3(triangle[1]) - a, ac = glm::dvec3(triangle[2]) - a;
  const glm::dvec3 solved = glm::inverse(glm::dmat3(ab, ac, start - light)) * (start - a);
  return {1 - solved.x - solved.y, solved.x, solved.y, solved.z};
}

TEST(ExactRay, AgreesWithPlainIntersectionsAwayFromRims) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> anywhere(-1, 1);
  const auto vector = [&] { return glm::vec3(anywhere(random), anywhere(random), anywhere(random)); };
  const std::vector<Triangle> triangles = randomTriangles(400, 0.2f, 5);
  const TriangleTree tree = treeOver(triangles);
  int blocked = 0, pairs = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 start = vector(), light = vector();
    bool meets = false, close = false;
    for (const Triangle& triangle : triangles) {
      const glm::dvec4 where = meeting(triangle, start, light);
      const double least = std::min({where.x, where.y, where.z, where.w, 1 - where.w});
      meets |= least > 0;
      close |= std::abs(least) < 1e-4;
    }
    if (close) continue;
    ASSERT_EQ(isBlocked(tree, start, pointAt(light), neverAsked), meets);
    blocked += meets;
    ++pairs;
  }
  EXPECT_GT(pairs, 1000);
  EXPECT_GT(blocked, pairs / 4);
}

TEST(ExactRay, HolesAreAskedWhereTheLineMeetsThem) {
  const std::vector<Triangle> triangles = randomTriangles(1000, 0.3f, 6);
  const TriangleTree tree = treeOver(triangles, 1);
  const glm::dvec3 start(0.9, -0.8, 0.7), light(-0.8, 0.9, -0.6), way = light - start;
  for (const BeamLight& beam : {pointAt(light), towards(glm::normalize(way))}) {
    std::vector<std::uint32_t> asked;
    const auto askAll = [&](std::uint32_t index, const glm::dvec3& weights) {
      const Triangle& triangle = triangles[index];
      const glm::dvec3 hit = weights.x * glm::dvec3(triangle[0]) + weights.y * glm::dvec3(triangle[1]) +
                             weights.z * glm::dvec3(triangle[2]);
      EXPECT_NEAR(weights.x + weights.y + weights.z, 1, 1e-12);
      // The light's and the start's floats are within 2⁻²⁴ of where they are said to be; none of the
      // triangles is edge-on.
      EXPECT_LT(glm::length(glm::cross(hit - start, way)), 1e-5);
      asked.push_back(index);
      return true;
    };
    EXPECT_FALSE(isBlocked(tree, start, beam, askAll));
    ASSERT_GT(asked.size(), 3u);
    const std::uint32_t solid = asked[asked.size() / 2];
    EXPECT_TRUE(
        isBlocked(tree, start, beam, [&](std::uint32_t index, const glm::dvec3&) { return index != solid; }));
  }
}

}  // namespace
}  // namespace luciole::test
