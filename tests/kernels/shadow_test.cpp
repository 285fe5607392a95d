#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <random>

#include "gbuffer/packed_normal.hpp"
#include "kernels/probe.hpp"
#include "kernels/shared.h"
#include "raster/coverage.hpp"
#include "single_precision.hpp"

namespace luciole::test {
namespace {

constexpr float kCloser = 1e30f;           // a depth that hides everything
constexpr double kSlopeRounding = 0x1p-8;  // see packSlopes()

/// What kernels/maps/shadow.clh may at most add to a plane's depth beyond what is lost by rounding, in texels
/// along the plane's normal as the map's slopes have it: FACET_ROUNDING there.
constexpr double kMostSlack = 0x1p-13;

/// A way to look up, and the side of the square of texels that its weights cover.
struct Method {
  const char* defines;
  int side;
  double reach;  ///< farthest texel centre that it asks, along x and along y, in texels
};
constexpr Method kHard{"-DFEATURES=ALL_FEATURES-FEATURE(SOFT)-FEATURE(PCF)", 0, 0.5},
    kFiltered{"-DFEATURES=ALL_FEATURES-FEATURE(SOFT)", 1, 1},
    kWide{"-DFEATURES=ALL_FEATURES-FEATURE(SOFT) -DPCF_WIDTH=4", 3, 2};
constexpr Method kMethods[] = {kHard, kFiltered, kWide};

struct Receiver {
  glm::dvec3 position, normal{0, 0, 1};
};

std::vector<Column> columnsOf(const std::vector<Receiver>& receivers) {
  std::vector<Column> in(6);
  for (const Receiver& receiver : receivers)
    for (int c = 0; c < 3; ++c) {
      in[c].push_back(float(receiver.position[c]));
      in[3 + c].push_back(float(receiver.normal[c]));
    }
  return in;
}

/// A map, its faces and their texels.
struct Map {
  ShadowMap map{};
  std::vector<ShadowFace> faces;
  std::vector<ShadowTexel> texels;

