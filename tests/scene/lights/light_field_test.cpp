#include "scene/lights/light_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "luciole/error.hpp"
#include "scene/bounds.hpp"

namespace luciole {
namespace {

std::vector<Light> expand(const LightField& field) {
  Scene scene;
  expandLightField(field, scene);
  return scene.lights;
}

TEST(LightField, FirstLightsAreTheSameOnEveryMachine) {
  // From SplitMix64 written in Python, seed 1 for places and ~1 for looks, exact to the bit.
  LightField field;
  field.count = 2;
  field.seed = 1;
  field.low = {-1, 0, 5};
  field.high = {3, 2, 6};
  field.colors = {{1, 0, 0}, {0, 1, 0}};
  field.intensity = {2, 4};
  field.range = {1, 3};
  const std::vector<Light> lights = expand(field);
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_EQ(lights[0].position, glm::dvec3(1.2662463006891236, 1.4915635145254023, 5.971002753586796));
  EXPECT_EQ(lights[1].position, glm::dvec3(0.7774368682230883, 0.8885294016527161, 5.762894391911761));
  EXPECT_EQ(lights[0].diffuse, glm::vec3(0, static_cast<float>(2 + 2 * 0.7278836129897747), 0));
  EXPECT_EQ(lights[1].diffuse, glm::vec3(static_cast<float>(2 + 2 * 0.4697649529128548), 0, 0));
  EXPECT_EQ(lights[0].range, static_cast<float>(1 + 2 * 0.8157512234965084));
  EXPECT_EQ(lights[1].range, static_cast<float>(1 + 2 * 0.8451342365454623));

  field.shape = FieldShape::kBall;
  EXPECT_EQ(expand(field)[0].position,
            glm::dvec3(-0.11128156588845584, -0.1114705983472839, 0.525788783823522));
  field.shape = FieldShape::kSphere;
  EXPECT_EQ(expand(field)[0].position,
            glm::dvec3(0.22913329545616867, 0.8460855059220949, 0.4812870760595477));
}

/// Two right triangles, of areas 3 and 1/2, which face +z and +x.
Scene twoTriangles() {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 1}, {0, 1, 1}, {0, 0, 2}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  scene.meshes.push_back(mesh);
  scene.objects.push_back({});
  return scene;
}

std::vector<Light> expandOn(Scene scene, const LightField& field) {
  expandLightField(field, scene);
  return scene.lights;
}

TEST(LightField, FirstLightsOfLaterShapesAreTheSameOnEveryMachine) {
  // From a second implementation in Python, exact to the bit.
  LightField field;
  field.count = 3;
  field.seed = 1;
  field.low = {-1, 0, 5};
  field.high = {3, 2, 6};
  field.shape = FieldShape::kClusters;
  field.clusters = 3;
  field.radius = 0.5;
  std::vector<Light> lights = expand(field);
  EXPECT_EQ(lights[0].position, glm::dvec3(2.5940299034545364, 1.7699618436224318, 5.689289195244419));
  EXPECT_EQ(lights[1].position, glm::dvec3(2.6310568475158935, 1.5567467537734883, 5.441323367891727));
  field.shape = FieldShape::kCurve;
  field.points = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 3}};
  field.radius = 0.25;
  lights = expand(field);
  EXPECT_EQ(lights[0].position, glm::dvec3(0.8440423683827061, 2.256218054450562, 0.5729442894735053));
  EXPECT_EQ(lights[1].position, glm::dvec3(0.8500538024138815, 2.210812693443348, 0.0801727038789184));
  field.shape = FieldShape::kSurface;
  field.offset = 0.125;
  lights = expandOn(twoTriangles(), field);
  EXPECT_EQ(lights[0].position, glm::dvec3(0.5084364854745977, 0.08699173923961134, 0.125));
  EXPECT_EQ(lights[1].position, glm::dvec3(1.111470598347284, 0.711316824264717, 0.125));
  EXPECT_EQ(lights[2].position, glm::dvec3(0.125, 0.5230671798509814, 1.2855086843969667));
}

