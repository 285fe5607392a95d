// Lights in places, with falloffs and in numbers that break renderers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "kernels/random_scene.hpp"
#include "luciole/error.hpp"
#include "pictures/surfaces_seen.hpp"
#include "render_json.hpp"
#include "single_precision.hpp"
#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

/// A glossy surface that scatters a light's own ambient as well.
SurfaceSeen glossy(const glm::vec3& position, const glm::vec3& normal = {0, 0, 1}) {
  return {.position = position,
          .normal = normal,
          .diffuse = glm::vec3(0.75f),
          .specular = glm::vec3(0.5f),
          .ambient = glm::vec3(0.25f),
          .shininess = 32};
}

/// A wall 4 m ahead that is turned this way and that, seen all over the picture.
std::vector<SurfaceSeen> bumpyWall() {
  std::vector<SurfaceSeen> points;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      points.push_back(glossy({0.5f * x - 1.75f, 0.5f * y - 1.75f, -4},
                              glm::normalize(glm::vec3(0.1f * (x - 4), 0.1f * (y - 3), 1))));
  return points;
}

TEST(HardLights, LightOnASurfaceLightsItsNeighboursAndLeavesItsOwnPlaceDark) {
  Light light = pointLight({0, 0, -4});
  light.ambient = glm::vec3(0.5f);
  light.attenuation = {1, 0, 1};
  std::vector<SurfaceSeen> points = bumpyWall();
  expectRight(sceneWith({light}), points);
  // Where the light is, no direction leads to it: its ambient alone, 0.5 · 0.25, is left, nothing rounded.
  EXPECT_EQ(shadedPoint(sceneWith({light}), glossy({0, 0, -4})), glm::vec3(0.125f));
  EXPECT_EQ(referencePoints(sceneWith({light}), {glossy({0, 0, -4})})[0], glm::vec3(0.125f));
}

TEST(HardLights, LightOnTheCameraIsSeenStraightBack) {
  expectRight(sceneWith({pointLight({0, 0, 0})}), bumpyWall());
  // Facing it: N·L = R·V = 1, so 0.75 + 0.5. N·L and the lobe's chord round 8 times together, the sum 3
  // times.
  const glm::vec3 seen = shadedPoint(sceneWith({pointLight({0, 0, 0})}), glossy({0, 0, -4}));
  EXPECT_NEAR(seen.x, 1.25, 1.25 * 11 * kUnit);
}

TEST(HardLights, LightNearerThanFloatsTellIsAtThePlaceItself) {
  for (const double distance : {1e-20, 1e-12, 1e-9}) {
    // Floats near 4 are 2^-21 apart: all of these round to −4.
    Light light = pointLight({0, 0, -4 + distance});
    light.attenuation = {0, 0, 1};
    light.diffuse = light.specular = glm::vec3(1e-3f);
    expectRight(sceneWith({light}), bumpyWall());
    EXPECT_EQ(shadedPoint(sceneWith({light}), glossy({0, 0, -4})), glm::vec3(0)) << distance;
  }
  // Near to the eye floats have all their digits, and the light is right; below 10⁻¹⁹ m, where a square is no
  // longer normal, it dims, and all stays finite.
  expectRight(sceneWith({pointLight({0, 0, 2e-15})}), {glossy({0, 0, -1e-15f})});
  const glm::vec3 seen = shadedPoint(sceneWith({pointLight({0, 0, 0})}), glossy({0, 0, -1e-20f}));
  for (int c = 0; c < 3; ++c) EXPECT_TRUE(seen[c] >= 0 && seen[c] <= 1.25f) << seen[c];
}

