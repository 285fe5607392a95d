#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <random>

#include "kernels/probe.hpp"
#include "kernels/shared.h"

namespace luciole::test {
namespace {

constexpr double kUnit = 0x1p-24;  // the relative error of one rounding
constexpr const char* kHard = "-DPCF=0";
constexpr const char* kFiltered = "";
constexpr float kCloser = 1e30f;  // a depth that hides everything

/// Receivers: columns position, normal, N·L.
std::vector<Column> receivers(const std::vector<glm::dvec3>& positions, const glm::dvec3& normal,
                              double n_dot_l) {
  std::vector<Column> in(7);
  for (const glm::dvec3& p : positions) {
    for (int c = 0; c < 3; ++c) {
      in[c].push_back(float(p[c]));
      in[3 + c].push_back(float(normal[c]));
    }
    in[6].push_back(float(n_dot_l));
  }
  return in;
}

Column visibility(int lanes, const ShadowMap& map, const Plane& depths, const std::vector<Column>& in,
                  const char* defines) {
  Device& device = deviceWithLanes(lanes);
  const cl::Buffer map_buffer = inputBuffer(device, &map, sizeof map),
                   depth_buffer = inputBuffer(device, depths);
  return probe(device, "shadow_probe.cl", "probe_shadow", in, 1, {map_buffer, depth_buffer}, defines)[0];
}

/// A parallel map whose texels are the unit squares of x and y from 0, depth growing along z. It says that
/// its texels have no width, so that receivers stay where they are instead of moving along their normal.
ShadowMap parallelMap(int size) {
  ShadowMap map{};
  map.to_map_x = {1, 0, 0, 0};
  map.to_map_y = {0, 1, 0, 0};
  map.to_map_z = {0, 0, 1, 0};
  map.size = uint(size);
  map.kind = kParallelMap;
  return map;
}

Plane randomOccluders(std::size_t count) {
  std::mt19937 random(11);
  Plane depths(count);
  for (float& depth : depths) depth = random() % 2 ? kCloser : 0.0f;
  return depths;
}

/// Length that [a, a + 1] and [low, high] share.
double overlap(double a, double low, double high) {
  return std::max(std::min(a + 1, high) - std::max(a, low), 0.0);
}

/// Share of the square of `side` texels around (x, y) that is not hidden.
double litShare(const Plane& depths, int size, double x, double y, double side) {
  double lit = 0;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column)
      if (depths[row * size + column] == 0)
        lit += overlap(column, x - side / 2, x + side / 2) * overlap(row, y - side / 2, y + side / 2);
  return lit / (side * side);
}

TEST(ShadowKernels, HardLookupsReadTheTexelThatHoldsThePoint) {
  constexpr int kSize = 16;
  const Plane depths = randomOccluders(kSize * kSize);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < kSize * kSize; ++i)
    for (const double corner : {0.0, 0.5, 0.96875})
      points.push_back({i % kSize + corner, i / kSize + corner, 0.5});
  for (const int lanes : kAllLanes) {
    const Column lit = visibility(lanes, parallelMap(kSize), depths, receivers(points, {0, 0, 1}, 1), kHard);
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_EQ(lit[i], depths[int(points[i].y) * kSize + int(points[i].x)] == 0 ? 1 : 0)
          << i << ", " << lanes << " lanes";
  }
}

TEST(ShadowKernels, FilteredLookupsWeighTheSquareOfThreeTexels) {
  constexpr int kSize = 16;
  const Plane depths = randomOccluders(kSize * kSize);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> inside(1.5, kSize - 1.5);
  std::vector<glm::dvec3> points{{1.5, 1.5, 0.5}, {4, 4, 0.5}, {4.5, 7.5, 0.5}};
  // Steps of 2^-10, which float holds.
  while (points.size() < 3000)
    points.push_back(
        {std::floor(inside(random) * 1024) / 1024, std::floor(inside(random) * 1024) / 1024, 0.5});
  std::erase_if(points, [](const glm::dvec3& p) { return p.x < 1.5 || p.y < 1.5; });
  for (const int lanes : kAllLanes) {
    const Column lit =
        visibility(lanes, parallelMap(kSize), depths, receivers(points, {0, 0, 1}, 1), kFiltered);
    for (std::size_t i = 0; i < points.size(); ++i)
      // 16 weights in [0, 1] with two roundings each, summed to 9 at most, divided by 9: below 16 roundings.
      ASSERT_NEAR(lit[i], litShare(depths, kSize, points[i].x, points[i].y, 3), 16 * kUnit)
          << i << ", " << lanes << " lanes";
  }
}