TEST(LightField, SmallerCountGivesTheFirstLightsOfALarger) {
  LightField field = fieldInBox(FieldShape::kBox, {{-1, 0, -1}, {1, 1, 1}});
  field.list.resize(1000);
  for (std::size_t i = 0; i < field.list.size(); ++i) field.list[i].position.x = double(i);
  field.range = {1, 2};
  for (const FieldShape shape :
       {FieldShape::kBox, FieldShape::kBall, FieldShape::kSphere, FieldShape::kSurface, FieldShape::kClusters,
        FieldShape::kCurve, FieldShape::kList}) {
    field.shape = shape;
    field.count = 1000;
    const std::vector<Light> many = expandOn(twoTriangles(), field);
    field.count = 10;
    const std::vector<Light> few = expandOn(twoTriangles(), field);
    ASSERT_EQ(few.size(), 10u);
    for (std::size_t i = 0; i < few.size(); ++i) {
      EXPECT_EQ(few[i].position, many[i].position) << int(shape);
      EXPECT_EQ(few[i].range, many[i].range) << int(shape);
    }
  }
}

TEST(LightField, LooksMoveNoLightAndSeedsDo) {
  LightField field;
  field.count = 3;
  const std::vector<Light> plain = expand(field);
  field.colors.emplace_back(1, 0, 0);
  field.colors.emplace_back(0, 1, 0);
  field.range = {2, 9};
  EXPECT_EQ(expand(field)[2].position, plain[2].position);
  field.seed = 1;
  EXPECT_NE(expand(field)[2].position, plain[2].position);
}

TEST(LightField, ShapesAreFilledEvenly) {
  constexpr int kCount = 100'000;
  LightField field;
  field.count = kCount;
  field.center = {10, -20, 30};
  field.radius = 2;
  const auto means = [&](FieldShape shape) {
    field.shape = shape;
    const glm::dvec3 center = shape == FieldShape::kBox ? glm::dvec3(0.5) : field.center;
    glm::dvec3 mean{0.0}, square{0.0};
    for (const Light& light : expand(field)) {
      const glm::dvec3 p = light.position - center;
      if (shape == FieldShape::kBox) {
        EXPECT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 0.5);
      }
      // Coordinates up to 32 have an error of 2⁻⁴⁸ in each of centre + offset and back, over three
      // components; the point on the unit sphere has some 2⁻⁵² of its own: below 2·10⁻¹⁴ m together.
      if (shape == FieldShape::kBall) {
        EXPECT_LE(glm::length(p), 2 + 2e-14);
      }
      if (shape == FieldShape::kSphere) {
        EXPECT_NEAR(glm::length(p), 2, 2e-14);
      }
      mean += p / double(kCount);
      square += p * p / double(kCount);
    }
    return std::pair(mean, square);
  };
  // Moments of one coordinate: E x², E x⁴. Six standard errors: sqrt(E x² / n) of the mean, sqrt((E x⁴ − (E
  // x²)²) / n) of the mean square.
  const auto check = [&](FieldShape shape, double second, double fourth) {
    const auto [mean, square] = means(shape);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(mean[i], 0, 6 * std::sqrt(second / kCount)) << int(shape);
      EXPECT_NEAR(square[i], second, 6 * std::sqrt((fourth - second * second) / kCount)) << int(shape);
    }
  };
  const double r2 = 4;
  check(FieldShape::kBox, 1.0 / 12, 1.0 / 80);
  check(FieldShape::kBall, r2 / 5, 3 * r2 * r2 / 35);
  check(FieldShape::kSphere, r2 / 3, r2 * r2 / 5);
}

/// Five standard errors of a count of n draws, each of which counts with this probability.
double fiveSigma(double n, double probability) { return 5 * std::sqrt(n * probability * (1 - probability)); }

