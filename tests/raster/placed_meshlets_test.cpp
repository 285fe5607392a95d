#include "raster/placed_meshlets.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

/// Three objects of the same mesh of 150 triangles: three meshlets each.
Scene threeObjects() {
  Scene scene = meshScene({{0, 0, -5}, {1, 0, -5}, {0, 1, -5}}, std::vector<glm::uvec3>(150, {0, 1, 2}));
  scene.objects.resize(3, scene.objects.front());
  for (int i = 0; i < 3; ++i)
    scene.objects[i].object_to_world = glm::translate(glm::dmat4(1.0), glm::dvec3(10.0 * i, 0, 0));
  return scene;
}

TEST(PlacedMeshlets, EachMeshletHasItsObjectWhichIsPlacedOnce) {
  const Scene scene = threeObjects();
  const Meshlets meshlets = findMeshlets(scene);
  const std::vector<std::uint32_t> chosen{0, 2, 7, 8};  // of the first object and of the last
  const PlacedMeshlets placed = placeMeshlets(scene, meshlets, chosen, glm::dmat4(1.0));
  EXPECT_EQ(placed.objects.size(), 2u);
  for (std::size_t i = 0; i < chosen.size(); ++i)
    EXPECT_EQ(placed.object(i).object_to_view,
              scene.objects[meshlets.items[chosen[i]].object].object_to_world)
        << i;
}

TEST(PlacedMeshlets, NoMeshletsNeedNoObjects) {
  const Scene scene = threeObjects();
  const Meshlets meshlets = findMeshlets(scene);
  EXPECT_TRUE(placeMeshlets(scene, meshlets, {}, glm::dmat4(1.0)).objects.empty());
}

}  // namespace
}  // namespace luciole::test
