#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>

#include "kernels/shared.h"
#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "shade/features.hpp"

// Random surfaces and lights that try everything shading does.
namespace luciole::test {

/// The features that choose how shadow maps are looked up, of which a program has one at most.
inline constexpr Feature kShadowMethods[] = {Feature::kPcf, Feature::kSoft, Feature::kExact};

/// Every feature, and of `needed` the shadow method, which is a choice that no scene makes, and whether there
/// are normal maps: with them lights behind surface_normal are not seen.
inline FeatureSet everyFeature(const FeatureSet& needed = {}) {
  FeatureSet features;
  for (std::size_t i = 0; i < kFeatureCount; ++i) features.set(static_cast<Feature>(i));
  for (const Feature method : kShadowMethods) features.set(method, needed.has(method));
  features.set(Feature::kNormalMaps, needed.has(Feature::kNormalMaps));
  return features;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  bool chance(double probability) { return between(0, 1) < probability; }
  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
  glm::dvec3 color(double most = 1) { return {between(0, most), between(0, most), between(0, most)}; }
  glm::dvec3 direction() {
    std::normal_distribution<double> bell;
    return glm::normalize(glm::dvec3(bell(engine_), bell(engine_), bell(engine_)));
  }

 private:
  std::mt19937 engine_;
};

/// A camera in some pose, tens of kilometres from the origin, where float has centimetres.
inline Camera randomCamera(Random& random) {
  const glm::dvec3 eye = 5e4 * random.direction();
  Camera camera;
  camera.camera_to_world = glm::inverse(glm::lookAt(eye, eye + random.direction(), random.direction()));
  camera.far = 100;
  return camera;
}

/// Points 2 to 30 m ahead, a share of them background. All groups are there.
inline GBuffer randomGBuffer(const Camera& camera, int width, int height, double background, Random& random) {
  GBuffer gbuffer;
  gbuffer.width = width;
  gbuffer.height = height;
  gbuffer.tiles_x = (width + kTileSize - 1) / kTileSize;
  gbuffer.tiles_y = (height + kTileSize - 1) / kTileSize;
  gbuffer.camera = camera;
  gbuffer.picture_size = {width, height};
  const std::size_t n = gbuffer.pixels();
  gbuffer.position.assign(3 * n, 0.0f);
  std::fill_n(gbuffer.position.begin() + 2 * n, n, -std::numeric_limits<float>::infinity());
  for (Plane* group : {&gbuffer.normal, &gbuffer.diffuse, &gbuffer.ambient, &gbuffer.emission})
    group->assign(3 * n, 0.0f);
  gbuffer.specular.assign(4 * n, 0.0f);
  constexpr std::array<float, 6> kShininess{0, 1, 12.5f, 128, 1e4f, 1e6f};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (random.chance(background)) continue;
      const std::size_t place = gbuffer.index(x, y);
      const double depth = random.between(2, 30);
      const glm::dvec3 position(depth * random.between(-0.5, 0.5), depth * random.between(-0.5, 0.5), -depth);
      glm::dvec3 normal = random.direction();
      if (glm::dot(normal, position) > 0) normal = -normal;
      const glm::dvec3 diffuse = random.color(), specular = random.color(), ambient = random.color();
      const glm::dvec3 emission = random.chance(0.1) ? random.color(3) : glm::dvec3(0);
      for (int c = 0; c < 3; ++c) {
        gbuffer.position[place + c * n] = float(position[c]);
        gbuffer.normal[place + c * n] = float(normal[c]);
        gbuffer.diffuse[place + c * n] = float(diffuse[c]);
        gbuffer.specular[place + c * n] = float(specular[c]);
        gbuffer.ambient[place + c * n] = float(ambient[c]);
        gbuffer.emission[place + c * n] = float(emission[c]);
      }
      gbuffer.specular[place + 3 * n] = kShininess[random.below(int(kShininess.size()))];
    }
  }
  return gbuffer;
}

/// A light of any kind, where the camera looks.
inline Light randomLight(const Camera& camera, Random& random) {
  Light light;
  light.kind = static_cast<LightKind>(random.below(3));
  const double depth = random.between(0, 35);
  const glm::dvec3 in_view(depth * random.between(-0.6, 0.6), depth * random.between(-0.6, 0.6), -depth);
  light.position = glm::dvec3(camera.camera_to_world * glm::dvec4(in_view, 1));
  light.direction = random.direction();
  light.diffuse = random.color(4);
  light.specular = random.color(4);
  if (random.chance(0.3)) light.ambient = random.color(0.2);
  if (random.chance(0.3)) light.attenuation = glm::vec3(random.color()) + glm::vec3(0.01f, 0, 0);
  if (random.chance(0.7)) light.range = float(random.between(1, 20));
  light.window = random.chance(0.5) ? RangeWindow::kSmooth : RangeWindow::kKhr;
  if (light.kind == LightKind::kSpot) {
    light.cutoff = glm::radians(random.between(5, 90));
    light.falloff = random.chance(0.5) ? SpotFalloff::kCone : SpotFalloff::kExponent;
    light.inner_cone = light.cutoff * random.between(0, 0.95);
    if (random.chance(0.7)) light.exponent = float(random.between(0, 128));
  }
  return light;
}

inline Scene randomScene(const Camera& camera, int lights, Random& random) {
  Scene scene;
  scene.name = "random";
  scene.background = random.color();
  scene.ambient = random.color(0.1);
  for (int i = 0; i < lights; ++i) scene.lights.push_back(randomLight(camera, random));
  return scene;
}

inline Fog randomFog(FogMode mode, Random& random) {
  Fog fog;
  fog.mode = mode;
  fog.radial = random.chance(0.5);
  fog.density = random.color(0.1);
  fog.start = float(random.between(0, 5));
  fog.end = float(random.between(10, 30));
  fog.color = random.color();
  return fog;
}

}  // namespace luciole::test