  void fill(float depth) { texels.assign(texels.size(), {depth, 0}); }
};

Column visibility(int lanes, const Map& map, const std::vector<Receiver>& receivers, const char* defines) {
  const auto texel_count = cl_uint(map.texels.size());
  return probe(deviceWithLanes(lanes), "shadow_probe.cl", "probe_shadow", columnsOf(receivers), 1,
               {{"map", map.map}, {"faces", map.faces}, {"texels", map.texels}, {"texel_count", texel_count}},
               defines)[0];
}

/// Where lookups go: x, y, depth, rise_x, rise_y, face, inside.
std::vector<Column> places(int lanes, const Map& map, const std::vector<Receiver>& receivers) {
  return probe(deviceWithLanes(lanes), "shadow_probe.cl", "probe_point", columnsOf(receivers), 7,
               {{"map", map.map}, {"faces", map.faces}});
}

/// Texels whose filters stay on a face of the tests' maps.
constexpr int kRim = 2;

ShadowFace wholeFace(double scale, double middle, int size, std::size_t first) {
  ShadowFace face{};
  face.scale = float(scale);
  face.middle_x = face.middle_y = float(middle);
  face.low = float(kRim);
  face.high = float(size - kRim);
  face.first = uint(first);
  face.width = uint(size);
  return face;
}

/// A parallel map whose texels are the unit squares of x and y from 0; depth is z.
Map parallelMap(int size) {
  Map result;
  result.map.to_map_x = {1, 0, 0, 0};
  result.map.to_map_y = {0, -1, 0, 0};  // rows grow downwards
  result.map.to_map_z = {0, 0, 1, 0};
  result.map.depth_scale = result.map.depth_offset = 1;
  result.map.kind = kParallelMap;
  result.map.face_count = 1;
  result.faces = {wholeFace(1, 0, size, 0)};
  result.texels.resize(std::size_t(size) * size);
  return result;
}

void coverAtRandom(Map& map) {
  std::mt19937 random(11);
  for (ShadowTexel& texel : map.texels) texel = {random() % 2 ? kCloser : 0.0f, 0};
}

/// Length that [a, a + 1] and [low, high] share.
double overlap(double a, double low, double high) {
  return std::max(std::min(a + 1, high) - std::max(a, low), 0.0);
}

/// Share of the square of `side` texels around (x, y) that is not hidden.
double litShare(const Map& map, int size, double x, double y, double side) {
  double lit = 0;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column)
      if (map.texels[row * size + column].depth == 0)
        lit += overlap(column, x - side / 2, x + side / 2) * overlap(row, y - side / 2, y + side / 2);
  return lit / (side * side);
}

/// Where nothing hides a point its weights are summed: 16 in [0, 1] with two roundings each, to 9 at most,
/// divided by 9: below 16 roundings.
constexpr double kSumRounding = 16 * kUnit;

void expectAllLit(const Column& lit, const std::string& trace) {
  for (std::size_t i = 0; i < lit.size(); ++i) ASSERT_NEAR(lit[i], 1, kSumRounding) << trace << ", " << i;
}

void expectAllDark(const Column& lit, const std::string& trace) {
  for (std::size_t i = 0; i < lit.size(); ++i) ASSERT_EQ(lit[i], 0) << trace << ", " << i;
}

std::string traceOf(int lanes, const Method& method) {
  return std::to_string(lanes) + " lanes " + method.defines;
}

TEST(ShadowKernels, HardLookupsReadTheTexelThatHoldsThePoint) {
  constexpr int kSize = 16;
  Map map = parallelMap(kSize);
  coverAtRandom(map);
  std::vector<Receiver> points;
  for (int y = kRim; y < kSize - kRim; ++y)
    for (int x = kRim; x < kSize - kRim; ++x)
      for (const double corner : {0.03125, 0.5, 0.96875}) points.push_back({{x + corner, y + corner, 0.5}});
  for (const int lanes : kAllLanes) {
    const Column lit = visibility(lanes, map, points, kHard.defines);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::ivec2 texel(points[i].position);
      ASSERT_EQ(lit[i], map.texels[texel.y * kSize + texel.x].depth == 0 ? 1 : 0)
          << i << ", " << lanes << " lanes";
    }
  }
}

TEST(ShadowKernels, FilteredLookupsWeighASquareOfTexels) {
  constexpr int kSize = 16;
  Map map = parallelMap(kSize);
  coverAtRandom(map);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> inside(kRim, kSize - kRim - 0.01);
  std::vector<Receiver> points{{{2.5, 2.5, 0.5}}, {{4, 4, 0.5}}, {{4.5, 7.5, 0.5}}};
  // Steps of 2^-10, which float holds.
  const auto any = [&] { return std::floor(inside(random) * 1024 + 1) / 1024; };
  while (points.size() < 3000) points.push_back({{any(), any(), 0.5}});
  for (const Method& method : {kFiltered, kWide})
    for (const int lanes : kAllLanes) {
      const Column lit = visibility(lanes, map, points, method.defines);
      for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_NEAR(lit[i], litShare(map, kSize, points[i].position.x, points[i].position.y, method.side),
                    kSumRounding)
            << i << ", " << traceOf(lanes, method);
    }
}

TEST(ShadowKernels, WeightsSumToOne) {
  Map map = parallelMap(12);
  std::vector<Receiver> points;
  for (int i = 0; i < 1000; ++i) points.push_back({{2.1 + 7.8 * i / 1000.0, 9.9 - 7.7 * i / 1000.0, 0.5}});
  for (const int lanes : kAllLanes)
    for (const Method& method : kMethods) {
      map.fill(kCloser);
      expectAllDark(visibility(lanes, map, points, method.defines), traceOf(lanes, method));
      map.fill(0);
      for (const float lit : visibility(lanes, map, points, method.defines)) {
        ASSERT_NEAR(lit, 1, kSumRounding) << traceOf(lanes, method);
        ASSERT_LE(lit, 1 + 2 * kUnit) << traceOf(lanes, method);
      }
    }
}

