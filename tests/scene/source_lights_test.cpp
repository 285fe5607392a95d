// Shining faces and glowing meshes as lights: what they give together is what the surface gives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "luciole/error.hpp"
#include "luciole/pose.hpp"
#include "luciole/primitives.hpp"
#include "luciole/scene.hpp"
#include "reference/reference.hpp"

namespace luciole {
namespace {

/// What a white surface reflects of the scene's lights, without shadows.
double litAt(const Scene& scene, const glm::dvec3& place, const glm::dvec3& normal) {
  SurfacePoint point;
  point.position = place;
  point.normal = normal;
  point.diffuse = glm::dvec3(1);
  return referenceRadiance(scene, {}, point, Model::kPhong).g;
}

/// J. Lambert, Photometria, 1760: the irradiance of a polygon of radiance 1, all of it above the surface, is
/// half the sum over its edges of the angle that an edge seems long, times the cosine between the surface's
/// normal and that of the plane through it and the edge.
double polygonIrradiance(const std::vector<glm::dvec3>& corners, const glm::dvec3& place,
                         const glm::dvec3& normal) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - place),
                     b = glm::normalize(corners[(i + 1) % corners.size()] - place);
    const glm::dvec3 across = glm::cross(a, b);
    sum += std::atan2(glm::length(across), glm::dot(a, b)) * glm::dot(glm::normalize(across), normal);
  }
  return std::abs(sum) / 2;
}

LightSource panel(std::uint32_t count) {
  LightSource source;
  source.kind = SourceKind::kRectangle;
  source.count = count;
  source.position = {0.3, 2, -0.2};
  source.direction = {0, -1, 0};
  source.up = {0, 0, 1};
  source.width = 1.5;
  source.height = 0.6;
  source.radiance = glm::vec3(2);
  return source;
}

Scene sceneOf(const LightSource& source) {
  Scene scene;
  scene.sources = {source};
  addSourceLights(scene);
  return scene;
}

std::vector<glm::dvec3> cornersOf(const LightSource& source) {
  const glm::dvec3 x(source.width / 2, 0, 0), z(0, 0, source.height / 2);
  return {source.position - x - z, source.position + x - z, source.position + x + z, source.position - x + z};
}

TEST(Faces, RectanglesIrradianceIsLamberts) {
  const glm::dvec3 tilted = glm::normalize(glm::dvec3(0.3, 1, 0.2));
  std::array<double, 4> errors{};
  const std::array<std::uint32_t, 4> counts{16, 64, 256, 1024};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const Scene scene = sceneOf(panel(counts[i]));
    ASSERT_EQ(scene.lights.size(), counts[i]);
    for (const glm::dvec3& place : {glm::dvec3(0, 0, 0), {1, 0.5, 0.4}, {-0.8, 1, 0.3}}) {
      const double truth = 2 * polygonIrradiance(cornersOf(panel(1)), place, tilted) / glm::pi<double>();
      errors[i] = std::max(errors[i], std::abs(litAt(scene, place, tilted) / truth - 1));
    }
    RecordProperty(std::to_string(counts[i]), std::to_string(errors[i]));
  }
  // The midpoint rule's error falls as the square of a cell's side, so as 1/count: 4 for each step, within a
  // tenth where rows of cells aren't quite square.
  for (std::size_t i = 1; i < counts.size(); ++i) EXPECT_NEAR(errors[i - 1] / errors[i], 4, 0.6);
  EXPECT_LT(errors.back(), 2e-4);
}

TEST(Faces, DiscsIrradianceOnItsAxisIsTheClosedForm) {
  LightSource disc = panel(4000);
  disc.kind = SourceKind::kDisc;
  disc.width = disc.height = 1;
  // π L r² / (r² + h²), over π; the spiral's points are spread to within 1/count of the area.
  const double truth = 2 * 0.25 / (0.25 + 4);
  EXPECT_NEAR(litAt(sceneOf(disc), disc.position - glm::dvec3(0, 2, 0), {0, 1, 0}), truth, truth / 4000);
}

TEST(Faces, GiveNoLightBehindThem) {
  const Scene scene = sceneOf(panel(64));
  EXPECT_EQ(litAt(scene, {0.3, 3, -0.2}, {0, -1, 0}), 0);
  EXPECT_GT(litAt(scene, {0.3, 1, -0.2}, {0, 1, 0}), 0.1);
}

TEST(Faces, HaveAsManyPointsAsAskedForOfTheSameArea) {
  for (const std::uint32_t count : {1u, 2u, 3u, 7u, 50u, 97u})
    for (const double width : {0.001, 1.0, 500.0}) {
      LightSource source = panel(count);
      source.width = width;
      const Scene scene = sceneOf(source);
      ASSERT_EQ(scene.lights.size(), count);
      glm::dvec3 middle(0.0);
      for (const Light& light : scene.lights) middle += light.position / double(count);
      EXPECT_NEAR(middle.x, source.position.x, 1e-12 * (1 + width));
      EXPECT_NEAR(middle.z, source.position.z, 1e-12);
    }
}