TEST(ShadowKernels, WeightsSumToOne) {
  const Plane lit_map(64, 0.0f), dark_map(64, kCloser);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 1000; ++i) points.push_back({1.5 + 5 * i / 1000.0, 6.4 - 4.8 * i / 1000.0, 0.5});
  const auto in = receivers(points, {0, 0, 1}, 1);
  for (const int lanes : kAllLanes) {
    EXPECT_EQ(visibility(lanes, parallelMap(8), dark_map, in, kFiltered), Column(points.size(), 0.0f))
        << lanes << " lanes";
    for (const float lit : visibility(lanes, parallelMap(8), lit_map, in, kFiltered)) {
      ASSERT_NEAR(lit, 1, 16 * kUnit) << lanes << " lanes";  // as above
      ASSERT_LE(lit, 1 + 2 * kUnit) << lanes << " lanes";
    }
  }
}

TEST(ShadowKernels, OutsideTheMapEverythingIsLit) {
  const Plane dark(64, kCloser);
  const auto in = receivers(
      {{-0.01, 4, 0}, {4, -0.01, 0}, {8, 4, 0}, {4, 8, 0}, {-1e30, 4, 0}, {1e30, 1e30, 0}}, {0, 0, 1}, 1);
  ShadowMap behind = parallelMap(8);
  behind.kind = kPerspectiveMap;
  behind.to_map_w = {0, 0, 1, 0};
  const auto in_behind = receivers({{4, 4, 0}, {4, 4, -1}, {-4, -4, -1}}, {0, 0, 1}, 1);
  for (const int lanes : kAllLanes) {
    for (const char* defines : {kHard, kFiltered}) {
      EXPECT_EQ(visibility(lanes, parallelMap(8), dark, in, defines), Column(6, 1.0f))
          << lanes << " lanes " << defines;
      EXPECT_EQ(visibility(lanes, behind, dark, in_behind, defines), Column(3, 1.0f))
          << lanes << " lanes " << defines;
    }
  }
}

TEST(ShadowKernels, PerspectiveMapsDivideByW) {
  // A light at the origin that shines along z: 8 texels over ±1 at z = 1; depth 2/z − 0.1. The map begins at
  // depth 3.
  ShadowMap map{};
  map.to_map_x = {4, 0, 4, 0};
  map.to_map_y = {0, 4, 4, 0};
  map.to_map_w = {0, 0, 1, 0};
  map.depth_scale = 2;
  map.depth_offset = -0.1f;
  map.size = 8;
  map.kind = kPerspectiveMap;
  map.offset = 3;
  Plane depths(3 + 64, 0.0f);
  depths[3 + 2 * 8 + 5] = 2 / 4.0f - 0.1f;  // row 2, column 5 hides what is more than 4 m away
  const auto place = [](double column, double row, double z) {
    return glm::dvec3((column - 4) / 4 * z, (row - 4) / 4 * z, z);
  };
  const auto in = receivers({place(5.5, 2.5, 3.9), place(5.5, 2.5, 4.1), place(5.1, 2.9, 9),
                             place(4.9, 2.5, 9), place(5.5, 3.1, 9)},
                            {0, 0, -1}, 1);
  for (const int lanes : kAllLanes)
    EXPECT_EQ(visibility(lanes, map, depths, in, kHard), (Column{1, 0, 0, 1, 1})) << lanes << " lanes";
}

constexpr int kFaceSize = 32;

/// A cube map around the origin, as the host plans them: four texels of border, depth 1/w. Texels without
/// width, as above.
ShadowMap cubeMap() {
  ShadowMap map{};
  map.to_map_x = {1, 0, 0, 0};
  map.to_map_y = {0, 1, 0, 0};
  map.to_map_z = {0, 0, 1, 0};
  map.depth_scale = 1;
  map.face_scale = kFaceSize / 2 - 4;
  map.size = kFaceSize;
  map.kind = kCubeMap;
  return map;
}

/// The way to a point of a face: in the order +x −x +y −y +z −z each looks along its axis, the next axis up,
/// the one after that to the right, mirrored on the negative side; rows grow downwards.
glm::dvec3 wayToTexel(int face, double column, double row) {
  const int axis = face / 2;
  const double sign = face % 2 ? -1 : 1, middle = kFaceSize / 2.0, scale = kFaceSize / 2.0 - 4;
  glm::dvec3 way(0);
  way[axis] = sign;
  way[(axis + 2) % 3] = sign * (column - middle) / scale;
  way[(axis + 1) % 3] = (middle - row) / scale;
  return way;
}