TEST(ShadowKernels, OutsideTheMapEverythingIsLit) {
  Map dark = parallelMap(8);
  dark.fill(kCloser);
  const std::vector<Receiver> outside{{{kRim - 0.01, 4, 0}}, {{4, kRim - 0.01, 0}}, {{8.01 - kRim, 4, 0}},
                                      {{4, 8.01 - kRim, 0}}, {{-1e30, 4, 0}},       {{1e30, 1e30, 0}}};
  Map behind = dark;
  behind.map.kind = kPerspectiveMap;
  behind.faces = {wholeFace(4, 4, 8, 0)};
  const std::vector<Receiver> around{{{4, 4, 0}}, {{0, 0, -1}}, {{-4, -4, -1}}, {{3, 0, 1}}, {{0, 1e30, 1}}};
  for (const int lanes : kAllLanes)
    for (const Method& method : kMethods) {
      EXPECT_EQ(visibility(lanes, dark, outside, method.defines), Column(outside.size(), 1.0f))
          << traceOf(lanes, method);
      EXPECT_EQ(visibility(lanes, behind, around, method.defines), Column(around.size(), 1.0f))
          << traceOf(lanes, method);
    }
}

TEST(ShadowKernels, PerspectiveMapsDivideByW) {
  // A light at the origin that shines along z: 8 texels over ±1 at z = 1; depth 2/z − 0.1. The texels begin
  // at place 3.
  Map map;
  map.map.to_map_x = {1, 0, 0, 0};
  map.map.to_map_y = {0, -1, 0, 0};
  map.map.to_map_z = {0, 0, 1, 0};
  map.map.depth_scale = 2;
  map.map.depth_offset = -0.1f;
  map.map.kind = kPerspectiveMap;
  map.map.face_count = 1;
  map.faces = {wholeFace(4, 4, 8, 3)};
  map.texels.assign(3 + 64, {0.0f, 0});
  // Row 2, column 5 hides what is more than 4 m away.
  map.texels[3 + 2 * 8 + 5].depth = 2 / 4.0f - 0.1f;
  const auto place = [](double column, double row, double z) {
    return Receiver{{(column - 4) / 4 * z, (row - 4) / 4 * z, z}, {0, 0, -1}};
  };
  const std::vector<Receiver> points{place(5.5, 2.5, 3.9), place(5.5, 2.5, 4.1), place(5.1, 2.9, 9),
                                     place(4.9, 2.5, 9), place(5.5, 3.1, 9)};
  for (const int lanes : kAllLanes)
    EXPECT_EQ(visibility(lanes, map, points, kHard.defines), (Column{1, 0, 0, 1, 1})) << lanes << " lanes";
}

constexpr int kFaceSize = 32, kFaceRim = 4;

/// A cube map around the origin, as the host plans them: four texels of border, depth 1/w.
Map cubeMap() {
  Map result;
  result.map.to_map_x = {1, 0, 0, 0};
  result.map.to_map_y = {0, 1, 0, 0};
  result.map.to_map_z = {0, 0, 1, 0};
  result.map.depth_scale = 1;
  result.map.kind = kCubeMap;
  result.map.face_count = 6;
  for (int face = 0; face < 6; ++face)
    result.faces.push_back(
        wholeFace(kFaceSize / 2 - kFaceRim, kFaceSize / 2, kFaceSize, face * kFaceSize * kFaceSize));
  result.texels.resize(6 * kFaceSize * kFaceSize);
  return result;
}

/// The way to a point of a face: in the order +x −x +y −y +z −z each looks along its axis, the next axis up,
/// the one after that to the right, mirrored on the negative side; rows grow downwards.
glm::dvec3 wayToTexel(int face, double column, double row) {
  const int axis = face / 2;
  const double sign = face % 2 ? -1 : 1, middle = kFaceSize / 2.0, scale = kFaceSize / 2.0 - kFaceRim;
  glm::dvec3 way(0);
  way[axis] = sign;
  way[(axis + 2) % 3] = sign * (column - middle) / scale;
  way[(axis + 1) % 3] = (middle - row) / scale;
  return way;
}

