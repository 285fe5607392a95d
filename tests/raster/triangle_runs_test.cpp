#include "raster/triangle_runs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

/// Meshes of no triangle, of one, of a run, of one more, and of several runs, whose triangles share vertices
/// or not; one of them is placed twice.
Scene sceneOfSeveral() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  Scene scene;
  scene.materials.push_back(doubleSided());
  const std::pair<std::uint32_t, std::uint32_t> sizes[] = {// triangles, vertices
                                                           {0, 3},
                                                           {1, 3},
                                                           {kRunTriangles, 3 * kRunTriangles},
                                                           {kRunTriangles + 1, 5},
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
    if (triangles == kRunTriangles)  // no vertex twice: as many as a run can have
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

TEST(TriangleRuns, EveryTriangleIsInOneRunInOrder) {
  const Scene scene = sceneOfSeveral();
  std::vector<std::tuple<std::uint32_t, std::uint32_t>> expected, found;
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object)
    for (std::uint32_t i = 0; i < scene.meshes[scene.objects[object].mesh].triangles.size(); ++i)
      expected.emplace_back(object, i);
  const TriangleRuns runs = findRuns(scene);
  for (const TriangleRun& run : runs.runs) {
    EXPECT_GE(run.count, 1u);
    EXPECT_LE(run.count, kRunTriangles);
    for (std::uint32_t i = 0; i < run.count; ++i) found.emplace_back(run.object, run.first + i);
  }
  EXPECT_EQ(found, expected);
}

TEST(TriangleRuns, CornersAreThoseOfTheMeshByVerticesListedOnceARun) {
  const Scene scene = sceneOfSeveral();
  const TriangleRuns runs = findRuns(scene);
  std::size_t listed = 0, corners = 0;
  for (std::size_t i = 0; i < runs.runs.size(); ++i) {
    const TriangleRun& run = runs.runs[i];
    const Mesh& mesh = scene.meshes[scene.objects[run.object].mesh];
    std::set<std::uint32_t> used;
    for (std::uint32_t t = 0; t < run.count; ++t)
      for (int c = 0; c < 3; ++c) {
        const std::uint32_t place = runs.corners[(3 * i + std::size_t(c)) * kRunTriangles + t];
        ASSERT_LT(place, run.vertex_count);
        ASSERT_EQ(runs.vertices[run.first_vertex + place], mesh.triangles[run.first + t][c]);
        used.insert(mesh.triangles[run.first + t][c]);
      }
    // As many as there are, and all of them: each once.
    EXPECT_EQ(run.vertex_count, used.size()) << "run " << i;
    EXPECT_EQ(run.first_vertex, listed) << "run " << i;
    listed += run.vertex_count;
    corners += 3 * run.count;
  }
  EXPECT_EQ(runs.vertices.size(), listed);
  EXPECT_LT(listed, corners);  // or nothing was shared
}

TEST(TriangleRuns, BoxesContainTheirVerticesTightly) {
  const Scene scene = sceneOfSeveral();
  const TriangleRuns runs = findRuns(scene);
  for (std::size_t i = 0; i < runs.runs.size(); ++i) {
    const TriangleRun& run = runs.runs[i];
    const Object& object = scene.objects[run.object];
    glm::dvec3 low(1e300), high(-1e300);
    for (std::uint32_t v = 0; v < run.vertex_count; ++v) {
      const glm::vec3& position = scene.meshes[object.mesh].positions[runs.vertices[run.first_vertex + v]];
      const glm::dvec3 p(object.object_to_world * glm::dvec4(position, 1.0));
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    EXPECT_EQ(run.low, low) << "run " << i;
    EXPECT_EQ(run.high, high) << "run " << i;
    const TriangleRuns::Box& group = runs.groups.at(i / kRunsPerGroup);
    EXPECT_TRUE(glm::all(glm::lessThanEqual(group.low, low)) &&
                glm::all(glm::greaterThanEqual(group.high, high)))
        << "run " << i;
  }
  EXPECT_EQ(runs.groups.size(), (runs.runs.size() + kRunsPerGroup - 1) / kRunsPerGroup);
  EXPECT_GT(runs.groups.size(), 2u);
}

TEST(TriangleRuns, VerticesThatAreNotFiniteLeaveTheBoxToTheOthers) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const Scene scene = meshScene({{-1, -2, -3}, {4, 5, 6}, {0, 0, 0}, {nan, 0, 0}, {0, inf, 0}},
                                {{3, 0, 1}, {0, 1, 2}, {0, 3, 4}});
  const TriangleRuns runs = findRuns(scene);
  ASSERT_EQ(runs.runs.size(), 1u);
  const glm::dvec3 low = runs.runs[0].low, high = runs.runs[0].high;
  EXPECT_LE(low.x, -1);
  EXPECT_LE(low.y, -2);
  EXPECT_LE(low.z, -3);
  EXPECT_GE(high.x, 4);
  EXPECT_GE(high.y, 5);
  EXPECT_GE(high.z, 6);
}

TEST(TriangleRuns, SceneWithoutTrianglesHasNone) {
  EXPECT_TRUE(findRuns(Scene{}).runs.empty());
  const TriangleRuns runs = findRuns(meshScene({}, {}));
  EXPECT_TRUE(runs.runs.empty() && runs.groups.empty() && runs.vertices.empty());
}

}  // namespace
}  // namespace luciole::test