TEST(HardLights, LightsAsFarAsNumbersGoAreLikeTheSun) {
  for (const double distance : {1e6, 1e18, 1e20, 1e30}) {
    // Linear attenuation halves the light, a range fades it to (1 − ½⁴)², wherever it stands.
    Light light = pointLight(distance * glm::normalize(glm::dvec3(2, 3, 6)));
    light.attenuation = {1, float(1 / distance), 0};
    light.range = float(2 * distance);
    expectRight(sceneWith({light}), bumpyWall());
    Light sun;
    sun.kind = LightKind::kDirectional;
    sun.direction = -glm::normalize(light.position);
    sun.diffuse = sun.specular = glm::vec3(float(0.5 * std::pow(1 - 1.0 / 16, 2)));
    // From 10⁶ m, directions and distances differ by 4 · 10⁻⁶ over a wall of 4 m, from farther by nothing;
    // the lobe's exponent 32 has R·V change by 32 times as much at most, twice over: L turns R. Roundings as
    // in shade_bounds.hpp are within 60 + 32 · 24 units.
    const double tolerance = 4e-6 * (2 + 64) * (1e6 / distance) + (60 + 32 * 24) * kUnit;
    const auto near = shadedPoints(16, sceneWith({sun}), bumpyWall());
    const auto far = shadedPoints(16, sceneWith({light}), bumpyWall());
    for (std::size_t i = 0; i < far.size(); ++i) ASSERT_NEAR(far[i].x, near[i].x, tolerance) << distance;
  }
}

TEST(HardLights, WhatSaysNothingIsRefusedInOneLine) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& light, const std::string& place) {
    writeText(folder / "bad.json", R"({"objects": [{"primitive": "box"}], "lights": [{)" + light + "}]}");
    const Outcome outcome = runLine(folder, "luciole render bad.json -o out.png");
    EXPECT_EQ(outcome.status, 2) << light;
    EXPECT_TRUE(isOneLine(outcome.err)) << outcome.err;
    EXPECT_NE(outcome.err.find(place), std::string::npos) << outcome.err;
  };
  const std::string point = R"("type": "point", "position": [0, 2, 0], )";
  const std::string spot = R"("type": "spot", "position": [0, 2, 0], "cutoff": 30, )";
  refused(point + R"("range": 0)", "bad.json: lights[0].range: ");
  refused(point + R"("range": "NaN")", "bad.json: lights[0].range: ");
  refused(point + R"("range": NaN)", "bad.json: ");
  refused(point + R"("range": 1e999)", "bad.json: ");
  refused(point + R"("attenuation": [0, 0, 0])", "bad.json: lights[0].attenuation: ");
  refused(R"("type": "point", "position": [0, 1e20, 0])", "bad.json: lights[0].position[1]: ");
  refused(spot + R"("direction": [0, 0, 0])", "bad.json: lights[0].direction: ");
  refused(spot + R"("target": [0, 2, 0])", "bad.json: lights[0].target: ");
  refused(R"("type": "directional", "direction": [0, 0, 0])", "bad.json: lights[0].direction: ");
}

TEST(HardLights, RangeOf0LightsNothingAndAnInfiniteOneFadesNothing) {
  // A loader lets neither 0 nor NaN through; a scene made by a program may hold them.
  Light light = pointLight({0, 0, -2});
  const glm::vec3 whole = shadedPoint(sceneWith({light}), glossy({0, 0, -4}));
  // Beside a light of some range the program has range windows, and an infinite range must leave 1 exactly.
  Light out_of_reach = pointLight({0, 0, 50});
  out_of_reach.range = 1;
  EXPECT_EQ(shadedPoint(sceneWith({light, out_of_reach}), glossy({0, 0, -4})), whole);
  light.range = 0;
  EXPECT_EQ(shadedPoint(sceneWith({light}), glossy({0, 0, -4})), glm::vec3(0));
  EXPECT_EQ(shadedPoint(sceneWith({light}), glossy({0, 0, -2})), glm::vec3(0)) << "at the light itself";
  EXPECT_EQ(referencePoints(sceneWith({light}), {glossy({0, 0, -4})})[0], glm::vec3(0));
  light.range = kNaN;
  for (const Light& other : {out_of_reach, pointLight({0, 0, 0})}) {
    const glm::vec3 seen = shadedPoint(sceneWith({light, other}), glossy({0, 0, -4}));
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(seen[c]));
  }
}

