#include "render/classify.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "kernels/shared.h"
#include "rays/shadow_rays.hpp"
#include "render/lighting.hpp"

namespace luciole::test {
namespace {

constexpr glm::ivec2 kSheetsSize{160, 120};
constexpr int kSheets = 60;

/// Adds the parallelogram with these sides at the corner, wound so that its normal is cross(u, v).
void addSheet(const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v, Mesh& mesh) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (const glm::dvec3& place : {corner, corner + u, corner + u + v, corner + v}) {
    mesh.positions.push_back(glm::vec3(place));
    mesh.normals.push_back(glm::vec3(glm::normalize(glm::cross(u, v))));
  }
  for (const glm::uvec3& corners : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
    mesh.triangles.push_back(corners + first);
    mesh.triangle_materials.push_back(0);
  }
}

/// Sheets that the eye, at the origin, sees, and covers that only the lights know. A cover lies over a half
/// of its sheet, at a distance that is 0.2 to 30 times the one up to which shadow rays ignore it.
struct Sheets {
  Mesh seen, covers;
  /// Whether the shadow maps hold what is seen, too. Surfaces of another program's G-buffer needn't be there.
  bool cast = true;
};

Sheets coveredSheets(Random& random) {
  Sheets sheets;
  for (int i = 0; i < kSheets; ++i) {
    const glm::dvec3 way =
        glm::normalize(glm::dvec3(random.between(-0.6, 0.6), random.between(-0.45, 0.45), -1));
    const glm::dvec3 center = random.between(2, 12) * way;
    const glm::dvec3 normal = glm::normalize(random.direction() * 0.7 - way);
    const double side = 0.2 * glm::length(center);
    const glm::dvec3 u = side * glm::normalize(glm::cross(normal, random.direction()));
    const glm::dvec3 v = glm::cross(normal, u);
    addSheet(center - 0.5 * (u + v), u, v, sheets.seen);
    const double times =
        random.chance(0.3) ? random.between(0.8, 1.2) : std::exp(random.between(std::log(0.2), std::log(30)));
    const double gap = times * double(POINT_ERROR) * glm::length(center);
    addSheet(center - 0.5 * (u + v) + gap * normal, 0.5 * u, v, sheets.covers);
  }
  return sheets;
}

std::vector<Light> lightsOverSheets(Random& random) {
  std::vector<Light> lights;
  for (const LightKind kind : {LightKind::kDirectional, LightKind::kPoint, LightKind::kSpot})
    for (int i = 0; i < 4; ++i) {
      Light light;
      light.kind = kind;
      light.shadow = true;
      light.position = glm::dvec3(random.between(-6, 6), random.between(-6, 6), random.between(-2, 3));
      light.direction = glm::normalize(glm::dvec3(random.between(-3, 3), random.between(-3, 3), -7) -
                                       glm::dvec3(light.position));
      light.cutoff = glm::radians(60.0);
      lights.push_back(light);
    }
  return lights;
}

/// Whether the light may brighten the point (world space), whatever the kernel rounds.
bool surelyReaches(const Light& light, const glm::dvec3& point, const glm::dvec3& normal) {
  const glm::dvec3 to_light =
      light.kind == LightKind::kDirectional ? -light.direction : glm::normalize(light.position - point);
  if (light.kind == LightKind::kSpot && glm::dot(-to_light, light.direction) < std::cos(light.cutoff) + 1e-3)
    return false;
  return glm::dot(to_light, normal) > 1e-3;
}

struct Verdicts {
  std::uint64_t pairs = 0;  ///< of a pixel and a light that may brighten it
  std::uint64_t dark = 0, lit = 0;
  std::uint64_t wrong = 0;  ///< of `dark` and `lit`, those of which a ray says the opposite
};

/// Adds up the verdicts on the sheets.
void addVerdicts(const Sheets& sheets, const std::vector<Light>& lights, int lanes, Verdicts& verdicts) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes = {sheets.seen};
  scene.objects = {{0, glm::dmat4(1), -1}};
  scene.lights = lights;
  Camera camera;
  camera.camera_to_world = glm::dmat4(1);
  scene.cameras = {camera};
  const View view = cameraView(camera, kSheetsSize);
  ShadeSettings settings;
  settings.culling = Culling::kNone;
  settings.shadows = ShadowMethod::kExact;
  settings.shadow_limits.size = 1024;
  const FeatureSet features = neededFeatures(scene, camera, materialTraits(scene), settings);
  const GBuffer gbuffer = rasterize(scene, allObjects(scene), view, Shading::kFlat, neededPlanes(features));

