#include "reference/reference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace luciole {
namespace {

// A closed form and the reference are each at most 40 operations of double, each within 2^-53 relative, on
// values of order 1 without cancellation: 80 · 2^-53 < 1e-14.
constexpr double kRounding = 1e-14;

void expectColor(const glm::dvec3& color, const glm::dvec3& expected, double tolerance = kRounding) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], expected[c], tolerance) << "channel " << c;
}

/// A point of the plane y = 0, facing up, white.
SurfacePoint floorPoint(double x, double z = 0) {
  SurfacePoint point;
  point.position = {x, 0, z};
  point.normal = {0, 1, 0};
  point.diffuse = glm::dvec3(1);
  return point;
}

Camera cameraAt(const glm::dvec3& eye, const glm::dvec3& target) {
  Camera camera;
  camera.camera_to_world = glm::inverse(glm::lookAt(eye, target, glm::dvec3(0, 1, 0)));
  return camera;
}

Light pointLight(const glm::dvec3& position) {
  Light light;
  light.position = position;
  return light;
}

glm::dvec3 radiance(const Light& light, const SurfacePoint& point, Model model = Model::kPhong) {
  Scene scene;
  scene.lights = {light};
  return referenceRadiance(scene, cameraAt({3, 4, 0}, {0, 0, 0}), point, model);
}

TEST(Reference, PlaneUnderAPointLight) {
  Light light = pointLight({0, 3, 0});
  light.diffuse = {1, 0.5f, 0.25f};
  expectColor(radiance(light, floorPoint(0)), {1, 0.5, 0.25});
  // 4 to the side: distance 5, cosine 3/5.
  expectColor(radiance(light, floorPoint(4)), {0.6, 0.3, 0.15});
  light.attenuation = {1, 2, 3};
  expectColor(radiance(light, floorPoint(4)), glm::dvec3(0.6, 0.3, 0.15) / (1.0 + 2 * 5 + 3 * 25));
}

TEST(Reference, DirectionalLightAt60DegreesIsHalf) {
  Light light;
  light.kind = LightKind::kDirectional;
  const double angle = glm::radians(60.0);
  light.direction = {std::sin(angle), -std::cos(angle), 0};
  light.attenuation = {7, 7, 7};  // means nothing to a directional light
  light.range = 1e-3f;            // nor does this
  expectColor(radiance(light, floorPoint(1000)), glm::dvec3(0.5));
}

TEST(Reference, RangeWindows) {
  Light light = pointLight({0, 2, 0});
  light.range = 4;
  expectColor(radiance(light, floorPoint(0)), glm::dvec3(0.9375 * 0.9375));
  light.window = RangeWindow::kKhr;
  expectColor(radiance(light, floorPoint(0)), glm::dvec3(0.9375));
  for (const float range : {2.0f, 1.0f}) {
    light.range = range;
    EXPECT_EQ(radiance(light, floorPoint(0)), glm::dvec3(0)) << range;
  }
}

TEST(Reference, SpotEndsSharplyAtItsCutoff) {
  Light light = pointLight({0, 1, 0});
  light.kind = LightKind::kSpot;
  light.direction = {0, -1, 0};
  light.cutoff = glm::radians(30.0);
  const double edge = std::tan(light.cutoff);
  EXPECT_EQ(radiance(light, floorPoint(edge * (1 + 1e-9))), glm::dvec3(0));
  // d cos/dx is below 1 here, so 1e-9 to the side changes the cosine by less than 1e-9.
  expectColor(radiance(light, floorPoint(edge * (1 - 1e-9))), glm::dvec3(std::cos(light.cutoff)), 1e-9);
}

TEST(Reference, SpotExponentIsACosinePower) {
  Light light = pointLight({0, 3, 0});
  light.kind = LightKind::kSpot;
  light.direction = {0, -1, 0};
  light.cutoff = glm::radians(60.0);
  light.exponent = 2;
  expectColor(radiance(light, floorPoint(4)), glm::dvec3(0.6 * 0.36));
  light.exponent = 0;
  expectColor(radiance(light, floorPoint(4)), glm::dvec3(0.6));
}

TEST(Reference, ConeIsTheSquareOfALinearRamp) {
  Light light = pointLight({0, 3, 0});
  light.kind = LightKind::kSpot;
  light.falloff = SpotFalloff::kCone;
  light.direction = {0, -1, 0};
  light.inner_cone = std::acos(0.8);
  light.cutoff = std::acos(0.4);
  // cos 0.6 lies half-way; the ramp divides differences of cosines, which loses a factor of 1/0.4 at most.
  expectColor(radiance(light, floorPoint(4)), glm::dvec3(0.6 * 0.25), 3 * kRounding);
  expectColor(radiance(light, floorPoint(0.5)), glm::dvec3(3 / std::sqrt(9.25)));
  EXPECT_EQ(radiance(light, floorPoint(8)), glm::dvec3(0));
}

