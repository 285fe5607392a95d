#include "raster/meshlets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

/// Meshes of no triangle, of one, of a meshlet, of one more, and of several meshlets, whose triangles share
/// vertices or not; one of them is placed twice.
Scene sceneOfSeveral() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  Scene scene;
  scene.materials.push_back(doubleSided());
  const std::pair<std::uint32_t, std::uint32_t> sizes[] = {// triangles, vertices
                                                           {0, 3},
                                                           {1, 3},
                                                           {kMeshletTriangles, 3 * kMeshletTriangles},
                                                           {kMeshletTriangles + 1, 5},
                                                           {5000, 700}};
  for (const auto& [triangles, vertices] : sizes) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < vertices; ++i)
      mesh.positions.push_back({unit(random), unit(random), unit(random)});
    for (std::uint32_t i = 0; i < triangles; ++i) {
      // The same low bits of indices again and again are where the search for a vertex might go wrong.
      const std::uint32_t first = i % 2 ? std::uint32_t(random()) : 256 * i;
      mesh.triangles.push_back(
          {first % vertices, (first + 256) % vertices, std::uint32_t(random()) % vertices});
    }
    if (triangles == kMeshletTriangles)  // no vertex twice: as many as a meshlet can have
      for (std::uint32_t i = 0; i < triangles; ++i) mesh.triangles[i] = {3 * i, 3 * i + 1, 3 * i + 2};
    mesh.normals.assign(vertices, {0.0f, 0.0f, 1.0f});
    mesh.triangle_materials.assign(triangles, 0);
    Object object;
    object.mesh = std::uint32_t(scene.meshes.size());
    object.object_to_world = glm::translate(glm::rotate(glm::dmat4(1.0), 1.0, {0.6, 0.0, 0.8}),
                                            glm::dvec3(10.0 * object.mesh, 1e5, -3.0));
    scene.meshes.push_back(mesh);
    scene.objects.push_back(object);
  }
  scene.objects.push_back(scene.objects.back());
  scene.objects.back().object_to_world = glm::scale(glm::dmat4(1.0), glm::dvec3(2.0, -1.0, 0.5));
  return scene;
}

TEST(Meshlets, EveryTriangleIsInOneRunInOrder) {
  const Scene scene = sceneOfSeveral();
  std::vector<std::tuple<std::uint32_t, std::uint32_t>> expected, found;
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object)
    for (std::uint32_t i = 0; i < scene.meshes[scene.objects[object].mesh].triangles.size(); ++i)
      expected.emplace_back(object, i);
  const Meshlets meshlets = findMeshlets(scene);
  for (const Meshlet& meshlet : meshlets.items) {
    EXPECT_GE(meshlet.count, 1u);
    EXPECT_LE(meshlet.count, kMeshletTriangles);
    for (std::uint32_t i = 0; i < meshlet.count; ++i) found.emplace_back(meshlet.object, meshlet.first + i);
  }
  EXPECT_EQ(found, expected);
}

TEST(Meshlets, CornersAreThoseOfTheMeshByVerticesListedOnceARun) {
  const Scene scene = sceneOfSeveral();
  const Meshlets meshlets = findMeshlets(scene);
  std::size_t listed = 0, corners = 0;
  for (std::size_t i = 0; i < meshlets.items.size(); ++i) {
    const Meshlet& meshlet = meshlets.items[i];
    const Mesh& mesh = scene.meshes[scene.objects[meshlet.object].mesh];
    std::set<std::uint32_t> used;
    for (std::uint32_t t = 0; t < meshlet.count; ++t)
      for (int c = 0; c < 3; ++c) {
        const std::uint32_t place = meshlets.corners[(3 * i + std::size_t(c)) * kMeshletTriangles + t];
        ASSERT_LT(place, meshlet.vertex_count);
        ASSERT_EQ(meshlets.vertices[meshlet.first_vertex + place], mesh.triangles[meshlet.first + t][c]);
        used.insert(mesh.triangles[meshlet.first + t][c]);
      }
    // As many as there are, and all of them: each once.
    EXPECT_EQ(meshlet.vertex_count, used.size()) << "meshlet " << i;
    EXPECT_EQ(meshlet.first_vertex, listed) << "meshlet " << i;
    listed += meshlet.vertex_count;
    corners += 3 * meshlet.count;
  }
  EXPECT_EQ(meshlets.vertices.size(), listed);
  EXPECT_LT(listed, corners);  // or nothing was shared
}

TEST(Meshlets, BoxesContainTheirVerticesTightly) {
  const Scene scene = sceneOfSeveral();
  const Meshlets meshlets = findMeshlets(scene);
  for (std::size_t i = 0; i < meshlets.items.size(); ++i) {
    const Meshlet& meshlet = meshlets.items[i];
    const Object& object = scene.objects[meshlet.object];
    glm::dvec3 low(1e300), high(-1e300);
    for (std::uint32_t v = 0; v < meshlet.vertex_count; ++v) {
      const glm::vec3& position =
          scene.meshes[object.mesh].positions[meshlets.vertices[meshlet.first_vertex + v]];
      const glm::dvec3 p(object.object_to_world * glm::dvec4(position, 1.0));
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    EXPECT_EQ(meshlet.low, low) << "meshlet " << i;
    EXPECT_EQ(meshlet.high, high) << "meshlet " << i;
    const Meshlets::Box& group = meshlets.groups.at(i / kMeshletsPerGroup);
    EXPECT_TRUE(glm::all(glm::lessThanEqual(group.low, low)) &&
                glm::all(glm::greaterThanEqual(group.high, high)))
        << "meshlet " << i;
  }
  EXPECT_EQ(meshlets.groups.size(), (meshlets.items.size() + kMeshletsPerGroup - 1) / kMeshletsPerGroup);
  EXPECT_GT(meshlets.groups.size(), 2u);
}

TEST(Meshlets, VerticesThatAreNotFiniteLeaveTheBoxToTheOthers) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Scene scene = meshScene({{-1, -2, -3}, {4, 5, 6}, {0, 0, 0}, {nan, 0, 0}, {0, inf, 0}},
                                {{3, 0, 1}, {0, 1, 2}, {0, 3, 4}});
  const Meshlets meshlets = findMeshlets(scene);
  ASSERT_EQ(meshlets.items.size(), 1u);
  const glm::dvec3 low = meshlets.items[0].low, high = meshlets.items[0].high;
  EXPECT_LE(low.x, -1);
  EXPECT_LE(low.y, -2);
  EXPECT_LE(low.z, -3);
  EXPECT_GE(high.x, 4);
  EXPECT_GE(high.y, 5);
  EXPECT_GE(high.z, 6);
}

TEST(Meshlets, SceneWithoutTrianglesHasNone) {
  EXPECT_TRUE(findMeshlets(Scene{}).items.empty());
  const Meshlets meshlets = findMeshlets(meshScene({}, {}));
  EXPECT_TRUE(meshlets.items.empty() && meshlets.groups.empty() && meshlets.vertices.empty());
}

}  // namespace
}  // namespace luciole::test