  scene.meshes.push_back(sheets.covers);
  if (!sheets.cast) scene.objects.clear();
  scene.objects.push_back({1, glm::dmat4(1), -1});
  Device& device = deviceWithLanes(lanes);
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, camera, view, features, settings, lighting, stats);
  const LitPlanes lit = lightGBuffer(device, scene, lighting, features, gbuffer, {}, stats);

  const std::size_t light_count = scene.lights.size(), stride = gbuffer.pixels();
  const RayScene rays = buildShadowRays(scene, glm::dvec3(0.0));
  for (std::size_t place = 0; place < stride; ++place) {
    if (!std::isfinite(gbuffer.position[place + 2 * stride])) continue;
    const glm::dvec3 normal(gbuffer.normal[place], gbuffer.normal[place + stride],
                            gbuffer.normal[place + 2 * stride]);
    const glm::dvec3 start = shadowStart(gbuffer, place);
    const std::size_t tile = place / kTilePixels, pixel = place % kTilePixels;
    for (std::size_t i = 0; i < light_count; ++i) {
      const Light& light = scene.lights[lighting.order[i]];
      if (!surelyReaches(light, start, normal)) continue;
      const uint* words = &lit.pair_bits[(tile * light_count + i) * kPairWords];
      const auto bit = [&](const uint* half) { return (half[pixel / 32] >> pixel % 32 & 1) != 0; };
      ++verdicts.pairs;
      if (bit(words + kPairWords / 2)) continue;
      const ShadowRay ray = shadowRay(light, start);
      const bool is_lit = !isBlocked(rays, ray.from, ray.direction, ray.distance);
      ++(bit(words) ? verdicts.lit : verdicts.dark);
      verdicts.wrong += bit(words) != is_lit;
    }
  }
}

// A verdict saves a ray and so must be the ray's. Hardest is a surface as close behind another as the points
// on it are uncertain: whether that is a shadow depends on the last thousandth of the distance.
TEST(Classify, AVerdictIsTheRays) {
  Random random(21);
  Verdicts verdicts;
  for (const int lanes : {1, 4, 8, 16}) {
    const Sheets sheets = coveredSheets(random);
    addVerdicts(sheets, lightsOverSheets(random), lanes, verdicts);
  }
  EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs";
  // It decides much even here, and there are many of either verdict.
  EXPECT_GT(verdicts.dark + verdicts.lit, verdicts.pairs / 3);
  EXPECT_GT(verdicts.dark, verdicts.pairs / 10);
  EXPECT_GT(verdicts.lit, verdicts.pairs / 10);
}

// The surface of a point that casts no shadow itself is not among a texel's depths, and can't keep it unsure.
TEST(Classify, AVerdictIsTheRaysOnSurfacesThatCastNothing) {
  Random random(22);
  Verdicts verdicts;
  for (const int lanes : {4, 16}) {
    Sheets sheets = coveredSheets(random);
    sheets.cast = false;
    addVerdicts(sheets, lightsOverSheets(random), lanes, verdicts);
  }
  EXPECT_EQ(verdicts.wrong, 0u) << "of " << verdicts.pairs << " pairs";
  EXPECT_GT(verdicts.dark, 1000u) << verdicts.pairs << " pairs";
  EXPECT_GT(verdicts.lit, 1000u);
}

}  // namespace
}  // namespace luciole::test