TEST(Reference, MirrorDirectionShowsTheWholeHighlight) {
  SurfacePoint point = floorPoint(0);
  point.diffuse = glm::dvec3(0);
  point.specular = {0.5, 0.25, 1};
  Light light = pointLight({-6, 8, 0});  // the eye's direction (3, 4, 0), mirrored
  light.specular = {1, 2, 0.5f};
  for (const double shininess : {0.0, 1.0, 32.0, 1e4}) {
    point.shininess = shininess;
    for (const Model model : {Model::kPhong, Model::kBlinnPhong})
      // A cosine within 4 · 2^-53 of 1 to the power n is within 4n · 2^-53 of 1.
      expectColor(radiance(light, point, model), {0.5, 0.5, 0.5}, kRounding * (1 + shininess));
  }
}

TEST(Reference, LobesAwayFromTheMirrorDirection) {
  SurfacePoint point = floorPoint(0);
  point.diffuse = glm::dvec3(0);
  point.specular = glm::dvec3(1);
  point.shininess = 8;
  // From straight above the mirror direction is the normal: R·V = 4/5; the half angle has cos² = (1 + 4/5)/2.
  const Light light = pointLight({0, 2, 0});
  expectColor(radiance(light, point), glm::dvec3(std::pow(0.8, 8)));
  expectColor(radiance(light, point, Model::kBlinnPhong), glm::dvec3(std::pow(0.9, 4)));
}

TEST(Reference, NoHighlightOnTheFarSide) {
  SurfacePoint point = floorPoint(0);
  point.specular = glm::dvec3(1);
  point.shininess = 0;  // whose lobe is 1 everywhere
  EXPECT_EQ(radiance(pointLight({0, -1, 0}), point), glm::dvec3(0));
  EXPECT_EQ(radiance(pointLight({5, 0, 0}), point), glm::dvec3(0)) << "N·L = 0 is unlit";
  // R·V < 0: 0^0 = 1, but 0^1 = 0.
  point.diffuse = glm::dvec3(0);
  expectColor(radiance(pointLight({100, 1, 0}), point), glm::dvec3(1));
  point.shininess = 1;
  EXPECT_EQ(radiance(pointLight({100, 1, 0}), point), glm::dvec3(0));
}

TEST(Reference, AmbientLightFallsOffButNeedsNoFacing) {
  SurfacePoint point = floorPoint(4);
  point.ambient = {1, 0.5, 0.25};
  Light light = pointLight({0, -3, 0});
  light.ambient = glm::vec3(2);
  light.attenuation = {0, 1, 0};
  expectColor(radiance(light, point), glm::dvec3(1, 0.5, 0.25) * (2.0 / 5));
  light.kind = LightKind::kSpot;
  light.direction = {0, 1, 0};
  light.cutoff = glm::radians(80.0);
  light.exponent = 1;
  expectColor(radiance(light, point), glm::dvec3(1, 0.5, 0.25) * (2.0 / 5 * 0.6));
}

TEST(Reference, GlobalAmbientAndEmissionNeedNoLight) {
  SurfacePoint point = floorPoint(0);
  point.ambient = {1, 0.5, 0.25};
  point.emission = {0.25, 0.5, 4};
  Scene scene;
  scene.ambient = {0.5f, 0.5f, 2};
  expectColor(referenceRadiance(scene, cameraAt({0, 1, 1}, {0, 0, 0}), point, Model::kPhong),
              {0.75, 0.75, 4.5});
}

TEST(Reference, WithoutLightingTheDiffuseColourShows) {
  SurfacePoint point = floorPoint(0);
  point.ambient = glm::dvec3(9);
  point.diffuse = {0.5, 0.25, 0.125};
  point.emission = {1, 0, 0};
  Scene scene;
  scene.lighting = false;
  scene.ambient = glm::vec3(1);
  scene.lights = {pointLight({0, 1, 0})};
  expectColor(referenceRadiance(scene, cameraAt({0, 1, 1}, {0, 0, 0}), point, Model::kPhong),
              {1.5, 0.25, 0.125});
}

TEST(Reference, LightsAddUp) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> spread(-4, 4);
  Scene a, b;
  for (int i = 0; i < 20; ++i) {
    Light light = pointLight({spread(random), 1 + std::abs(spread(random)), spread(random)});
    light.ambient = glm::vec3(0.125f);
    light.range = i % 3 ? 9.0f : std::numeric_limits<float>::infinity();
    (i < 10 ? a : b).lights.push_back(light);
  }
  Scene both = a;
  both.lights.insert(both.lights.end(), b.lights.begin(), b.lights.end());
  SurfacePoint point = floorPoint(0.3, -0.2);
  point.ambient = point.specular = glm::dvec3(0.5);
  point.shininess = 20;
  const Camera camera = cameraAt({1, 2, 3}, {0, 0, 0});
  // Sums of 20 terms below 2 in two orders: 2 · 20 · 40 · 2^-53.
  expectColor(
      referenceRadiance(both, camera, point, Model::kPhong),
      referenceRadiance(a, camera, point, Model::kPhong) + referenceRadiance(b, camera, point, Model::kPhong),
      1e-12);
}