TEST(ShadowKernels, EveryTexelOfEveryCubeFaceIsFound) {
  const Plane depths = randomOccluders(6 * kFaceSize * kFaceSize);
  std::vector<glm::dvec3> points;
  Column expected;
  for (int face = 0; face < 6; ++face) {
    for (int row = 4; row < kFaceSize - 4; ++row) {
      for (int column = 4; column < kFaceSize - 4; ++column) {
        points.push_back(3.0 * wayToTexel(face, column + 0.5, row + 0.5));
        expected.push_back(depths[(face * kFaceSize + row) * kFaceSize + column] == 0 ? 1.0f : 0.0f);
      }
    }
  }
  for (const int lanes : kAllLanes)
    EXPECT_EQ(visibility(lanes, cubeMap(), depths, receivers(points, {0, 0, 1}, 1), kHard), expected)
        << lanes << " lanes";
}

TEST(ShadowKernels, CubeSeamsHaveNoHoles) {
  // All around, edges and corners of the cube included, a lookup falls into some face, its filter too.
  const Plane dark(6 * kFaceSize * kFaceSize, kCloser), open(6 * kFaceSize * kFaceSize, 0.0f);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 1000; ++i) {
    const double angle = 2 * 3.14159265358979 * i / 1000;
    points.push_back({std::cos(angle), std::sin(angle), 0});
    points.push_back({0, std::cos(angle), std::sin(angle)});
    points.push_back({std::sin(angle), std::sin(angle), std::cos(angle)});
  }
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 0.0, 1.0}) points.insert(points.end(), {{x, y, z}, {x, z, y}, {z, x, y}});
  const auto in = receivers(points, {0, 0, 1}, 1);
  for (const int lanes : kAllLanes) {
    for (const char* defines : {kHard, kFiltered}) {
      EXPECT_EQ(visibility(lanes, cubeMap(), dark, in, defines), Column(points.size(), 0.0f))
          << lanes << " lanes " << defines;
      for (const float lit : visibility(lanes, cubeMap(), open, in, defines))
        ASSERT_NEAR(lit, 1, 16 * kUnit) << lanes << " lanes";
    }
  }
}

TEST(ShadowKernels, AtTheLightItselfNothingIsNaN) {
  const Plane dark(6 * kFaceSize * kFaceSize, kCloser);
  for (const int lanes : kAllLanes)
    EXPECT_EQ(visibility(lanes, cubeMap(), dark, receivers({{0, 0, 0}}, {0, 0, 1}, 1), kFiltered), Column{1})
        << lanes << " lanes";
}

TEST(ShadowKernels, TiltedPlanesDontShadowThemselvesButStillShadow) {
  // The plane z = slope·(x + y/2) in a parallel map of unit texels, its depths taken at the texels' centres.
  constexpr int kSize = 24;
  for (const double degrees : {0.0, 30.0, 60.0, 80.0, 88.0}) {
    const double slope = std::tan(glm::radians(degrees)) / std::sqrt(1.25);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope, -slope / 2, 1));
    ShadowMap map = parallelMap(kSize);
    map.texel = 1;
    Plane depths;
    for (int row = 0; row < kSize; ++row)
      for (int column = 0; column < kSize; ++column)
        depths.push_back(float(slope * (column + 0.5 + (row + 0.5) / 2)));
    std::mt19937 random(2);
    // Clear of the border by the longest way along the normal, 1.375 · √2 · 2 texels, and the filter's reach.
    std::uniform_real_distribution<double> inside(6, kSize - 6);
    std::vector<glm::dvec3> on, below;
    for (int i = 0; i < 2000; ++i) {
      const double x = inside(random), y = inside(random);
      on.push_back({x, y, slope * (x + y / 2)});
      // The receiver moves to the light by the offset / cos θ at most, and the filter's texels reach 2·√2·tan
      // θ.
      const double sine = std::sin(glm::radians(degrees)), cosine = std::cos(glm::radians(degrees));
      below.push_back(on.back() -
                      glm::dvec3(0, 0, 2 * std::sqrt(2.0) * (1.25 * sine + 0.125 + sine) / cosine + 0.01));
    }
    for (const int lanes : kAllLanes) {
      for (const char* defines : {kHard, kFiltered}) {
        for (const float lit : visibility(lanes, map, depths, receivers(on, normal, normal.z), defines))
          ASSERT_NEAR(lit, 1, 16 * kUnit) << degrees << " degrees " << defines;
        EXPECT_EQ(visibility(lanes, map, depths, receivers(below, normal, normal.z), defines),
                  Column(below.size(), 0.0f))
            << degrees << " degrees " << defines;
      }
    }
  }
}

}  // namespace
}  // namespace luciole::test
