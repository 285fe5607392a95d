#include "gbuffer/packed_normal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

/// What packNormal() promises.
constexpr double kLargestError = 6.5e-5;

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Calls `check(direction)` for directions everywhere, of many lengths, and for those near the octahedron's
/// edges and corners.
template <class Check>
void forManyDirections(Check check) {
  std::mt19937 engine(7);
  std::normal_distribution<double> component;
  std::uniform_real_distribution<double> exponent(-30.0, 1.0);
  for (int i = 0; i < 100000; ++i) {
    glm::dvec3 direction(component(engine), component(engine), component(engine));
    if (i % 2 == 0) direction[i / 2 % 3] *= std::exp2(exponent(engine));
    if (i % 4 == 0) direction[i / 4 % 2] *= std::exp2(exponent(engine));
    check(direction * std::exp2(exponent(engine)));
  }
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y)
      for (int z = -2; z <= 2; ++z)
        if (x != 0 || y != 0 || z != 0) check(glm::dvec3(x, y, z));
}

TEST(PackedNormal, DirectionsStayWithinTheErrorBound) {
  double largest = 0.0;
  forManyDirections([&](const glm::dvec3& direction) {
    const glm::dvec3 unpacked = unpackNormal(packNormal(direction));
    ASSERT_NEAR(glm::length(unpacked), 1.0, 1e-15);
    largest = std::max(largest, angleBetween(direction, unpacked));
  });
  EXPECT_LE(largest, kLargestError);
  EXPECT_GE(largest, 0.9 * kLargestError) << "the bound is loose";
}

TEST(PackedNormal, AxesAreExact) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      glm::dvec3 direction(0.0);
      direction[axis] = sign;
      EXPECT_EQ(unpackNormal(packNormal(direction)), direction);
    }
  EXPECT_EQ(packNormal({0, 0, 1}), 0u) << "what background holds is a direction, too";
}

TEST(PackedNormal, OctantsKeepTheirSigns) {
  for (int octant = 0; octant < 8; ++octant) {
    const glm::dvec3 direction(octant & 1 ? -0.3 : 0.3, octant & 2 ? -0.5 : 0.5, octant & 4 ? -0.7 : 0.7);
    const glm::dvec3 unpacked = unpackNormal(packNormal(direction));
    for (int c = 0; c < 3; ++c) EXPECT_EQ(unpacked[c] < 0.0, direction[c] < 0.0) << octant << "," << c;
  }
}

/// Every direction that is packed comes back to the bit from a file: after rotating it to the world, rounding
/// it to float there and rotating it back.
TEST(PackedNormal, AWayThroughTheWorldInFloatChangesNoBit) {
  const glm::dmat4 to_world = glm::inverse(
      glm::lookAt(glm::dvec3(3.1, 2.2, 5.3), glm::dvec3(0.1, 1.0, 0.2), glm::dvec3(0.0, 1.0, 0.0)));
  const glm::dmat3 rotation(to_world), back(glm::inverse(to_world));
  const auto expect_kept = [&](std::uint32_t packed) {
    const glm::dvec3 unpacked = unpackNormal(packed);
    ASSERT_EQ(packNormal(unpacked), packed);
    ASSERT_EQ(packNormal(back * glm::dvec3(glm::vec3(rotation * unpacked))), packed);
  };
  forManyDirections([&](const glm::dvec3& direction) { expect_kept(packNormal(direction)); });
  // The square's middle, its diagonals, on which z is 0, its border and corners, and what lies a step beside
  // them.
  const int lines[] = {-32767, -32766, -16384, -1, 0, 1, 16383, 32766, 32767};
  for (const int line : lines)
    for (int along = -32767; along <= 32767; along += 62)
      for (const bool swap : {false, true}) {
        const int x = swap ? line : along, y = swap ? along : line;
        const std::uint32_t code = std::uint32_t(x & 0xffff) | std::uint32_t(y) << 16;
        expect_kept(packNormal(unpackNormal(code)));
        const int diagonal = 32767 - std::abs(along);
        expect_kept(packNormal(unpackNormal(std::uint32_t(along & 0xffff) | std::uint32_t(diagonal) << 16)));
      }
}

TEST(PackedNormal, InnerPointsOfTheSquareAreTheirOwnDirections) {
  for (int x = -32766; x <= 32766; x += 257)
    for (int y = -32766; y <= 32766; y += 263) {
      const std::uint32_t code = std::uint32_t(x & 0xffff) | std::uint32_t(y) << 16;
      ASSERT_EQ(packNormal(unpackNormal(code)), code) << x << "," << y;
    }
}

/// A tilted rectangle with the normals of another one.
Scene tiltedScene(const glm::dvec3& normal) {
  Scene scene = rectangleScene(4.0f, 4.0f, 0.0f);
  scene.objects[0].object_to_world = glm::translate(glm::dmat4(1.0), {0.0, 0.0, -5.0}) *
                                     glm::inverse(glm::lookAt(glm::dvec3(0.0), -normal, glm::dvec3(0, 1, 0)));
  for (glm::vec3& of_vertex : scene.meshes[0].normals)
    of_vertex = glm::normalize(glm::vec3(0.3f, 0.1f, 1.0f));
  return scene;
}

TEST(PackedNormal, PixelsHaveTheirTrianglesNormalOnTheViewersSide) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.2, 1.0));
  for (const bool turned : {false, true}) {
    const Scene scene = tiltedScene(turned ? -normal : normal);
    for (const Shading shading : {Shading::kFlat, Shading::kPhong}) {
      const GBuffer gbuffer =
          draw(scene, cameraView(frontCamera(), {7, 9}), shading, {.geometric_normal = true});
      ASSERT_EQ(gbuffer.geometric_normal.size(), gbuffer.pixels());
      for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 7; ++x) {
          ASSERT_TRUE(isCovered(gbuffer, x, y));
          const glm::dvec3 geometric_normal = unpackNormal(gbuffer.geometric_normal[gbuffer.index(x, y)]);
          ASSERT_LE(angleBetween(geometric_normal, normal), 2 * kLargestError)
              << "rounding of the corners, too";
          ASSERT_GT(glm::dot(geometric_normal, glm::dvec3(valueAt(gbuffer.normal, gbuffer, x, y))), 0.0);
        }
    }
  }
}

TEST(PackedNormal, VerticesHaveTheirOwnNormal) {
  const Scene scene = tiltedScene({0.0, 0.0, 1.0});
  const GBuffer gbuffer =
      gatherVertices(scene, allObjects(scene), cameraView(frontCamera(), {8, 8}), {.geometric_normal = true});
  const std::size_t n = gbuffer.pixels();
  ASSERT_EQ(gbuffer.geometric_normal.size(), n);
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3 normal(gbuffer.normal[i], gbuffer.normal[i + n], gbuffer.normal[i + 2 * n]);
    EXPECT_LE(angleBetween(unpackNormal(gbuffer.geometric_normal[i]), normal), 2 * kLargestError);
  }
}

}  // namespace
}  // namespace luciole::test