TEST(Reference, EachFogAtAKnownDistance) {
  // 3 ahead and 4 to the side: depth 3, distance 5.
  const Camera camera = cameraAt({0, 0, 0}, {0, 0, -1});
  const glm::dvec3 place(4, 0, -3), surface(1, 0.5, 0);
  Fog fog;
  fog.color = {0, 1, 0.5f};
  const auto expectShares = [&](const glm::dvec3& share) {
    expectColor(referenceFog(fog, camera, place, surface),
                share * surface + (1.0 - share) * glm::dvec3(fog.color));
  };
  expectShares(glm::dvec3(1));
  fog.mode = FogMode::kLinear;
  fog.start = 1;
  fog.end = 9;
  expectShares(glm::dvec3(0.75));
  fog.radial = true;
  expectShares(glm::dvec3(0.5));
  fog.end = 4;
  expectShares(glm::dvec3(0));
  fog.start = 6;
  fog.end = 7;
  expectShares(glm::dvec3(1));
  fog.density = {0.5f, 0.25f, 0};
  fog.mode = FogMode::kExp;
  expectShares({std::exp(-2.5), std::exp(-1.25), 1});
  fog.radial = false;
  expectShares({std::exp(-1.5), std::exp(-0.75), 1});
  fog.mode = FogMode::kExp2;
  expectShares({std::exp(-2.25), std::exp(-0.5625), 1});
}

/// One tile with a single pixel that shows something, at (5, 3).
GBuffer onePixel(const Camera& camera, const glm::dvec3& world_position, const glm::dvec3& world_normal) {
  GBuffer gbuffer;
  gbuffer.width = 7;
  gbuffer.height = 4;
  gbuffer.picture_size = {7, 4};
  gbuffer.tiles_x = gbuffer.tiles_y = 1;
  gbuffer.camera = camera;
  const std::size_t n = gbuffer.pixels(), place = gbuffer.index(5, 3);
  gbuffer.position.assign(3 * n, 0.0f);
  std::fill_n(gbuffer.position.begin() + 2 * n, n, -std::numeric_limits<float>::infinity());
  gbuffer.normal.assign(3 * n, 0.0f);
  gbuffer.diffuse.assign(3 * n, 0.0f);
  gbuffer.specular.assign(4 * n, 0.0f);
  const glm::dmat4 to_view = glm::inverse(camera.camera_to_world);
  const glm::dvec3 position(to_view * glm::dvec4(world_position, 1)),
      normal = glm::dmat3(to_view) * world_normal;
  for (int c = 0; c < 3; ++c) {
    gbuffer.position[place + c * n] = float(position[c]);
    gbuffer.normal[place + c * n] = float(normal[c]);
    gbuffer.specular[place + c * n] = 1.0f;
  }
  gbuffer.specular[place + 3 * n] = 2.0f;
  return gbuffer;
}

TEST(Reference, GBufferIsShadedInTheWorldOfItsCamera) {
  // Far from the origin, turned, parallel: the way to the eye is the camera's backward axis, whatever the
  // place.
  const glm::dvec3 far(1e5, -2e5, 3e5);
  Camera camera = cameraAt(far + glm::dvec3(8, 8, 0), far);
  camera.orthographic = true;
  Scene scene;
  scene.background = {0.25f, 0.5f, 0.75f};
  scene.lights = {pointLight(far + glm::dvec3(0, 4, 0))};
  const GBuffer gbuffer = onePixel(camera, far, {0, 1, 0});
  const Image image = referenceShade(scene, gbuffer, {});
  ASSERT_EQ(image.width, 7);
  ASSERT_EQ(image.height, 4);
  ASSERT_EQ(image.pixels.size(), 7u * 4 * 3);
  const auto at = [&](int x, int y) {
    const float* p = image.pixels.data() + (y * 7 + x) * 3;
    return glm::dvec3(p[0], p[1], p[2]);
  };
  EXPECT_EQ(at(4, 3), glm::dvec3(0.25, 0.5, 0.75));
  EXPECT_EQ(at(6, 0), glm::dvec3(0.25, 0.5, 0.75));
  // Mirror direction (0,1,0), eye direction at 45°: cos² = 1/2. The view-space position, below 16 and rounded
  // to float, is off by 2^-21 m at most per axis, 4 m from the light: 1e-6 radians; the normal by 2^-24;
  // doubled by the mirror.
  expectColor(at(5, 3), glm::dvec3(0.5), 4e-6);
}

}  // namespace
}  // namespace luciole