/// Facing the light in the origin.
Receiver facingTheOrigin(const glm::dvec3& position) { return {position, -glm::normalize(position)}; }

TEST(ShadowKernels, EveryTexelOfEveryCubeFaceIsFound) {
  Map map = cubeMap();
  coverAtRandom(map);
  std::vector<Receiver> points;
  Column expected;
  for (int face = 0; face < 6; ++face)
    for (int row = kFaceRim; row < kFaceSize - kFaceRim; ++row)
      for (int column = kFaceRim; column < kFaceSize - kFaceRim; ++column) {
        points.push_back(facingTheOrigin(3.0 * wayToTexel(face, column + 0.5, row + 0.5)));
        expected.push_back(map.texels[(face * kFaceSize + row) * kFaceSize + column].depth == 0 ? 1 : 0);
      }
  for (const int lanes : kAllLanes)
    EXPECT_EQ(visibility(lanes, map, points, kHard.defines), expected) << lanes << " lanes";
}

TEST(ShadowKernels, CubeSeamsHaveNoHoles) {
  // All around, edges and corners of the cube included, a lookup falls into some face, its filter too.
  Map dark = cubeMap(), open = cubeMap();
  dark.fill(kCloser);
  open.fill(0);
  std::vector<Receiver> points;
  for (int i = 0; i < 1000; ++i) {
    const double angle = 2 * 3.14159265358979 * i / 1000, sine = std::sin(angle), cosine = std::cos(angle);
    for (const glm::dvec3& way : {glm::dvec3(cosine, sine, 0), {0, cosine, sine}, {sine, sine, cosine}})
      points.push_back(facingTheOrigin(way));
  }
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 0.0, 1.0})
        for (const glm::dvec3& way : {glm::dvec3(x, y, z), {x, z, y}, {z, x, y}})
          points.push_back(facingTheOrigin(way));
  for (const int lanes : kAllLanes)
    for (const Method& method : kMethods) {
      expectAllDark(visibility(lanes, dark, points, method.defines), traceOf(lanes, method));
      expectAllLit(visibility(lanes, open, points, method.defines), traceOf(lanes, method));
    }
}

TEST(ShadowKernels, AtTheLightItselfNothingIsNaN) {
  Map map = cubeMap();
  map.fill(kCloser);
  std::vector<Receiver> points;
  for (const double away : {0.0, 1e-44, 1e-38, 1e-30, 1e-20})
    for (const glm::dvec3& normal : {glm::dvec3(0, 0, 1), {0.6, 0, -0.8}, {-0.6, 0.8, 0}, {-1, 0, 0}})
      points.push_back({{away, away, -away}, normal});
  for (const int lanes : kAllLanes)
    for (const Method& method : kMethods) {
      const Column lit = visibility(lanes, map, points, method.defines);
      for (std::size_t i = 0; i < lit.size(); ++i)
        ASSERT_TRUE(lit[i] >= 0 && lit[i] <= 1 + 2 * kUnit) << i << ", " << traceOf(lanes, method);
      for (int i = 0; i < 4; ++i) EXPECT_EQ(lit[i], 1) << traceOf(lanes, method);
    }
}

TEST(ShadowKernels, DrawnRectanglesAreReadWhereTheyLie) {
  // Of a face of 64 texels a side columns 40 to 54 and rows 21 to 28 were drawn, to place 5: texel (0, 0)
  // would lie before the buffer.
  constexpr int kFirstX = 40, kFirstY = 21, kWidth = 15, kHeight = 8;
  Map map = parallelMap(64);
  map.texels.assign(5 + kWidth * kHeight, {0.0f, 0});
  coverAtRandom(map);
  map.faces[0].first = 5u - kFirstY * kWidth - kFirstX;
  map.faces[0].width = kWidth;
  std::vector<Receiver> points;
  Column expected;
  for (int row = 0; row < kHeight; ++row)
    for (int column = 0; column < kWidth; ++column) {
      points.push_back({{kFirstX + column + 0.5, kFirstY + row + 0.5, 0.5}});
      expected.push_back(map.texels[5 + row * kWidth + column].depth == 0 ? 1 : 0);
    }
  for (const int lanes : kAllLanes)
    EXPECT_EQ(visibility(lanes, map, points, kHard.defines), expected) << lanes << " lanes";
}