TEST(Faces, ThatAreOutOfRangeAreRefused) {
  const auto fault = [](const auto& change) -> std::string {
    Scene scene;
    scene.sources = {panel(4)};
    change(scene.sources[0]);
    try {
      addSourceLights(scene);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(fault([](LightSource& s) { s.count = 10'000'000; }),
              testing::HasSubstr("sources[0].count: 10000000, expected 1048576 at most"));
  EXPECT_THAT(fault([](LightSource& s) { s.width = 0; }), testing::HasSubstr("width"));
  EXPECT_THAT(fault([](LightSource& s) { s.up = s.direction; }), testing::HasSubstr("parallel"));
  EXPECT_THAT(fault([](LightSource& s) { s.radiance.r = -1; }), testing::HasSubstr("radiance"));
  EXPECT_THAT(fault([](LightSource& s) { s.kind = SourceKind::kEnvironment; }),
              testing::HasSubstr("sky: is missing"));
}

/// A plane of 2 × 2 m that glows downwards, 2 m above the ground.
Scene glowingPlane(std::uint32_t count) {
  Scene scene;
  Material lamp;
  lamp.emission = glm::vec3(3);
  scene.materials = {lamp};
  scene.meshes = {makePrimitive({PrimitiveKind::kPlane}, 0)};
  Object object{0, glm::rotate(glm::translate(glm::dmat4(1), {0, 2, 0}), glm::pi<double>(), {1, 0, 0})};
  object.emits = count;
  object.name = "lamp";
  scene.objects = {object};
  addSourceLights(scene);
  return scene;
}

TEST(GlowingMeshes, GiveWhatARectangleGives) {
  const Scene scene = glowingPlane(1024);
  EXPECT_NEAR(double(scene.lights.size()), 1024, 8);
  double low = 10, high = -10;
  for (const Light& light : scene.lights) {
    EXPECT_NEAR(light.direction.y, -1, 1e-12);
    low = std::min(low, light.position.x);
    high = std::max(high, light.position.x);
  }
  const double half = high - low > 3 ? 5 : 1;  // of the primitive, whatever its size
  const double side = std::round(high - low);
  const std::vector<glm::dvec3> corners{
      {-side / 2, 2, -side / 2}, {side / 2, 2, -side / 2}, {side / 2, 2, side / 2}, {-side / 2, 2, side / 2}};
  const double truth = 3 * polygonIrradiance(corners, {0.2, 0, 0.1}, {0, 1, 0}) / glm::pi<double>();
  // Lights lie within a piece, a sixteenth of their part, of its middle: as good as the midpoint rule to the
  // first order, and 1/√count of a part's side beside. And the lift of a thousandth of a part.
  EXPECT_NEAR(litAt(scene, {0.2, 0, 0.1}, {0, 1, 0}), truth, 2e-3 * truth) << half;
}

TEST(GlowingMeshes, ShineFromTheirFrontAloneUnlessTheyAreDoubleSided) {
  Scene scene = glowingPlane(64);
  EXPECT_EQ(litAt(scene, {0, 3, 0}, {0, -1, 0}), 0);
  scene.materials[0].double_sided = true;
  addSourceLights(scene);
  EXPECT_NEAR(double(scene.lights.size()), 128, 8);
  EXPECT_NEAR(litAt(scene, {0, 3, 0}, {0, -1, 0}), litAt(scene, {0, 1, 0}, {0, 1, 0}), 1e-3);
}

TEST(GlowingMeshes, HaveTheirLightWhereTheirTextureHasIt) {
  Scene scene = glowingPlane(256);
  // Only the left half of the picture glows, and its top row twice as much.
  std::vector<std::uint16_t> texels;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x)
      for (int c = 0; c < 4; ++c) texels.push_back(c == 3 ? 65535 : x > 0 ? 0 : y == 0 ? 65534 : 32767);
  scene.textures = {makeTexture(2, 2, texels, TextureKind::kColor, true)};
  scene.materials[0].emission_map.texture = 0;
  addSourceLights(scene);
  double upper = 0, all = 0, wrong = 0;
  for (const Light& light : scene.lights) {
    all += light.diffuse.g;
    (light.position.x > 0.02 ? wrong : upper) += light.position.z > 0 ? light.diffuse.g : 0;
  }
  EXPECT_NEAR(wrong / all, 0, 0.01);
  EXPECT_NEAR(std::max(upper, all - upper) / all, 2.0 / 3, 0.02);
}

TEST(GlowingMeshes, WithoutAnAreaGiveAWarningAndNoLight) {
  Scene scene = glowingPlane(16);
  for (glm::vec3& position : scene.meshes[0].positions) position.x = 0;
  addSourceLights(scene);
  addSourceLights(scene);
  EXPECT_TRUE(scene.lights.empty());
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_THAT(scene.warnings[0].text, testing::HasSubstr("object 'lamp' emits, but no area of it glows"));
}

TEST(SourceLights, TakeThePlaceOfThoseBefore) {
  Scene scene = sceneOf(panel(8));
  scene.lights.insert(scene.lights.begin(), Light());
  scene.sources.push_back(panel(5));
  addSourceLights(scene);
  EXPECT_EQ(scene.lights.size(), 1u + 13u);
  EXPECT_EQ(scene.source_lights, 13u);
  setLightCounts(scene, 3);
  EXPECT_EQ(scene.lights.size(), 1u + 6u);
  const std::vector<Light> lights = scene.lights;
  addSourceLights(scene);
  EXPECT_EQ(scene.lights, lights);
}

TEST(SourceLights, MoveWithTheirSourceAndKeepTheirShadows) {
  Scene scene = sceneOf(panel(4));
  LightMotion motion;
  motion.position = {Interpolation::kLinear, {{1, {0, 1, 0, 0}}, {11, {10, 1, 0, 0}}}};
  scene.animation.sources = {motion};
  for (Light& light : scene.lights) light.shadow = true;
  poseScene(scene, 6);
  ASSERT_EQ(scene.lights.size(), 4u);
  double x = 0;
  for (const Light& light : scene.lights) {
    x += light.position.x / 4;
    EXPECT_TRUE(light.shadow);
  }
  EXPECT_NEAR(x, 5, 1e-12);
}

}  // namespace
}  // namespace luciole
