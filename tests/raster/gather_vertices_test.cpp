#include <gtest/gtest.h>

#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

glm::vec3 linearValue(const Plane& group, const GBuffer& gbuffer, std::size_t i) {
  return {group[i], group[gbuffer.pixels() + i], group[2 * gbuffer.pixels() + i]};
}

TEST(GatherVertices, VerticesOfAllObjectsLieInOrder) {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t i = 0; i < 300; ++i) {
    positions.push_back({float(i), 1.0f, -2.0f});
    if (i % 3 == 2) triangles.push_back({i - 2, i - 1, i});
  }
  Scene scene = meshScene(positions, triangles);
  scene.materials[0].specular = {0.1f, 0.2f, 0.3f};
  scene.materials[0].shininess = 5.0f;
  scene.materials[0].emission = {3, 2, 1};
  scene.objects.push_back(scene.objects[0]);
  scene.objects[1].object_to_world = glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, -4.0));
  const View view = cameraView(frontCamera(), {8, 8});
  const GBuffer gbuffer = gatherVertices(scene, allObjects(scene), view, {true, true, true});
  EXPECT_EQ(gbuffer.tiles_x, 3);
  EXPECT_EQ(gbuffer.pixels(), 768u);
  EXPECT_EQ(std::size_t(gbuffer.width) * gbuffer.height, 768u);
  for (std::size_t i = 0; i < 600; ++i) {
    EXPECT_EQ(linearValue(gbuffer.position, gbuffer, i),
              glm::vec3(float(i % 300), 1.0f, i < 300 ? -2.0f : -6.0f));
    EXPECT_EQ(linearValue(gbuffer.normal, gbuffer, i), glm::vec3(0, 0, 1));
    EXPECT_EQ(linearValue(gbuffer.diffuse, gbuffer, i), glm::vec3(1.0f));
    EXPECT_EQ(linearValue(gbuffer.ambient, gbuffer, i), glm::vec3(0.2f));
    EXPECT_EQ(linearValue(gbuffer.specular, gbuffer, i), glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(gbuffer.specular[3 * gbuffer.pixels() + i], 5.0f);
    EXPECT_EQ(linearValue(gbuffer.emission, gbuffer, i), glm::vec3(3, 2, 1));
  }
  for (std::size_t i = 600; i < 768; ++i) {
    EXPECT_EQ(linearValue(gbuffer.position, gbuffer, i),
              glm::vec3(0, 0, -std::numeric_limits<float>::infinity()));
    EXPECT_EQ(linearValue(gbuffer.diffuse, gbuffer, i), glm::vec3(0.0f));
  }
}

TEST(GatherVertices, TheFirstTriangleDecidesTheMaterial) {
  Scene scene = rectangleScene(1, 1, -2);
  scene.materials.push_back(doubleSided());
  scene.materials[1].diffuse = {0, 1, 0};
  scene.meshes[0].triangle_materials = {1, 0};
  scene.meshes[0].colors.assign(4, {0.5f, 0.5f, 0.5f, 1.0f});
  const GBuffer gbuffer = gatherVertices(scene, allObjects(scene), cameraView(frontCamera(), {8, 8}), {});
  for (const int i : {0, 1, 2})
    EXPECT_EQ(linearValue(gbuffer.diffuse, gbuffer, i), glm::vec3(0.0f, 0.5f, 0.0f));
  EXPECT_EQ(linearValue(gbuffer.diffuse, gbuffer, 3), glm::vec3(0.5f));
}

TEST(GatherVertices, DoubleSidedNormalsTurnToTheViewer) {
  Scene scene = rectangleScene(1, 1, -2);
  for (glm::vec3& normal : scene.meshes[0].normals) normal = {0, 0, -1};
  const View view = cameraView(frontCamera(), {8, 8});
  const GBuffer turned = gatherVertices(scene, allObjects(scene), view, {});
  EXPECT_EQ(linearValue(turned.normal, turned, 0), glm::vec3(0, 0, 1));
  scene.materials[0].double_sided = false;
  const GBuffer kept = gatherVertices(scene, allObjects(scene), view, {});
  EXPECT_EQ(linearValue(kept.normal, kept, 0), glm::vec3(0, 0, -1));
}

TEST(GatherVertices, NoObjectsGiveNoTiles) {
  const GBuffer gbuffer = gatherVertices({}, {}, cameraView(frontCamera(), {8, 8}), {});
  EXPECT_EQ(gbuffer.pixels(), 0u);
}

}  // namespace
}  // namespace luciole::test
