#include "reference/ray_shadows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "reference/reference_picture.hpp"
#include "render_json.hpp"

namespace luciole::test {
namespace {

/// A plane of 20 m at y = 0 and a wall across it, from y = 1 to 2 at x = 0, endless to both sides in z.
constexpr const char* kWall = R"({
  "camera": {"eye": [4, 3, 0], "target": [0, 0, 0]},
  "materials": {"white": {"double_sided": true}},
  "objects": [{"primitive": "plane", "scale": 20, "material": "white"},
              {"primitive": "box", "scale": [1e-3, 1, 1000], "translate": [0, 1.5, 0], "material": "white"}],
  "lights": []})";

const glm::dvec3 kEye(4, 3, 0);

Light pointLight(const glm::dvec3& position) {
  Light light;
  light.position = position;
  light.shadow = true;
  return light;
}

Light sun(const glm::dvec3& direction) {
  Light light;
  light.kind = LightKind::kDirectional;
  light.direction = glm::normalize(direction);
  light.shadow = true;
  return light;
}

TEST(RayShadows, SharpShadowEndsWhereTheEdgeSaysSo) {
  const Scene scene = sceneFromJson(kWall);
  const RayScene rays = buildShadowRays(scene, kEye);
  // From (-3, 4) over the wall's foot at (0, 1) and its top at (0, 2): the floor at x = 1 and at x = 3. The
  // wall is 1 mm thick, which moves its shadow by less than 2 mm.
  const Light light = pointLight({-3, 4, 0});
  const auto visible = [&](double x) { return lightVisibility(rays, light, {x, 0, 0.3}, 1, 0); };
  for (const double x : {-5.0, 0.5, 0.99, 3.01, 4.0}) EXPECT_EQ(visible(x), 1) << x;
  for (const double x : {1.01, 2.0, 2.99}) EXPECT_EQ(visible(x), 0) << x;
}

TEST(RayShadows, NothingBehindTheLightMatters) {
  const Scene scene = sceneFromJson(kWall);
  const RayScene rays = buildShadowRays(scene, kEye);
  EXPECT_EQ(lightVisibility(rays, pointLight({1, 1.5, 0}), {2, 0, 0}, 1, 0), 1);
  EXPECT_EQ(lightVisibility(rays, pointLight({-1, 1.5, 0}), {1, 1.5, 0}, 1, 0), 0);
}

/// What of a disc of radius 1 lies beyond a straight line at `distance` from its middle.
double discShare(double distance) {
  const double d = std::clamp(distance, -1.0, 1.0);
  return (std::acos(d) - d * std::sqrt(1 - d * d)) / std::numbers::pi;
}

/// A floor at y = 0, and 1 m above it a sheet that ends in a straight edge at x = 0.
constexpr const char* kSheet = R"({
  "camera": {"eye": [4, 3, 0], "target": [0, 0, 0]},
  "materials": {"white": {"double_sided": true}},
  "objects": [{"primitive": "plane", "scale": 100},
              {"primitive": "plane", "scale": 100, "translate": [-50, 1, 0], "material": "white"}],
  "lights": []})";

// A straight line cuts at most 2 · 2 / √(π/N) of the N cells of equal area that a disc is shared out to, and
// half of each is counted wrong at most.
constexpr int kSamples = 4096;
const double kCutCells = 2 / std::sqrt(std::numbers::pi * kSamples);

TEST(RayShadows, SunsPenumbraOfAStraightEdgeIsTheShareOfADisc) {
  const Scene scene = sceneFromJson(kSheet);
  const RayScene rays = buildShadowRays(scene, kEye);
  Light light = sun({0, -1, 0});
  light.half_angle = 0.02;
  // From the floor at x the edge is seen atan x beside the zenith. The cone's cap is flat within 0.02².
  for (const double x : {-0.03, -0.015, -0.005, 0.0, 0.005, 0.015, 0.03})
    EXPECT_NEAR(lightVisibility(rays, light, {x, 0, 0}, kSamples, 0), discShare(-x / 0.02), kCutCells + 4e-4)
        << x;
}

TEST(RayShadows, SpheresPenumbraOfAStraightEdgeIsTheShareOfADisc) {
  const Scene scene = sceneFromJson(kSheet);
  const RayScene rays = buildShadowRays(scene, kEye);
  Light light = pointLight({0, 5, 0});
  light.radius = 0.1;
  // From the floor at x the edge's plane passes the light's middle by 5 · sin(atan x) − x · cos(atan x).
  for (const double x : {-0.04, -0.02, -0.01, 0.0, 0.01, 0.02, 0.04}) {
    const double beside = (5 * x - x) / std::sqrt(1 + x * x);
    EXPECT_NEAR(lightVisibility(rays, light, {x, 0, 0}, kSamples, 0), discShare(-beside / 0.1),
                kCutCells + 4e-4)
        << x;
  }
}

TEST(RayShadows, InsideALightItIsSeenWhole) {
  const Scene scene = sceneFromJson(kSheet);
  const RayScene rays = buildShadowRays(scene, kEye);
  Light light = pointLight({0, 1.5, 0});
  light.radius = 2;
  EXPECT_EQ(lightVisibility(rays, light, {-1, 0, 0}, 16, 0), 1);
}

