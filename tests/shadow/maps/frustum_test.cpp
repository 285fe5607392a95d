#include "shadow/maps/frustum.hpp"

#include <gtest/gtest.h>

#include <limits>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace luciole::test {
namespace {

const Bounds kBox{{-1, -2, -3}, {4, 5, 6}};

View viewOf(bool orthographic) {
  Camera camera;
  camera.orthographic = orthographic;
  camera.shift = {0.4, -0.3};
  camera.camera_to_world = glm::rotate(glm::translate(glm::dmat4(1.0), {3, 2, 9}), 0.4, {0.0, 1.0, 0.0});
  camera.near = 0.5;
  camera.far = 20;
  return cameraView(camera, {120, 80});
}

/// The box around some points.
Bounds around(const std::vector<glm::dvec3>& points) {
  Bounds box;
  for (const glm::dvec3& p : points) {
    box.low = glm::min(box.low, p);
    box.high = glm::max(box.high, p);
  }
  return box;
}

TEST(Frustum, ABoxsCornersHaveABitAnAxis) {
  const Corners corners = boxCorners(kBox);
  EXPECT_EQ(corners[0], kBox.low);
  EXPECT_EQ(corners[1], glm::dvec3(4, -2, -3));
  EXPECT_EQ(corners[6], glm::dvec3(-1, 5, 6));
  EXPECT_EQ(corners[7], kBox.high);
}

class FrustumOfView : public testing::TestWithParam<bool> {};

TEST_P(FrustumOfView, CornersOfAViewAreThoseOfItsPicture) {
  const View view = viewOf(GetParam());
  const Corners corners = viewCorners(view, 1);
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 clip = view.projection * (view.world_to_view * glm::dvec4(corners[i], 1));
    const glm::dvec3 expected(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : 0);
    // An inverse and two products of matrices whose numbers are up to 40 times as large as their results.
    EXPECT_LE(glm::distance(glm::dvec3(clip) / clip.w, expected), 1e3 * 0x1p-53) << i;
  }
}

TEST(Frustum, AViewWithoutEndIsCutWhereItIsAsked) {
  Camera camera;
  camera.near = 0.5;
  camera.far = std::numeric_limits<double>::infinity();
  const Corners endless = viewCorners(cameraView(camera, {120, 80}), 20);
  camera.far = 20;
  const Corners limited = viewCorners(cameraView(camera, {120, 80}), 20);
  for (int i = 0; i < 8; ++i) EXPECT_LE(glm::distance(endless[i], limited[i]), 1e3 * 20 * 0x1p-53) << i;
}

TEST_P(FrustumOfView, APointIsInsideTheCropsPlanesWhereTheCropShowsIt) {
  View view = viewOf(GetParam());
  view.crop_origin = {30, 10};
  view.crop_size = {60, 50};
  std::mt19937 random(2);
  std::uniform_real_distribution<double> pixel_x(0, 120), pixel_y(0, 80), depth(0.01, 0.99);
  const glm::dmat4 to_world = glm::inverse(view.projection * view.world_to_view);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 pixel(pixel_x(random), pixel_y(random));
    const glm::dvec4 p =
        to_world * glm::dvec4(-1 + 2 * pixel.x / 120, 1 - 2 * pixel.y / 80, depth(random), 1);
    bool inside = true;
    for (const glm::dvec4& plane : cropPlanes(view)) inside &= glm::dot(plane, p / p.w) >= 0;
    EXPECT_EQ(inside, pixel.x >= 30 && pixel.x <= 90 && pixel.y >= 10 && pixel.y <= 60)
        << pixel.x << ' ' << pixel.y;
  }
}

INSTANTIATE_TEST_SUITE_P(Projections, FrustumOfView, testing::Bool(),
                         [](const auto& test) { return test.param ? "Parallel" : "Perspective"; });

TEST(Frustum, BoxesHaveInCommonTheBoxBetween) {
  const Bounds other{{2, -9, 1}, {9, 1, 2}};
  const Bounds common = around(commonCorners(boxCorners(kBox), boxCorners(other)));
  // Crossings of edges along the axes: a quotient, a product and a sum, of numbers up to 15.
  EXPECT_LE(glm::distance(common.low, glm::dvec3(2, -2, 1)), 60 * 0x1p-53);
  EXPECT_LE(glm::distance(common.high, glm::dvec3(4, 1, 2)), 60 * 0x1p-53);
}

TEST(Frustum, ABoxInAnotherIsAllThatTheyHaveInCommon) {
  const Bounds inner{{0, 0, 0}, {1, 2, 3}};
  const Bounds common = around(commonCorners(boxCorners(kBox), boxCorners(inner)));
  EXPECT_EQ(common.low, inner.low);
  EXPECT_EQ(common.high, inner.high);
}

TEST(Frustum, BoxesApartHaveNothingInCommon) {
  EXPECT_TRUE(commonCorners(boxCorners(kBox), boxCorners({{5, 0, 0}, {6, 1, 1}})).empty());
}

}  // namespace
}  // namespace luciole::test