constexpr int kCascadeSize = 16;

/// Three cascades around the origin, that reach 1.5, 6 and 24 m to each side.
Map cascades() {
  Map map = parallelMap(kCascadeSize);
  map.map.face_count = 3;
  map.faces.clear();
  for (const double scale : {4.0, 1.0, 0.25})
    map.faces.push_back(
        wholeFace(scale, kCascadeSize / 2, kCascadeSize, map.faces.size() * kCascadeSize * kCascadeSize));
  map.texels.resize(3 * kCascadeSize * kCascadeSize);
  return map;
}

TEST(ShadowKernels, PointInSeveralCascadesUsesTheFinest) {
  std::vector<Receiver> points;
  std::vector<int> finest;  // 3: none
  std::mt19937 random(9);
  for (int i = 0; i < 2000; ++i) {
    const double reach = std::exp2(double(random() % 700) / 100 - 1);
    const auto any = [&] { return reach * (double(random() % 2001) / 1000 - 1); };
    const glm::dvec2 place(any(), any());
    const double farthest = std::max(std::abs(place.x), std::abs(place.y));
    // What lies on a rim to within rounding may be in or out.
    if (std::abs(farthest - 1.5) < 1e-5 || std::abs(farthest - 6) < 1e-5 || std::abs(farthest - 24) < 1e-5)
      continue;
    points.push_back({{place, 0.5}});
    finest.push_back(farthest < 1.5 ? 0 : farthest < 6 ? 1 : farthest < 24 ? 2 : 3);
  }
  for (int cascade = 0; cascade < 4; ++cascade)
    ASSERT_GT(std::count(finest.begin(), finest.end(), cascade), 100) << cascade;
  for (int dark = 0; dark < 3; ++dark) {
    Map map = cascades();
    map.fill(0);
    for (int i = 0; i < kCascadeSize * kCascadeSize; ++i)
      map.texels[dark * kCascadeSize * kCascadeSize + i].depth = kCloser;
    for (const int lanes : kAllLanes)
      for (const Method& method : kMethods) {
        const Column lit = visibility(lanes, map, points, method.defines);
        for (std::size_t i = 0; i < lit.size(); ++i)
          ASSERT_NEAR(lit[i], finest[i] != dark, kSumRounding) << i << ", " << traceOf(lanes, method);
      }
  }
}

TEST(ShadowKernels, CascadesAgreeOnTheSurfaceAndItsSlopesAMetre) {
  // The same receiver in each cascade alone.
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.5, 0.9));
  const std::vector<Receiver> points{{{0.7, -0.3, 1.25}, normal}};
  for (const int lanes : kAllLanes)
    for (int cascade = 0; cascade < 3; ++cascade) {
      Map map = cascades();
      map.map.first_face = uint(cascade);
      map.map.face_count = 1;
      const std::vector<Column> place = places(lanes, map, points);
      const double scale = map.faces[cascade].scale;
      EXPECT_EQ(place[5][0], cascade);
      EXPECT_EQ(place[6][0], 1);
      EXPECT_EQ(place[2][0], 1.25f);
      // A product and a sum up to 16 each.
      EXPECT_NEAR(place[0][0], 8 + scale * 0.7, 32 * kUnit);
      EXPECT_NEAR(place[1][0], 8 - scale * 0.3, 32 * kUnit);
      // Normals round, then a product, a quotient and a product.
      EXPECT_NEAR(place[3][0] * scale, -0.3 / 0.9, 6 * kUnit) << lanes << " lanes";
      EXPECT_NEAR(place[4][0] * scale, 0.5 / 0.9, 6 * kUnit) << lanes << " lanes";
    }
}

