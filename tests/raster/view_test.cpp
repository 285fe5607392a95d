#include "raster/view.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "luciole/error.hpp"
#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

constexpr double kEpsilon = 0x1p-52;

glm::dvec3 project(const View& view, const glm::dvec3& point) {
  const glm::dvec4 clip = view.projection * glm::dvec4(point, 1.0);
  return glm::dvec3(clip) / clip.w;
}

TEST(View, DepthIsOneAtTheNearPlaneAndZeroAtTheFarPlane) {
  for (const bool orthographic : {false, true}) {
    Camera camera;
    camera.orthographic = orthographic;
    camera.near = 0.25;
    camera.far = 512.0;
    const View view = cameraView(camera, {64, 32});
    EXPECT_NEAR(project(view, {0, 0, -0.25}).z, 1.0, 4 * kEpsilon);
    EXPECT_NEAR(project(view, {0, 0, -512.0}).z, 0.0, 4 * kEpsilon);
    EXPECT_GT(project(view, {0, 0, -2.0}).z, project(view, {0, 0, -3.0}).z);
  }
}

TEST(View, ThePicturesEdgesAreAtTheFieldOfView) {
  Camera camera;
  camera.fov_y = 1.2;
  const View view = cameraView(camera, {300, 100});
  const double top = std::tan(0.6) * 7.0;
  const glm::dvec3 corner = project(view, {3.0 * top, top, -7.0});
  EXPECT_NEAR(corner.x, 1.0, 8 * kEpsilon);
  EXPECT_NEAR(corner.y, 1.0, 8 * kEpsilon);

  camera.orthographic = true;
  camera.half_height = 4.0;
  const glm::dvec3 parallel = project(cameraView(camera, {300, 100}), {12.0, -4.0, -7.0});
  EXPECT_NEAR(parallel.x, 1.0, 8 * kEpsilon);
  EXPECT_NEAR(parallel.y, -1.0, 8 * kEpsilon);
}

