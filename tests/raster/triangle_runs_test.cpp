#include "raster/triangle_runs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "raster/geometry.hpp"
#include "raster/raster_scenes.hpp"
#include "raster/setup.hpp"

namespace luciole::test {
namespace {

/// A thousand runs of small triangles all around the eye, and a run of large ones; back faces are culled.
Scene crowdedScene() {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t run = 0; run <= 1000; ++run) {
    const glm::vec3 middle = 20.0f * vector();
    const float spread = run == 1000 ? 30.0f : 1.0f;
    for (std::uint32_t i = 0; i < kRunTriangles; ++i) {
      const std::uint32_t first = std::uint32_t(positions.size());
      const glm::vec3 place = middle + spread * vector();
      for (int c = 0; c < 3; ++c) positions.push_back(place + 0.2f * spread * vector());
      triangles.push_back({first, first + 1, first + 2});
    }
  }
  Scene scene = meshScene(positions, triangles);
  scene.materials[0].double_sided = false;
  scene.objects.push_back(scene.objects[0]);
  scene.objects[1].object_to_world =
      glm::scale(glm::translate(glm::dmat4(1.0), {1e3, 5.0, -7.0}), {-2.0, 1.0, 1.0});
  return scene;
}

/// Views from inside the crowd and beside it, perspective with and without a far plane, and parallel.
std::vector<View> views() {
  std::vector<View> result;
  for (const double x : {0.0, 15.0, 1e3, -1e7}) {
    Camera camera = frontCamera();
    camera.camera_to_world =
        glm::rotate(glm::translate(glm::dmat4(1.0), {x, 1.0, 2.0}), 0.7 + x, glm::dvec3(0.3, 1.0, 0.1));
    for (const double far : {8.0, std::numeric_limits<double>::infinity()}) {
      camera.far = far;
      result.push_back(cameraView(camera, {211, 167}));
    }
    camera.far = 30.0;
    camera.orthographic = true;
    camera.half_height = 6.0;
    result.push_back(cameraView(camera, {211, 167}));
  }
  return result;
}

RasterSetup setupWith(const Scene& scene, const View& view, const SceneRuns* runs) {
  return setupTriangles(scene, transformObjects(scene, allObjects(scene), view, false, runs), view,
                        FaceCulling::kBackFaces);
}

TEST(TriangleRuns, ViewsDrawAndCountWhatTheyDoWithout) {
  const Scene scene = crowdedScene();
  SceneRuns runs;
  updateRuns(scene, false, runs);
  for (const View& view : views()) {
    const RasterSetup all = setupWith(scene, view, nullptr), seen = setupWith(scene, view, &runs);
    EXPECT_EQ(all.back_facing, seen.back_facing);
    ASSERT_EQ(all.triangles.size(), seen.triangles.size());
    for (std::size_t i = 0; i < all.triangles.size(); ++i) {
      // Without the padding at the end.
      ASSERT_EQ(0, std::memcmp(&all.triangles[i], &seen.triangles[i], offsetof(RasterTriangle, masked))) << i;
    }
  }
}

TEST(TriangleRuns, MostOfACrowdAroundTheEyeIsLeftOut) {
  const Scene scene = crowdedScene();
  SceneRuns runs;
  updateRuns(scene, false, runs);
  const Geometry geometry = transformObjects(scene, allObjects(scene), views()[0], false, &runs);
  ASSERT_EQ(geometry.seen.size(), 2 * runCount(scene.meshes[0]));
  EXPECT_LT(std::ranges::count(geometry.seen, 1), 200);
}

TEST(TriangleRuns, AMeshThatDeformsHasNewRuns) {
  Scene scene = rectangleScene(1.0f, 1.0f, -5.0f);
  Deformation deformation;
  deformation.pose = {0.0};
  scene.animation.deformations.push_back(deformation);
  SceneRuns runs;
  updateRuns(scene, false, runs);
  EXPECT_EQ(runs.of_mesh[0][0].high, glm::vec3(1, 1, -5));
  scene.meshes[0].positions[2].x = 3;
  updateRuns(scene, false, runs);
  EXPECT_EQ(runs.of_mesh[0][0].high.x, 1);  // at the same pose it isn't looked at
  scene.animation.deformations[0].pose = {1.0};
  updateRuns(scene, false, runs);
  EXPECT_EQ(runs.of_mesh[0][0].high.x, 3);
}

TEST(TriangleRuns, WhatAViewKeepsChangesNothingInTheNext) {
  const Scene scene = crowdedScene();
  KeptGeometry kept;
  for (const View& view : views()) {
    RasterCounts counts, counts_alone;
    const GBuffer alone = draw(scene, view, Shading::kPhong, {}, &counts_alone);
    const GBuffer next =
        rasterize(scene, allObjects(scene), view, Shading::kPhong, {}, {}, &counts, {}, &kept);
    EXPECT_EQ(alone.position, next.position);
    EXPECT_EQ(alone.normal, next.normal);
    EXPECT_EQ(counts_alone.outside, counts.outside);
    EXPECT_EQ(counts_alone.covering, counts.covering);
  }
}

}  // namespace
}  // namespace luciole::test