TEST(LightField, SurfacesGetLightsByTheirAreaInTheWorld) {
  constexpr int kCount = 70'000;
  Scene scene = twoTriangles();
  // The same mesh once more, 10 m away and twice as large: areas 3, 1/2, 12, 2. The sum is 17.5.
  Object larger;
  larger.object_to_world = glm::dmat4(2.0);
  larger.object_to_world[3] = {10, 0, 0, 1};
  scene.objects.push_back(larger);
  LightField field;
  field.count = kCount;
  field.shape = FieldShape::kSurface;
  const double areas[]{3, 0.5, 12, 2};
  int counts[4]{};
  int lower_half = 0;
  for (const Light& light : expandOn(scene, field)) {
    const glm::dvec3 p = light.position;
    const bool is_large = p.x > 5, faces_x = p.z > 0;
    ++counts[2 * is_large + faces_x];
    // Below the line that halves the height, a right triangle has 3/4 of its area.
    lower_half += is_large && !faces_x && p.y < 3;
  }
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(counts[i], kCount * areas[i] / 17.5, fiveSigma(kCount, areas[i] / 17.5)) << i;
  EXPECT_NEAR(lower_half, kCount * 9 / 17.5, fiveSigma(kCount, 9 / 17.5));
}

TEST(LightField, SurfaceLightsLieInFrontEvenOfMirroredTriangles) {
  Scene scene = twoTriangles();
  scene.meshes[0].triangles.pop_back();
  LightField field;
  field.count = 10;
  field.shape = FieldShape::kSurface;
  field.offset = 0.5;
  for (const Light& light : expandOn(scene, field)) EXPECT_EQ(light.position.z, 0.5);
  // Mirrored in x it still faces +z, mirrored in z it faces −z.
  scene.objects[0].object_to_world[0][0] = -1;
  for (const Light& light : expandOn(scene, field)) EXPECT_EQ(light.position.z, 0.5);
  scene.objects[0].object_to_world[0][0] = 1;
  scene.objects[0].object_to_world[2][2] = -1;
  for (const Light& light : expandOn(scene, field)) EXPECT_EQ(light.position.z, -0.5);
}

TEST(LightField, SceneWithoutAreaHasNoSurfaceForLights) {
  LightField field;
  field.count = 1;
  field.shape = FieldShape::kSurface;
  EXPECT_THROW(expandOn({}, field), InputError);
  Scene flat = twoTriangles();
  flat.objects[0].object_to_world[0][0] = flat.objects[0].object_to_world[1][1] = 0;
  EXPECT_THROW(expandOn(flat, field), InputError);
}

TEST(LightField, ClustersAreDenseInTheMiddleAndSpreadOverTheBox) {
  constexpr int kCount = 100'000;
  LightField field;
  field.count = kCount;
  field.shape = FieldShape::kClusters;
  field.radius = 2;
  // All in one point of a box without size: the moments of the mean of two points of a ball. With r²/5 and 3
  // r⁴/35 for one point, E x² = r²/10 and E x⁴ = (2 · 3 r⁴/35 + 6 (r²/5)²) / 16.
  field.low = field.high = {10, -20, 30};
  const double second = 4.0 / 10, fourth = (2 * 3 * 16.0 / 35 + 6 * 16.0 / 25) / 16;
  glm::dvec3 mean{0.0}, square{0.0};
  for (const Light& light : expand(field)) {
    const glm::dvec3 p = light.position - field.low;
    // As for the ball in ShapesAreFilledEvenly.
    ASSERT_LE(glm::length(p), 2 + 2e-14);
    mean += p / double(kCount);
    square += p * p / double(kCount);
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(mean[i], 0, 5 * std::sqrt(second / kCount));
    EXPECT_NEAR(square[i], second, 5 * std::sqrt((fourth - second * second) / kCount));
  }
  // Tiny clusters: their centres halve the box, each has its share of the lights.
  constexpr int kClusters = 1000;
  field.clusters = kClusters;
  field.radius = 1e-9;
  field.low = {-1, -1, -1};
  field.high = {1, 1, 1};
  std::map<std::array<long, 3>, int> shares;
  for (const Light& light : expand(field)) {
    const glm::dvec3 p = light.position * 1e6;  // two of the centres a micrometre apart: one in 10¹²
    ++shares[{std::lround(p.x), std::lround(p.y), std::lround(p.z)}];
  }
  // A light that straddles a rounding border makes a place of its own; with borders every 1e-6 and clusters
  // 2e-9 wide that happens to 0.2 % of 3 coordinates: some 6 clusters in 1000.
  EXPECT_NEAR(double(shares.size()), kClusters, 5 * std::sqrt(6.0) + 6);
  int left = 0;
  for (const auto& [place, share] : shares) left += place[0] < 0;
  EXPECT_NEAR(left, kClusters / 2.0, fiveSigma(kClusters, 0.5) + 5 * std::sqrt(6.0) + 6);
}

