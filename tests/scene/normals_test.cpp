#include "scene/normals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "luciole/error.hpp"
#include "luciole/scene.hpp"

namespace luciole {
namespace {

/// Two walls of a unit cube that share the edge along y, their squares cut along either diagonal.
Mesh foldedWalls() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 1}, {0, 1, 1}};
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}};
  mesh.triangle_materials.resize(4, 0);
  return mesh;
}

// Each wall takes a right angle of the corners at the edge, in one triangle or in two: so the mean of their
// normals, (0, 0, −1) and (−1, 0, 0), halves the angle between them. Floats are off by half of 2⁻²⁴.
TEST(Normals, OfMeshesWithoutAreMeansByAngle) {
  Scene scene;
  scene.meshes = {foldedWalls()};
  addNormals(scene);
  const std::vector<glm::vec3>& normals = scene.meshes[0].normals;
  ASSERT_EQ(normals.size(), 6u);
  for (const int i : {0, 1})
    EXPECT_LT(glm::distance(normals[i], glm::vec3(-1, 0, -1) * std::sqrt(0.5f)), 0x1p-22);
  for (const int i : {2, 3}) EXPECT_EQ(normals[i], glm::vec3(0, 0, -1));
  for (const int i : {4, 5}) EXPECT_EQ(normals[i], glm::vec3(-1, 0, 0));
}

TEST(Normals, ThatThereAreStay) {
  Scene scene;
  scene.meshes = {foldedWalls()};
  scene.meshes[0].normals.resize(6, {0, 1, 0});
  addNormals(scene);
  EXPECT_EQ(scene.meshes[0].normals, std::vector<glm::vec3>(6, {0, 1, 0}));
}

TEST(Normals, ATriangleWithoutItsVertexIsRefusedByItsPlace) {
  Scene scene;
  scene.meshes = {foldedWalls(), foldedWalls()};
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
