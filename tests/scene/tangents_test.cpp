#include "scene/tangents.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "luciole/primitives.hpp"

namespace luciole {
namespace {

/// Directions are made in double and rounded to float once.
constexpr float kRounding = 0x1p-22f;

/// A square in the xy plane, its normals along +z, of two triangles.
Mesh square(const std::vector<glm::vec2>& uvs) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = uvs;
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.triangle_materials = {0, 0};
  return mesh;
}

void expectNear(const glm::vec4& a, const glm::vec4& b) {
  EXPECT_LE(glm::length(a - b), kRounding) << a.x << " " << a.y << " " << a.z << " " << a.w;
}

TEST(Tangents, RedPointsAlongUAndGreenUpInThePicture) {
  Mesh mesh = square({{0, 1}, {1, 1}, {1, 0}, {0, 0}});  // the picture stands upright
  addTangents({true, true}, mesh);
  ASSERT_EQ(mesh.tangents.size(), 4u);
  for (const glm::vec4& tangent : mesh.tangents) expectNear(tangent, {1, 0, 0, 1});
  mesh = square({{0, 0}, {0, 1}, {1, 1}, {1, 0}});  // turned: v grows along x, u along y, so up is along -x
  addTangents({true, true}, mesh);
  for (const glm::vec4& tangent : mesh.tangents) expectNear(tangent, {0, 1, 0, 1});
}

TEST(Tangents, MirroredPicturesHaveTheOtherSide) {
  Mesh mesh = square({{1, 1}, {0, 1}, {0, 0}, {1, 0}});
  addTangents({true, true}, mesh);
  for (const glm::vec4& tangent : mesh.tangents) expectNear(tangent, {-1, 0, 0, -1});
}

TEST(Tangents, WhereAPictureIsMirroredVerticesAreDoubled) {
  // The second triangle's corner lies on the other side of the diagonal in the picture, too, or else on the
  // same.
  Mesh mesh = square({{0, 1}, {1, 1}, {1, 0}, {1, 1}});
  addTangents({true, true}, mesh);
  EXPECT_EQ(mesh.positions.size(), 6u);
  for (std::size_t t = 0; t < 2; ++t)
    for (int i = 0; i < 3; ++i) EXPECT_EQ(mesh.tangents[mesh.triangles[t][i]].w, t == 0 ? 1.0f : -1.0f);
}

TEST(Tangents, VerticesOfOnePlaceShareTheMeanOfTheirTrianglesByAngle) {
  // Two squares side by side with vertices of their own: the right one's picture is stretched upwards only,
  // and turned by 45 degrees about the edge, which its normals don't follow.
  Mesh mesh;
  const float h = float(std::sqrt(0.5));
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}, {1 + h, 0, h}, {1, 1, 0}};
  mesh.normals.assign(6, {0, 0, 1});
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {1, 1}, {2, 0.5f}, {1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  mesh.triangle_materials = {0, 0};
  addTangents({true, true}, mesh);
  ASSERT_EQ(mesh.positions.size(), 6u);
  // The left one's tangent is (1, 0, 0). The right one's solves 1·t + (-0.5)·(-b) … with b = (0, 1, 0): edge
  // 1 is t + b/2, so t = (h, -1/2, h), in the plane of the normal (h, -1/2, 0) / √(3/4). Both angles there
  // are a quarter turn at vertex 1; at vertex 2 they are 45 degrees and the angle between (0, -1) and (h,
  // -1).
  const glm::dvec2 other = glm::normalize(glm::dvec2(h, -0.5));
  const double at_2 = std::acos(1 / std::sqrt(1 + double(h) * h));
  const glm::dvec2 first = glm::normalize(glm::dvec2(1, 0) + other);
  const glm::dvec2 second = glm::normalize(glm::dvec2(1, 0) * (std::acos(-1.0) / 4) + other * at_2);
  for (const std::uint32_t vertex : {1u, 3u}) expectNear(mesh.tangents[vertex], {first.x, first.y, 0, 1});
  for (const std::uint32_t vertex : {2u, 5u}) expectNear(mesh.tangents[vertex], {second.x, second.y, 0, 1});
}

