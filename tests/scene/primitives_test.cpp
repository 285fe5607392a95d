#include "luciole/primitives.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace luciole {
namespace {

const std::array<PrimitiveKind, 5> kClosed{PrimitiveKind::kBox, PrimitiveKind::kSphere,
                                           PrimitiveKind::kCylinder, PrimitiveKind::kCone,
                                           PrimitiveKind::kTorus};
const std::array<int, 5> kSegments{3, 4, 7, 64, 93};

struct LessVec {
  bool operator()(const glm::vec3& a, const glm::vec3& b) const {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
};

/// Each triangle's corners by number of their place, so that vertices split for normals or texture are one
/// again.
std::vector<glm::uvec3> weld(const Mesh& mesh) {
  std::map<glm::vec3, std::uint32_t, LessVec> places;
  const auto number = [&](std::uint32_t vertex) {
    return places.try_emplace(mesh.positions[vertex], static_cast<std::uint32_t>(places.size()))
        .first->second;
  };
  std::vector<glm::uvec3> triangles;
  for (const glm::uvec3& t : mesh.triangles) triangles.emplace_back(number(t.x), number(t.y), number(t.z));
  return triangles;
}

glm::dvec3 normalOf(const Mesh& mesh, const glm::uvec3& t) {
  const glm::dvec3 a = mesh.positions[t.x];
  return glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
}

TEST(Primitives, EveryEdgeOfAClosedShapeIsSharedByTwoTrianglesInOppositeDirections) {
  for (PrimitiveKind kind : kClosed) {
    for (int segments : kSegments) {
      std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
      for (const glm::uvec3& t : weld(makePrimitive({kind, segments, 0.25f, 1.0f}, 0))) {
        for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
      }
      for (const auto& [edge, count] : edges) {
        ASSERT_NE(edge.first, edge.second)
            << "a triangle without area in shape " << int(kind) << ", " << segments;
        ASSERT_EQ(count, 1) << "shape " << int(kind) << ", " << segments;
        ASSERT_TRUE(edges.count({edge.second, edge.first})) << "shape " << int(kind) << ", " << segments;
      }
    }
  }
}

TEST(Primitives, ClosedShapesHaveTheirFrontsOutside) {
  // The divergence theorem: the volume is positive if the triangles face outwards, and no more than the
  // smooth shape's.
  const double pi = std::acos(-1.0);
  const std::map<PrimitiveKind, double> volumes{{PrimitiveKind::kBox, 1.0},
                                                {PrimitiveKind::kSphere, 4 * pi / 3},
                                                {PrimitiveKind::kCylinder, pi},
                                                {PrimitiveKind::kCone, pi / 3},
                                                {PrimitiveKind::kTorus, 2 * pi * pi * 0.25 * 0.25}};
  for (const auto& [kind, smooth] : volumes) {
    const Mesh mesh = makePrimitive({kind, 64, 0.25f, 1.0f}, 0);
    double volume = 0;
    for (const glm::uvec3& t : mesh.triangles) {
      volume += glm::dot(glm::dvec3(mesh.positions[t.x]), normalOf(mesh, t)) / 6;
    }
    // A circle's 64-gon has an area of sin(a)/a of the circle's, a = 2π/64, at least 1 − a²/6 = 1 − 0.0017.
    // The coarsest shape is the torus: 64 around, whose tube is a 32-gon (1 − 0.0065). A sphere of 32 rings:
    // two such factors.
    EXPECT_GT(volume, smooth * (1 - 0.0017 - 0.0065)) << int(kind);
    EXPECT_LT(volume, smooth * (1 + 1e-6)) << int(kind);  // float corners: 2⁻²⁴ each in three factors
  }
}

TEST(Primitives, NormalsAreUnitAndOnTheFrontOfEveryTriangle) {
  for (PrimitiveKind kind : kClosed) {
    for (int segments : kSegments) {
      const Mesh mesh = makePrimitive({kind, segments, 0.25f, 1.0f}, 0);
      ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
      for (const glm::uvec3& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
          const glm::dvec3 normal = mesh.normals[t[i]];
          // Three components rounded to float: relative 2⁻²⁴ each, so the length is that far off at most.
          ASSERT_NEAR(glm::length(normal), 1.0, 6e-8);
          // A normal leans from its triangle's by less than a right angle, even on a three-sided shape.
          ASSERT_GT(glm::dot(normal, normalOf(mesh, t)), 0) << "shape " << int(kind) << ", " << segments;
        }
      }
    }
  }
}

TEST(Primitives, SphereHasRadiusOneToRounding) {
  for (int segments : kSegments) {
    const Mesh mesh = makePrimitive({PrimitiveKind::kSphere, segments, 0.25f, 1.0f}, 0);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      ASSERT_NEAR(glm::length(glm::dvec3(mesh.positions[i])), 1.0,
                  6e-8);  // components rounded: relative 2⁻²⁴
      ASSERT_EQ(mesh.positions[i], mesh.normals[i]);
    }
  }
}

TEST(Primitives, TexturesAreNotMirroredSeenFromOutside) {
  for (PrimitiveKind kind : {PrimitiveKind::kPlane, PrimitiveKind::kBox, PrimitiveKind::kSphere,
                             PrimitiveKind::kCylinder, PrimitiveKind::kCone, PrimitiveKind::kTorus}) {
    const Mesh mesh = makePrimitive({kind, 64, 0.25f, 1.0f}, 0);
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::dvec2 a = mesh.uvs[t.y] - mesh.uvs[t.x];
      const glm::dvec2 b = mesh.uvs[t.z] - mesh.uvs[t.x];
      // v grows downwards: counter-clockwise in space is clockwise in (u, v).
      ASSERT_LT(a.x * b.y - a.y * b.x, 0) << "shape " << int(kind);
    }
  }
}

TEST(Primitives, PlaneHasTheSquaresAndRepeatsAskedFor) {
  const Mesh mesh = makePrimitive({PrimitiveKind::kPlane, 3, 0.25f, 5.0f}, 7);
  EXPECT_EQ(mesh.triangles.size(), 18u);
  EXPECT_EQ(mesh.triangle_materials, std::vector<std::uint32_t>(18, 7));
  EXPECT_EQ(mesh.positions.front(), glm::vec3(-0.5f, 0, -0.5f));
  EXPECT_EQ(mesh.uvs.front(), glm::vec2(0));
  EXPECT_EQ(mesh.positions.back(), glm::vec3(0.5f, 0, 0.5f));
  EXPECT_EQ(mesh.uvs.back(), glm::vec2(5));
  for (const glm::uvec3& t : mesh.triangles) EXPECT_GT(normalOf(mesh, t).y, 0);
}

}  // namespace
}  // namespace luciole
