#include "scene/normals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "luciole/error.hpp"
#include "luciole/scene.hpp"

namespace luciole {
namespace {

/// Two unit squares that share the edge along y, cut along either diagonal. The second is turned around the
/// edge out of the first one's plane by so many degrees.
Mesh foldedWalls(double turn) {
  const auto c = float(-std::cos(glm::radians(turn))), s = float(std::sin(glm::radians(turn)));
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {c, 0, s}, {c, 1, s}};
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}};
  mesh.triangle_materials.resize(4, 0);
  return mesh;
}

/// The normal of a wall that is turned by so many degrees.
glm::dvec3 turned(double degrees) {
  return {-std::sin(glm::radians(degrees)), 0, -std::cos(glm::radians(degrees))};
}

// Each wall takes a right angle of the corners at the edge, in one triangle or in two: so the mean of their
// normals halves the angle between them. Positions and normals are floats, off by half of 2⁻²³ each.
TEST(Normals, OfMeshesWithoutAreMeansByAngle) {
  const double turn = 45;
  Scene scene;
  scene.meshes = {foldedWalls(turn)};
  addNormals(scene);
  const std::vector<glm::vec3>& normals = scene.meshes[0].normals;
  ASSERT_EQ(normals.size(), 6u);
  for (const int i : {0, 1}) EXPECT_LT(glm::distance(glm::dvec3(normals[i]), turned(turn / 2)), 0x1p-22);
  for (const int i : {2, 3}) EXPECT_EQ(normals[i], glm::vec3(0, 0, -1));
  for (const int i : {4, 5}) EXPECT_LT(glm::distance(glm::dvec3(normals[i]), turned(turn)), 0x1p-22);
}

TEST(Normals, SharpEdgesGetVerticesOfTheirOwnWithAllThatVerticesHave) {
  Scene scene;
  scene.meshes = {foldedWalls(59), foldedWalls(61)};
  for (Mesh& mesh : scene.meshes)
    for (const glm::vec3& position : mesh.positions) mesh.uvs.emplace_back(position.x, position.y);
  addNormals(scene);
  EXPECT_EQ(scene.meshes[0].positions.size(), 6u);
  const Mesh& sharp = scene.meshes[1];
  ASSERT_EQ(sharp.positions.size(), 8u);
  ASSERT_EQ(sharp.normals.size(), 8u);
  for (std::size_t t = 0; t < 4; ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t vertex = sharp.triangles[t][i];
      EXPECT_LT(glm::distance(glm::dvec3(sharp.normals[vertex]), turned(t < 2 ? 0 : 61)), 0x1p-22);
      EXPECT_EQ(sharp.uvs[vertex], glm::vec2(sharp.positions[vertex]));
      EXPECT_EQ(sharp.positions[vertex], foldedWalls(61).positions[foldedWalls(61).triangles[t][i]]);
    }
}

TEST(Normals, ArraysThatDontFitAreRefused) {
  Scene scene;
  scene.meshes = {foldedWalls(90)};
  scene.meshes[0].colors.resize(5);
  EXPECT_THROW(addNormals(scene), InputError);
}

TEST(Normals, ThatThereAreStay) {
  Scene scene;
  scene.meshes = {foldedWalls(45)};
  scene.meshes[0].normals.resize(6, {0, 1, 0});
  addNormals(scene);
  EXPECT_EQ(scene.meshes[0].normals, std::vector<glm::vec3>(6, {0, 1, 0}));
}

TEST(Normals, ATriangleWithoutItsVertexIsRefusedByItsPlace) {
  Scene scene;
  scene.meshes = {foldedWalls(45), foldedWalls(45)};
  scene.meshes[1].triangles[2].y = 6;
  try {
    addNormals(scene);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), "meshes[1].triangles[2]: refers to vertex 6, but the mesh has 6");
  }
}

}  // namespace
}  // namespace luciole