TEST(LightField, CurveIsEvenInLengthAndPassesThroughItsPoints) {
  constexpr int kCount = 100'000;
  LightField field;
  field.count = kCount;
  field.shape = FieldShape::kCurve;
  field.radius = 0;
  // A straight line with unequal steps: Catmull-Rom doesn't leave it, nor turn back (steps of 1 to 3).
  field.points = {{0, 1, 2}, {1, 1, 2}, {4, 1, 2}};
  int first_quarter = 0, first_half = 0;
  for (const Light& light : expand(field)) {
    ASSERT_EQ(light.position.y, 1);
    ASSERT_EQ(light.position.z, 2);
    ASSERT_GE(light.position.x, 0);
    ASSERT_LE(light.position.x, 4);
    first_quarter += light.position.x < 1;
    first_half += light.position.x < 2;
  }
  EXPECT_NEAR(first_quarter, kCount / 4.0, fiveSigma(kCount, 0.25));
  EXPECT_NEAR(first_half, kCount / 2.0, fiveSigma(kCount, 0.5));
  // A bend: of a curve some 4 m long, the nearest of 100 000 lights is within 1 mm of a point with
  // probability 1 − exp(−50).
  field.points = {{0, 0, 0}, {1, 1, 0}, {2, 0, 1}};
  for (const glm::dvec3& point : field.points) {
    double nearest = 1;
    for (const Light& light : expand(field))
      nearest = std::min(nearest, glm::distance(light.position, point));
    EXPECT_LT(nearest, 1e-3);
  }
}

TEST(LightField, CurvesRadiusMovesLightsOffItAndNotAlong) {
  LightField field;
  field.count = 1000;
  field.shape = FieldShape::kCurve;
  field.points = {{0, 0, 0}, {8, 0, 0}};
  field.radius = 0;
  const std::vector<Light> on = expand(field);
  field.radius = 0.5;
  const std::vector<Light> off = expand(field);
  double farthest = 0;
  for (std::size_t i = 0; i < on.size(); ++i)
    farthest = std::max(farthest, glm::distance(on[i].position, off[i].position));
  // Coordinates up to 8.5 are rounded by 2⁻⁵⁰.
  EXPECT_LE(farthest, 0.5 + 1e-14);
  // All of 1000 within 0.4 of 0.5: (0.8³)^1000.
  EXPECT_GT(farthest, 0.4);
}

TEST(LightField, PointsThatAreAllTheSameAreAPlaceToo) {
  LightField field;
  field.count = 2;
  field.shape = FieldShape::kCurve;
  field.points = {{1, 2, 3}, {1, 2, 3}};
  field.radius = 0;
  EXPECT_EQ(expand(field)[1].position, glm::dvec3(1, 2, 3));
}