TEST(Tangents, CornersWithoutAreaInThePictureTakeOthersOrNone) {
  Mesh mesh = square({{0, 1}, {1, 1}, {1, 0}, {0.5f, 0.5f}});  // the second triangle is a line in the picture
  addTangents({true, true}, mesh);
  expectNear(mesh.tangents[mesh.triangles[1].x], {1, 0, 0, 1});
  EXPECT_EQ(mesh.tangents[mesh.triangles[1].z], glm::vec4(0));
  mesh = square(std::vector<glm::vec2>(4, glm::vec2(0.5f)));
  addTangents({true, true}, mesh);
  for (const glm::vec4& tangent : mesh.tangents) EXPECT_EQ(tangent, glm::vec4(0));
}

TEST(Tangents, OfASphereGoRoundItsAxisAndAreUnit) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].normal_map.texture = 0;
  Primitive primitive;
  primitive.kind = PrimitiveKind::kSphere;
  primitive.segments = 64;
  scene.meshes.push_back(makePrimitive(primitive, 0));
  scene.objects.push_back({});
  addTangents(scene);
  const Mesh& mesh = scene.meshes[0];
  ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 p = mesh.positions[i], t(mesh.tangents[i]);
    if (std::abs(p.y) > 0.99f) continue;  // around a pole every direction is along u
    EXPECT_NEAR(glm::length(t), 1, 1e-6);
    EXPECT_NEAR(glm::dot(t, mesh.normals[i]), 0, 1e-6);
    EXPECT_EQ(mesh.tangents[i].w, 1.0f);
    // Neighbouring facets lean from the circle by half a segment's angle at most, to either side.
    EXPECT_GT(std::abs(glm::dot(t, glm::normalize(glm::vec3(p.z, 0, -p.x)))), std::cos(3.15 / 64));
  }
}

// Around a cylinder u ends where it begins: there the tangent is the mean of both sides, as everywhere else.
// By symmetry that is the circle's own direction.
TEST(Tangents, ForShadersGoOnAcrossTheSeamOfATurn) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes.push_back(
      makePrimitive({.kind = PrimitiveKind::kCylinder, .segments = 12, .lit_segments = 24}, 0));
  scene.objects.push_back({});
  addAllTangents(scene);
  const Mesh& whole = scene.meshes[0];
  for (const Mesh* mesh : {&whole, whole.divided.get()}) {
    int on_the_side = 0;
    ASSERT_EQ(mesh->tangents.size(), mesh->positions.size());
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
      const glm::vec3 p = mesh->positions[i];
      if (mesh->normals[i].y != 0) continue;
      ++on_the_side;
      expectNear(mesh->tangents[i], {p.z, 0, -p.x, 1});
    }
    EXPECT_GE(on_the_side, 26);
  }
}

TEST(Tangents, ForShadersOfChartsThatAreTurnedStayApart) {
  Mesh mesh = square({{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  // The second triangle with vertices of its own, its picture turned by 90 degrees.
  mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {1, 1, 0}});
  mesh.normals.assign(6, {0, 0, 1});
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {6, 0}, {5, 0}, {6, 1}};
  mesh.triangles[1] = {4, 5, 3};
  addTangents({true, true}, mesh, true);
  for (const int i : {0, 1, 2}) expectNear(mesh.tangents[i], {1, 0, 0, 1});
  for (const int i : {4, 5, 3}) expectNear(mesh.tangents[i], {0, 1, 0, 1});
}

TEST(Tangents, ForShadersLeaveThoseOfNormalMapsAsTheyAre) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].normal_map.texture = 0;
  scene.meshes.push_back(makePrimitive({.kind = PrimitiveKind::kCylinder, .segments = 12}, 0));
  scene.objects.push_back({});
  addTangents(scene);
  const std::vector<glm::vec4> before = scene.meshes[0].tangents;
  addTangents(scene);
  addAllTangents(scene);
  EXPECT_EQ(scene.meshes[0].tangents, before);
}

TEST(Tangents, ScenesWithoutNormalMapsGetNone) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes.push_back(makePrimitive({}, 0));
  scene.objects.push_back({});
  addTangents(scene);
  EXPECT_TRUE(scene.meshes[0].tangents.empty());
}

}  // namespace
}  // namespace luciole