TEST(ShadowKernels, RisesInPerspectiveAreThePlanesOwnSteps) {
  // Depth of a plane through a point, a texel to the right and a texel down, by intersecting the ways there.
  const Map map = cubeMap();
  std::mt19937 random(17);
  std::normal_distribution<double> any;
  std::vector<Receiver> points;
  while (points.size() < 500) {
    const glm::dvec3 way = 3.0 * wayToTexel(int(random() % 6), 4.5 + random() % 23, 4.5 + random() % 23);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(any(random), any(random), any(random)));
    if (glm::dot(normal, -glm::normalize(way)) > 0.2) points.push_back({way, normal});
  }
  for (const int lanes : kAllLanes) {
    const std::vector<Column> place = places(lanes, map, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int face = int(place[5][i]);
      const double x = place[0][i], y = place[1][i];
      // On a way (…, 1 ahead), distance ahead is w, and depth 1/w is linear in the texel: any step will do.
      const auto depth = [&](double column, double row) {
        return glm::dot(points[i].normal, wayToTexel(face, column, row)) /
               glm::dot(points[i].normal, points[i].position);
      };
      // The cosine to the light comes as a sum of three products: within 8 roundings of |way| ≤ 5.2, that is
      // 5 of it where the cosine is above 0.2: 40 roundings of the rise, which is at most 5 of depth 1/3 a
      // scale.
      const double allowed = 48 * kUnit * 5 / 3.0 / (kFaceSize / 2 - kFaceRim);
      ASSERT_NEAR(place[3][i], depth(x + 1, y) - depth(x, y), allowed) << i << ", " << lanes << " lanes";
      ASSERT_NEAR(place[4][i], depth(x, y + 1) - depth(x, y), allowed) << i << ", " << lanes << " lanes";
    }
  }
}

/// A surface over the map: z of x and y, and its slopes there.
struct Slopes {
  double z, dx, dy;
};
using Relief = std::function<Slopes(double x, double y)>;

constexpr int kReliefSize = 24;

/// As the rasterizer draws it: what the texels' centres see.
Map drawn(const Relief& relief) {
  Map map = parallelMap(kReliefSize);
  for (int row = 0; row < kReliefSize; ++row)
    for (int column = 0; column < kReliefSize; ++column) {
      const Slopes at = relief(column + 0.5, row + 0.5);
      map.texels[row * kReliefSize + column] = {float(at.z), packSlopes(float(at.dx), float(at.dy))};
    }
  return map;
}

/// The normal there, as a G-buffer has it.
glm::dvec3 geometricNormal(const Slopes& at) { return unpackNormal(packNormal({-at.dx, -at.dy, 1})); }

/// Points of a relief at random places.
std::vector<Receiver> pointsOf(const Relief& relief, int count) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> inside(kRim + 0.01, kReliefSize - kRim - 0.01);
  std::vector<Receiver> points;
  for (int i = 0; i < count; ++i) {
    const double x = inside(random), y = inside(random);
    const Slopes at = relief(x, y);
    points.push_back({{x, y, at.z}, geometricNormal(at)});
  }
  return points;
}

std::vector<Receiver> loweredBy(std::vector<Receiver> points, double depth) {
  for (Receiver& point : points) point.position.z -= depth;
  return points;
}

Relief tiltedPlane(double degrees) {
  const double slope = std::tan(glm::radians(degrees)) / std::sqrt(1.25);
  return [slope](double x, double y) { return Slopes{slope * (x + y / 2), slope, slope / 2}; };
}

/// How far below the plane everything is dark, whatever the texel: by what depths and positions (up to 1024,
/// where 88 degrees take them) have lost, 2⁻²¹ of the position as the kernel allows for and as much again in
/// truth; that times the slope, since a place lost is depth lost; by kMostSlack texels along the normal; and
/// by what the plane falls over the filter's reach, because a texel whose centre sees it beyond the receiver
/// doesn't hide that. Slopes are rounded, and texels allow for that with 2⁻⁷.
double surelyDark(double degrees, const Method& method) {
  const double cosine = std::cos(glm::radians(degrees));
  const double steep = 1.5 * std::tan(glm::radians(degrees)) / std::sqrt(1.25);
  const double lost = 2 * 0x1p-21 * (2 * kReliefSize + kReliefSize * steep) + 0x1p-21;
  return lost * (1 + steep) + kMostSlack / (cosine * cosine) + steep * 0x1p-7 +
         method.reach * steep * (1 + kSlopeRounding);
}