TEST(RayShadows, EqualSeedsAskTheSameRays) {
  const Scene scene = sceneFromJson(kSheet);
  const RayScene rays = buildShadowRays(scene, kEye);
  Light light = pointLight({0, 5, 0});
  light.radius = 0.1;
  const auto visible = [&](std::uint32_t seed) {
    return lightVisibility(rays, light, {0.01, 0, 0}, 64, seed);
  };
  EXPECT_EQ(visible(7), visible(7));
  bool varies = false;
  for (std::uint32_t i = 1; i < 64; ++i) varies |= visible(i << 26) != visible(0);
  EXPECT_TRUE(varies);
}

/// Points whose coordinates are rounded to floats, as a G-buffer has them, on a tilted sheet that nothing
/// shades.
TEST(RayShadows, RoundedPointsDoNotShadeThemselves) {
  for (const double angle : {0.0, 45.0, 80.0, 89.0}) {
    const Scene scene = sceneFromJson(
        R"({"camera": {"eye": [0, 0, 10], "target": [0, 0, 0]},
            "objects": [{"primitive": "plane", "scale": 40, "rotate": [)" +
        std::to_string(angle) + R"(, 30, 10]}], "lights": []})");
    const RayScene rays = buildShadowRays(scene, {0, 0, 10});
    const glm::dmat3 turn(scene.objects[0].object_to_world);
    const glm::dvec3 normal = glm::normalize(turn[1]);
    // 1° above the sheet, and straight above it.
    const glm::dvec3 low = glm::normalize(glm::normalize(turn[0]) + 0.0175 * normal);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> spread(-0.45, 0.45);
    for (int i = 0; i < 2000; ++i) {
      const glm::dvec3 world = turn * glm::dvec3(spread(random), 0, spread(random));
      const glm::dvec3 point = glm::dvec3(glm::vec3(world - glm::dvec3(0, 0, 10))) + glm::dvec3(0, 0, 10);
      ASSERT_EQ(lightVisibility(rays, sun(-low), point, 1, 0), 1) << angle;
      ASSERT_EQ(lightVisibility(rays, sun(-normal), point, 1, 0), 1) << angle;
    }
  }
}

TEST(RayShadows, HolesLetLightThrough) {
  std::string json = kSheet;
  json.insert(json.find(R"("double_sided")"), R"("alpha": 0.3, "alpha_cutoff": 0.5, )");
  const Scene holes_scene = sceneFromJson(json);
  const RayScene holes = buildShadowRays(holes_scene, kEye);
  EXPECT_EQ(lightVisibility(holes, sun({0, -1, 0}), {-1, 0, 0}, 1, 0), 1);
  const Scene solid_scene = sceneFromJson(kSheet);
  const RayScene solid = buildShadowRays(solid_scene, kEye);
  EXPECT_EQ(lightVisibility(solid, sun({0, -1, 0}), {-1, 0, 0}, 1, 0), 0);
}

TEST(ReferencePicture, ShadowTakesALightsReflectionAndLeavesItsAmbient) {
  std::string json = kSheet;
  json.replace(json.find(R"("lights": [])"), 12,
               R"("ambient": [0.5, 0.5, 0.5], "lights": [{"type": "directional", "direction": [0, -1, 0],
                  "ambient": [0.25, 0.25, 0.25], "diffuse": [1, 1, 1], "shadow": true}])");
  const Scene scene = sceneFromJson(json);
  // Looks straight down from under the sheet's edge: half of the floor is in shadow.
  Camera camera = scene.cameras.front();
  camera.camera_to_world = glm::dmat4({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0.5, 0, 1});
  const View view = cameraView(camera, {9, 5});
  const auto pixels = allPixels({9, 5});
  const RayScene rays = buildShadowRays(scene, {0, 0.5, 0});
  const auto colors = referencePicture(scene, view, Shading::kPhong, 1, pixels, {.shadow_rays = &rays});
  const auto unshadowed = referencePicture(scene, view, Shading::kPhong, 1, pixels, {});
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    // The floats of 0.8 are all that rounds.
    EXPECT_NEAR(unshadowed[i].x, 0.8 * 1.75, 1e-7);
    if (pixels[i].x != 4) {
      EXPECT_NEAR(colors[i].x, pixels[i].x < 4 ? 0.8 * 0.75 : 0.8 * 1.75, 1e-7) << pixels[i].x;
    }
  }
}

TEST(ReferencePicture, SomePixelsAreThoseOfTheWhole) {
  const Scene scene = loadScene(LUCIOLE_SOURCE_DIR "/scenes/cornell.json");
  const View view = cameraView(scene.cameras.front(), {48, 27});
  const RayScene rays = buildShadowRays(scene, glm::dvec3(scene.cameras.front().camera_to_world[3]));
  const ReferenceSettings settings{.shadow_rays = &rays, .shadow_samples = 4};
  const auto whole = referencePicture(scene, view, Shading::kPhong, 2, allPixels({48, 27}), settings);
  const std::vector<glm::ivec2> some{{3, 2}, {20, 20}, {47, 26}};
  const auto few = referencePicture(scene, view, Shading::kPhong, 2, some, settings);
  for (std::size_t i = 0; i < some.size(); ++i) EXPECT_EQ(few[i], whole[some[i].y * 48 + some[i].x]);
  // And of a crop.
  const View crop = cameraView(scene.cameras.front(), {48, 27}, Crop{17, 13, 11, 9});
  const std::vector<glm::ivec2> in_crop{{3, 7}};
  EXPECT_EQ(referencePicture(scene, crop, Shading::kPhong, 2, in_crop, settings)[0], whole[20 * 48 + 20]);
}

}  // namespace
}  // namespace luciole::test