TEST(HardLights, AttenuationOf0IsCappedAndFinite) {
  Light light = pointLight({0, 0, -2});
  light.attenuation = glm::vec3(0);
  light.specular = glm::vec3(0);
  // 1/0 counts as 2^100, and N·L = 1 times a diffuse colour of 0.75. The division may be off by 2.5 ulp, 5
  // units; the unit vector's and N·L's roundings are 8, the sum's 3.
  const double expected = 0.75 * 0x1p100;
  EXPECT_NEAR(shadedPoint(sceneWith({light}), glossy({0, 0, -4})).x, expected, expected * 16 * kUnit);
  EXPECT_NEAR(referencePoints(sceneWith({light}), {glossy({0, 0, -4})})[0].x, expected, expected * kUnit);
}

/// A spot 2 m above the middle of a wall 4 m ahead, shining straight at it, from a scene file.
Scene spotScene(const std::string& cone) {
  return sceneFromJson(R"({"lights": [{"type": "spot", "position": [0, 0, -2], "direction": [0, 0, -1], )" +
                       cone + "}]}");
}

/// Points of that wall at these angles to the spot's axis, in radians. The wall bends towards the spot beyond
/// 80 degrees, so as to be lit there too.
std::vector<SurfaceSeen> pointsAtAngles(const std::vector<double>& angles) {
  std::vector<SurfaceSeen> points;
  for (const double angle : angles)
    points.push_back(glossy(glm::dvec3(2 * std::sin(angle), 0, -2 - 2 * std::cos(angle)),
                            glm::dvec3(-std::sin(angle), 0, std::cos(angle))));
  return points;
}

TEST(HardLights, SpotOfCutoff0LightsItsAxisAlone) {
  for (const char* exponent : {"0", "128"}) {
    const Scene scene = spotScene(std::string(R"("cutoff": 0, "exponent": )") + exponent);
    // A float's cosine is within 12 · 2^-24 of the exact one and the edge as much below 1: no farther than
    // √(2 · 24 · 2^-24) = 1.7 mrad from the axis may there be light.
    const auto aside = pointsAtAngles({1.7e-3, 0.01, 0.1, 1, 3});
    for (const glm::vec3& seen : shadedPoints(16, scene, aside)) EXPECT_EQ(seen, glm::vec3(0));
    // On the axis N·L = 1 and R·V = 1; 0.75 + 0.5. Twelve units of the cosine make 128 · 12 of the power.
    for (const float distance : {0.3f, 1.0f, 2.0f, 3.0f, 7.0f, 1000.0f})
      EXPECT_NEAR(shadedPoint(scene, glossy({0, 0, -2 - distance})).x, 1.25, 1.25 * (128 * 12 + 12) * kUnit)
          << exponent << " at " << distance;
    const auto truth = referencePoints(scene, pointsAtAngles({0, 1.7e-3}));
    EXPECT_NEAR(truth[0].x, 1.25, 2 * kUnit);
    EXPECT_EQ(truth[1], glm::vec3(0));
  }
}

TEST(HardLights, SpotOfCutoff90LightsAHalfSpace) {
  for (const char* exponent : {"0", "1", "128"}) {
    const Scene scene = spotScene(std::string(R"("cutoff": 90, "exponent": )") + exponent);
    std::vector<double> angles;
    for (int i = 0; i <= 60; ++i) angles.push_back(glm::pi<double>() * i / 60);
    for (const double off : {1e-5, 1e-6, 1e-7, 0.0, -1e-6, -1e-5})
      angles.push_back(glm::half_pi<double>() + off);
    expectRight(scene, pointsAtAngles(angles));
    // Beyond the edge by more than the cosine's 12 units, nothing.
    EXPECT_EQ(shadedPoints(16, scene, pointsAtAngles({glm::half_pi<double>() + 1e-6}))[0], glm::vec3(0));
  }
}