TEST(ShadowKernels, TiltedPlanesDontShadowThemselvesButWhatIsBelow) {
  for (const double degrees : {0.0, 30.0, 45.0, 60.0, 70.0, 80.0, 84.0, 86.0, 87.0, 88.0}) {
    const Relief plane = tiltedPlane(degrees);
    const Map map = drawn(plane);
    const std::vector<Receiver> on = pointsOf(plane, 2000);
    for (const Method& method : kMethods) {
      const std::vector<Receiver> below = loweredBy(on, surelyDark(degrees, method));
      for (const int lanes : kAllLanes) {
        const std::string trace = std::to_string(degrees) + " degrees, " + traceOf(lanes, method);
        expectAllLit(visibility(lanes, map, on, method.defines), trace);
        expectAllDark(visibility(lanes, map, below, method.defines), trace);
      }
    }
  }
}

/// Two planes that meet along a line across the map: the lower of both (convex) or the higher (concave).
Relief bend(std::mt19937& random, bool convex) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double angle = 3.14159265358979 * unit(random), offset = kReliefSize / 2 + unit(random);
  const glm::dvec2 across(std::cos(angle), std::sin(angle));
  // Up to 80 degrees.
  const glm::dvec2 along(-across.y, across.x);
  const double first = std::tan(1.39 * unit(random)), second = std::tan(1.39 * unit(random)),
               rise = std::tan(1.2 * unit(random));
  return [=](double x, double y) {
    const glm::dvec2 p = glm::dvec2(x, y) - offset;
    const double d = glm::dot(p, across);
    const bool use_first = (first * d < second * d) == convex;
    const double slope = use_first ? first : second;
    const glm::dvec2 slopes = slope * across + rise * along;
    return Slopes{glm::dot(p, slopes), slopes.x, slopes.y};
  };
}

TEST(ShadowKernels, ConvexAndConcaveEdgesDontShadowThemselves) {
  std::mt19937 random(21);
  for (const bool convex : {true, false})
    for (int i = 0; i < 25; ++i) {
      const Relief relief = bend(random, convex);
      const Map map = drawn(relief);
      const std::vector<Receiver> points = pointsOf(relief, 2000);
      for (const Method& method : kMethods)
        for (const int lanes : {1, 16})
          expectAllLit(visibility(lanes, map, points, method.defines),
                       (convex ? "convex " : "concave ") + std::to_string(i) + ", " + traceOf(lanes, method));
    }
}

TEST(ShadowKernels, OccluderAboveATiltedFloorShadows) {
  // A level one over a contour line of the floor. What the floor itself rises by within the filter's reach,
  // which surelyDark() has, is what a texel can't tell from it.
  for (const double degrees : {0.0, 30.0, 45.0, 60.0, 75.0}) {
    const Relief floor = tiltedPlane(degrees);
    std::vector<Receiver> points;
    double z = 0;
    for (int i = 0; i < 500; ++i) {
      const double y = kRim + 0.01 + (kReliefSize - 2 * kRim - 0.02) * i / 500, x = 17.3 - y / 2;
      const Slopes at = floor(x, y);
      points.push_back({{x, y, at.z}, geometricNormal(at)});
      z = at.z;
    }
    for (const Method& method : kMethods)
      for (const int lanes : kAllLanes) {
        Map map = parallelMap(kReliefSize);
        map.fill(float(z + surelyDark(degrees, method)));
        expectAllDark(visibility(lanes, map, points, method.defines), traceOf(lanes, method));
        // Below the line, if above lower parts of the floor, it hides nothing of the line.
        map.fill(float(z - 1e-4));
        expectAllLit(visibility(lanes, map, points, method.defines), traceOf(lanes, method));
      }
  }
}