TEST(LightField, ListKeepsItsColoursAndRangesUnlessRangesAreGiven) {
  LightField field;
  field.shape = FieldShape::kList;
  field.list.resize(2);
  field.list[0].diffuse = {1, 2, 3};
  field.list[0].range = 5;
  field.count = 2;
  field.intensity = glm::vec2(2);
  std::vector<Light> lights = expand(field);
  EXPECT_EQ(lights[0].diffuse, glm::vec3(2, 4, 6));
  EXPECT_EQ(lights[0].specular, glm::vec3(2, 4, 6));
  EXPECT_EQ(lights[0].range, 5);
  EXPECT_TRUE(std::isinf(lights[1].range));
  field.range = glm::vec2(7);
  EXPECT_EQ(expand(field)[0].range, 7);
  field.list[0].attenuation = {0, 1, 0};
  EXPECT_EQ(expand(field)[0].attenuation, glm::vec3(0, 1, 0));
  field.attenuation = glm::vec3(1, 0, 2);
  EXPECT_EQ(expand(field)[0].attenuation, glm::vec3(1, 0, 2));
  field.list[1].kind = LightKind::kDirectional;
  EXPECT_TRUE(std::isinf(expand(field)[1].range)) << "it has no place to reach from";
}

TEST(LightField, LightsAsListedChangeInNothing) {
  LightField field;
  field.shape = FieldShape::kList;
  field.as_listed = true;
  field.count = 1;
  field.intensity = glm::vec2(2);
  field.list = {{.kind = LightKind::kSpot,
                 .position = {1, 2, 3},
                 .ambient = glm::vec3(0.5f),
                 .diffuse = {1, 2, 3},
                 .specular = {4, 5, 6},
                 .attenuation = {0, 0, 1},
                 .range = 5,
                 .cutoff = 1,
                 .shadow = true}};
  EXPECT_EQ(expand(field), field.list);
}

TEST(LightField, CutoffEndsALightWhereItHasFadedToIt) {
  LightField field;
  field.count = 1;
  field.colors = {{1, 4, 2}};
  field.intensity = glm::vec2(4);
  field.attenuation = {0, 0, 1};
  field.cutoff = 0.25;
  // 16 / d² = 1/4
  EXPECT_EQ(expand(field)[0].range, 8);
  field.colors = {{0, 0, 0}};
  EXPECT_EQ(expand(field)[0].range, 1e-18f);
}

TEST(LightField, ShapesMadeForABoxLieInItOrNearIt) {
  const Bounds box{{-10, 0, 20}, {30, 10, 40}};
  for (const char* name : {"box", "ball", "sphere", "surface", "clusters", "curve"}) {
    const auto shape = fieldShapeNamed(name);
    ASSERT_TRUE(shape) << name;
    LightField field = fieldInBox(*shape, box);
    EXPECT_EQ(field.count, 0u);
    EXPECT_EQ(field.offset, 0.4);
    EXPECT_EQ(field.center, glm::dvec3(10, 5, 30));
    field.count = 1000;
    glm::dvec3 mean{0.0};
    for (const Light& light : expandOn(twoTriangles(), field)) mean += light.position / 1000.0;
    if (*shape == FieldShape::kSurface) continue;  // lies where the triangles are
    for (int i = 0; i < 3; ++i) {
      EXPECT_GT(mean[i], box.low[i]) << name;
      EXPECT_LT(mean[i], box.high[i]) << name;
    }
  }
  EXPECT_FALSE(fieldShapeNamed("list"));
  EXPECT_FALSE(fieldShapeNamed(""));
}

TEST(LightField, TooManyLightsAreRefusedBeforeAnyIsMade) {
  LightField field;
  field.count = kMostLights;
  Scene scene;
  scene.lights.resize(1);
  EXPECT_THROW(expandLightField(field, scene), InputError);
  field.count = ~std::uint64_t{0};
  EXPECT_THROW(expandLightField(field, scene), InputError);
  EXPECT_EQ(scene.lights.size(), 1u);
}

}  // namespace
}  // namespace luciole