TEST(HardLights, SpotOfCutoff180IsAPointLightWhateverItsExponent) {
  const Scene point = sceneFromJson(R"({"lights": [{"type": "point", "position": [0, 0, -2]}]})");
  const auto points = bumpyWall();
  const auto expected = shadedPoints(16, point, points);
  for (const char* exponent : {"0", "128"})
    EXPECT_EQ(shadedPoints(16, spotScene(std::string(R"("cutoff": 180, "exponent": )") + exponent), points),
              expected);
  expectRight(point, points);
}

TEST(HardLights, ZeroDirectionsAndZeroNormalsLeaveTheAmbient) {
  Light spot = pointLight({0, 0, -2}), sun;
  spot.kind = LightKind::kSpot;
  spot.cutoff = 0.5;
  sun.kind = LightKind::kDirectional;
  spot.direction = sun.direction = glm::dvec3(0);
  sun.ambient = glm::vec3(0.5f);
  SurfaceSeen surface = glossy({0, 0, -4});
  surface.emission = glm::vec3(0.125f);
  // A spot without a direction shines at nobody, a sun without one gives its ambient: 0.5 · 0.25 and the
  // glow.
  EXPECT_EQ(shadedPoint(sceneWith({spot, sun}), surface), glm::vec3(0.25f));
  EXPECT_EQ(referencePoints(sceneWith({spot, sun}), {surface})[0], glm::vec3(0.25f));
  sun.direction = {0, 0, -1};
  surface.normal = glm::vec3(0);
  EXPECT_EQ(shadedPoint(sceneWith({spot, sun}), surface), glm::vec3(0.25f));
  EXPECT_EQ(referencePoints(sceneWith({spot, sun}), {surface})[0], glm::vec3(0.25f));
}

TEST(HardLights, MillionMillionfoldBrighterLightsLeaveDimOnesRight) {
  Light bright = pointLight({1, 2, -1}), dim = pointLight({-2, 1, -2});
  bright.diffuse = bright.specular = {1e12f, 0, 1e12f};
  dim.diffuse = dim.specular = {0, 1, 1};
  dim.range = 5;
  // The bounds are relative to each channel: red has the bright light, green the dim one, blue their sum.
  expectRight(sceneWith({bright, dim}), bumpyWall());
  expectRight(sceneWith({dim, bright}), bumpyWall());
}

/// So many lights at one place: red is their diffuse light, green specular, blue ambient, so that each of the
/// three sums is seen alone. Brightness varies by 2 if asked for.
struct Crowd {
  std::vector<Light> lights;
  double total = 0;  ///< exact sum of their brightness
};

Crowd crowd(int count, bool equal) {
  Crowd crowd;
  Random random(9);
  for (int i = 0; i < count; ++i) {
    const float brightness = equal ? 1.1e-6f : float(random.between(0.7e-6, 1.4e-6));
    Light light = pointLight({1, 2, -1});
    light.diffuse = {brightness, 0, 0};
    light.specular = {0, brightness, 0};
    light.ambient = {0, 0, brightness};
    crowd.lights.push_back(light);
    crowd.total += brightness;
  }
  return crowd;
}