// OpenCV's camera space has y down and z ahead. Numbers up to 2e4 pixels, the slope of a pixel's place, go
// through some 40 roundings on either way.
TEST(View, PixelsAreThoseOfAMatrixOfIntrinsics) {
  const double fx = 911.7, fy = 903.2, cx = 201.4, cy = 377.9;
  const glm::dvec2 size(640, 480);
  const glm::dmat4 world_to_camera =
      glm::rotate(glm::translate(glm::dmat4(1.0), {0.3, -0.2, 5}), 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
  Camera camera;
  camera.camera_to_world = glm::inverse(world_to_camera) * glm::scale(glm::dmat4(1.0), {1, -1, -1});
  camera.fov_y = 2 * std::atan(size.y / (2 * fy));
  camera.shift = {2 * cx / size.x - 1, 1 - 2 * cy / size.y};
  camera.pixel_aspect = fy / fx;
  const View view = cameraView(camera, glm::ivec2(size));
  for (int i = 0; i < 64; ++i) {
    const glm::dvec3 world = glm::dvec3(glm::ivec3(i, i / 4, i / 16) % 4) - 1.5;
    const glm::dvec3 seen(world_to_camera * glm::dvec4(world, 1));
    const glm::dvec3 place = project(view, glm::dvec3(view.world_to_view * glm::dvec4(world, 1)));
    EXPECT_NEAR((place.x + 1) / 2 * size.x, fx * seen.x / seen.z + cx, 2e4 * 40 * kEpsilon);
    EXPECT_NEAR((1 - place.y) / 2 * size.y, fy * seen.y / seen.z + cy, 2e4 * 40 * kEpsilon);
  }
}

TEST(View, TheAxisOfAParallelViewMeetsThePictureWhereItIsShiftedTo) {
  Camera camera;
  camera.orthographic = true;
  camera.half_height = 4.0;
  camera.shift = {0.5, -0.25};
  camera.pixel_aspect = 2;
  const View view = cameraView(camera, {300, 100});
  EXPECT_EQ(glm::dvec2(project(view, {0, 0, -7})), camera.shift);
  const glm::dvec3 corner = project(view, {0.5 * 24, 1.25 * 4, -7});
  EXPECT_NEAR(corner.x, 1, 8 * kEpsilon);
  EXPECT_NEAR(corner.y, 1, 8 * kEpsilon);
}

TEST(View, TheEyeIsTheOriginOfItsSpace) {
  Camera camera;
  camera.camera_to_world = glm::rotate(glm::translate(glm::dmat4(1.0), {1, 2, 3}), 1.0, {0.0, 0.6, 0.8});
  const View view = cameraView(camera, {10, 10});
  const glm::dvec3 eye(view.world_to_view * glm::dvec4(1, 2, 3, 1));
  EXPECT_LE(glm::length(eye), 20 * kEpsilon);
  const glm::dvec3 ahead(view.world_to_view * (camera.camera_to_world * glm::dvec4(0, 0, -5, 1)));
  EXPECT_LE(glm::length(ahead - glm::dvec3(0, 0, -5)), 40 * kEpsilon);
}

TEST(View, ACameraComesBackFromItsView) {
  for (const bool orthographic : {false, true}) {
    Camera camera;
    camera.orthographic = orthographic;
    camera.fov_y = 0.9;
    camera.half_height = 3.0;
    camera.near = 0.5;
    camera.far = 100.0;
    camera.shift = {0.3, -1.7};
    camera.pixel_aspect = 1.1;
    camera.camera_to_world = glm::rotate(glm::translate(glm::dmat4(1.0), {1, 2, 3}), 1.0, {0.0, 0.6, 0.8});
    const Camera back = viewCamera(cameraView(camera, {30, 20}));
    EXPECT_EQ(back.orthographic, orthographic);
    EXPECT_EQ(back.shift, camera.shift);
    EXPECT_EQ(back.pixel_aspect, camera.pixel_aspect);
    EXPECT_NEAR(orthographic ? back.half_height : back.fov_y, orthographic ? 3.0 : 0.9, 12 * kEpsilon);
    // In a parallel view the near plane is a difference of numbers near 1, in units of far − near = 100.
    EXPECT_NEAR(back.near, 0.5, 400 * kEpsilon);
    EXPECT_NEAR(back.far, 100.0, 400 * kEpsilon);
    for (int column = 0; column < 4; ++column)
      EXPECT_LE(glm::length(back.camera_to_world[column] - camera.camera_to_world[column]), 20 * kEpsilon);
  }
}

TEST(View, ACameraMaySeeToInfinity) {
  Camera camera;
  camera.near = 0.001;
  camera.far = std::numeric_limits<double>::infinity();
  const View view = cameraView(camera, {30, 20});
  EXPECT_EQ(viewCamera(view).far, camera.far);
  EXPECT_EQ(viewCamera(view).near, camera.near);
  for (const double depth : {0.001, 1.0, 1e18}) {
    const glm::dvec4 clip = view.projection * glm::dvec4(0, 0, -depth, 1);
    EXPECT_NEAR(clip.z / clip.w, camera.near / depth, 4 * kEpsilon * camera.near / depth);
  }
}

TEST(View, ImpossibleSizesAndCropsAreRefused) {
  const Scene scene = rectangleScene(1, 1, -2);
  const auto refused = [&](glm::ivec2 size, glm::ivec2 origin, glm::ivec2 crop) {
    View view = cameraView(frontCamera(), {32, 32});
    view.size = size;
    view.crop_origin = origin;
    view.crop_size = crop;
    EXPECT_THROW(draw(scene, view), InputError);
    const Meshlets meshlets = findMeshlets(scene);
    EXPECT_THROW(rasterizeDepth(scene, meshlets, allMeshlets(meshlets), view, {}, {}), InputError);
  };
  refused({0, 32}, {0, 0}, {0, 32});
  refused({32, 40000}, {0, 0}, {32, 32});
  refused({32, 32}, {1, 0}, {32, 32});
  refused({32, 32}, {-1, 0}, {8, 8});
  refused({32, 32}, {0, 0}, {8, 0});
  refused({32, 32}, {0x7fffffff, 0}, {0x7fffffff, 8});
}

}  // namespace
}  // namespace luciole::test