// A light so large that the filter is as wide as it may be. Towards the light the plane above hides the whole
// filter; on the other side, from half the radius on, it has sunk below the points, and leaves (π/3 − √3/4)/π
// = 0.196 of the disc lit.
TEST(ShadowKernels, SoftLookupsSeeAPlaneAboveATiltedFloorOnItsUpperSide) {
  constexpr double kReach = 6;
  for (const double degrees : {30.0, 45.0, 60.0}) {
    const Relief plane = tiltedPlane(degrees);
    Map map = drawn(plane);
    map.map.filter_radius = float(kReach + 2);
    map.map.penumbra_scale = 1e6f;
    std::vector<Receiver> points;
    for (int i = 0; i < 400; ++i) {
      const double x = 10 + 0.01 * i, y = 14 - 0.0097 * i;
      const Slopes at = plane(x, y);
      points.push_back({{x, y, at.z - 0.5 * kReach * std::tan(glm::radians(degrees))}, geometricNormal(at)});
    }
    for (const int lanes : kAllLanes)
      for (const float lit : visibility(lanes, map, points, "-DFEATURES=ALL_FEATURES-FEATURE(PCF)"))
        // A texel's centre is up to 1/√2 texel beside the point that asks, over the line's √3·kReach texels
        // that is 0.065 of the disc: 2 of 32 points.
        ASSERT_NEAR(lit, 0.196, 2.0 / 32) << degrees << " degrees, " << lanes << " lanes";
  }
}

// Beyond the map everything is lit, so such a lift would take away the shadow in which a point lies.
TEST(ShadowKernels, ALiftThatLeadsOffTheMapIsNotTaken) {
  constexpr int kSide = 8;
  Map map = parallelMap(kSide);
  map.map.kind = kPerspectiveMap;
  map.faces = {wholeFace(2, 4, kSide, 0)};
  map.fill(kCloser);
  // At a distance of 1 the map's last texels end at x = 1: these points stand up to 0.2 before.
  std::vector<Receiver> points;
  Column lifts;
  for (int i = 0; i < 64; ++i) {
    points.push_back({{0.8 + i / 400.0, 0, 1}, glm::normalize(glm::dvec3(1, 0, -0.5))});
    lifts.push_back(i % 3 == 0 ? 0.0f : 0.01f * float(i));
  }
  std::vector<Column> in = columnsOf(points);
  in.push_back(lifts);
  const auto texel_count = cl_uint(map.texels.size());
  for (const int lanes : kAllLanes)
    for (const Method& method : kMethods)
      expectAllDark(
          probe(
              deviceWithLanes(lanes), "shadow_probe.cl", "probe_receiver", in, 1,
              {{"map", map.map}, {"faces", map.faces}, {"texels", map.texels}, {"texel_count", texel_count}},
              method.defines)[0],
          traceOf(lanes, method));
}

TEST(ShadowKernels, PlaneThatFacesAwayExcusesNothing) {
  // Its shading normal may face the light. What stands above it by more than a rounding hides it, however
  // steep it is.
  Map map = parallelMap(kReliefSize);
  std::vector<Receiver> points;
  for (const double degrees : {91.0, 95.0, 120.0, 150.0, 180.0})
    for (int i = 0; i < 100; ++i)
      points.push_back({{12 + 0.013 * i, 12.7 - 0.07 * i, 1},
                        {std::sin(glm::radians(degrees)), 0, std::cos(glm::radians(degrees))}});
  for (const Method& method : kMethods)
    for (const int lanes : kAllLanes) {
      map.fill(1 + kMostSlack + 0x1p-15f);
      expectAllDark(visibility(lanes, map, points, method.defines), traceOf(lanes, method));
      map.fill(1);
      expectAllLit(visibility(lanes, map, points, method.defines), traceOf(lanes, method));
    }
}

}  // namespace
}  // namespace luciole::test