// Added one by one, N equal lights round N times at the size of the sum so far: up to N/2 units, and as all
// round alike, really so: a million of these come out 1.3 % too dark. In blocks of kSumBlock whose sums are
// added without error the growth ends: see finish_sum in kernels/long_sum.clh.
TEST(HardLights, MillionLightsAddUpLikeOneAMillionTimesAsBright) {
  Light one = pointLight({1, 2, -1});
  one.diffuse = {1, 0, 0};
  one.specular = {0, 1, 0};
  one.ambient = {0, 0, 1};
  std::vector<SurfaceSeen> points;
  for (SurfaceSeen seen : bumpyWall()) {
    seen.diffuse = seen.specular = seen.ambient = glm::vec3(1);
    seen.shininess = 2;
    const glm::vec3 color = shadedPoints(16, sceneWith({one}), {seen})[0];
    if (std::min({color.r, color.g, color.b}) > 1e-3f && points.size() < 16) points.push_back(seen);
  }
  ASSERT_EQ(points.size(), 16u) << "each of the three sums is seen at each point";
  const auto single = shadedPoints(16, sceneWith({one}), points);
  for (const bool equal : {true, false}) {
    const Crowd many = crowd(1000000, equal);
    const auto seen = shadedPoints(16, sceneWith(many.lights), points);
    ASSERT_EQ(seen, shadedPoints(16, sceneWith(many.lights), points, {.culling = Culling::kNone}));
    double worst = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(seen[i][c] / (single[i][c] * many.total) - 1));
    // As finish_sum states it.
    EXPECT_LE(worst, (kSumBlock + 4) * kUnit) << (equal ? "equal" : "different");
    RecordProperty(equal ? "equal" : "different", fmt::format("{:.3g}", worst));
  }
}

TEST(HardLights, ListsAsLongAsAllLightsHoldThemAll) {
  // 200,000 lights around the points of the first tile, a row of four lists, which are far from those of the
  // others: each of these lists is longer than all tiles have pixels, the others are empty. Then 50,000
  // lights that reach all.
  std::vector<SurfaceSeen> points;
  for (int i = 0; i < 64; ++i) points.push_back(glossy({0.01f * i + (i < 16 ? -50 : 50), 0, -90}));
  Random random(3);
  std::vector<Light> lights;
  for (int i = 0; i < 200000; ++i) {
    Light light = pointLight({-50 + random.between(-1, 1), random.between(-1, 1), random.between(-89, -87)});
    light.diffuse = light.specular = glm::vec3(1e-3f);
    light.range = 10;
    lights.push_back(light);
  }
  for (const float range : {10.0f, kInfinity}) {
    if (range == kInfinity) lights.resize(50000);
    for (Light& light : lights) light.range = range;
    const Scene scene = sceneWith(lights);
    const GBuffer gbuffer = gbufferOf(points);
    RenderSettings settings;
    Stats stats;
    const Image tiles = shadeGBuffer(deviceWithLanes(16), scene, gbuffer, settings, stats);
    EXPECT_EQ(countOf(stats, "list_entries"), lights.size() * (range == kInfinity ? 4 : 1));
    settings.shade.culling = Culling::kNone;
    ASSERT_EQ(tiles.pixels, shadeGBuffer(deviceWithLanes(16), scene, gbuffer, settings, stats).pixels);
    const std::vector<glm::ivec2> some{{0, 0}, {15, 0}, {16, 0}, {63, 0}};
    const auto truth = referencePixels(scene, gbuffer, some, {});
    for (std::size_t i = 0; i < some.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const Interval bounds = shadeInterval(scene, gbuffer, gbuffer.index(some[i].x, 0), c, Model::kPhong);
        const float seen = tiles.pixels[3 * some[i].x + c];
        EXPECT_TRUE(seen >= bounds.low && seen <= bounds.high)
            << seen << " outside " << bounds.low << " … " << bounds.high;
        EXPECT_TRUE(truth[i][c] >= bounds.low && truth[i][c] <= bounds.high) << truth[i][c];
      }
    }
  }
}

TEST(HardLights, LightsOutsideBehindAndAroundTheCameraLightWhatTheyReach) {
  Random random(11);
  std::vector<Light> lights;
  for (int i = 0; i < 2000; ++i) {
    Light light = pointLight(40 * random.between(0, 1) * random.direction());
    light.range = float(random.between(1, 45));
    light.diffuse = light.specular = random.color();
    lights.push_back(light);
  }
  std::vector<SurfaceSeen> points;
  for (int i = 0; i < 256; ++i) {
    const double depth = random.between(0.2, 20);
    points.push_back(glossy({depth * random.between(-1, 1), depth * random.between(-1, 1), -depth},
                            glm::vec3(random.direction())));
  }
  expectRight(sceneWith(lights), points);
}

}  // namespace
}  // namespace luciole::test
