// Shadow maps held against rays (Embree), light by light, in this project's own scenes.
#include <gtest/gtest.h>

#include <cmath>

#include "render_json.hpp"
#include "scene/ray_cast.hpp"

namespace luciole::test {
namespace {

constexpr glm::ivec2 kSize{320, 180};

/// Pixels of one light's picture, by what the map and the ray say.
struct Verdicts {
  int compared = 0;     ///< facing the light, and away from edges of its shadow
  int near_edges = 0;   ///< a pixel within two of them has another truth, or the filter is in between
  int wrongly_lit = 0;  ///< of the compared ones
  int wrongly_dark = 0;
};

/// Whether a ray from the point reaches the light. It starts off the surface by a share of the distance to
/// the eye that covers the float positions' rounding (2^-24) and the triangles' own (2^-24 of their distance
/// from the rays' origin) 100 times.
bool isLit(const RayScene& rays, const Light& light, const glm::dvec3& point, const glm::dvec3& normal,
           double distance) {
  const glm::dvec3 from = point + normal * (distance * 1e-5);
  const glm::dvec3 way = light.kind == LightKind::kDirectional ? -light.direction : light.position - from;
  const double reach = light.kind == LightKind::kDirectional ? INFINITY : glm::length(way);
  const auto hit = castRay(rays, from, glm::normalize(way));
  // What hides a lamp's own middle, its bulb, is nearer to it than a map's near plane.
  return !hit || hit->distance > reach * (1 - 1e-3);
}

Verdicts judge(const Scene& whole, const Light& light, const RayScene& rays, ShadowMethod method) {
  Scene scene = whole;
  scene.lights = {light};
  scene.lights[0].ambient = glm::vec3(0);
  RenderSettings settings;
  settings.size = kSize;
  settings.camera = scene.cameras.front();
  settings.aovs = {Aov::kShadow, Aov::kPosition, Aov::kNormal, Aov::kDepth};
  settings.shade.shadows = method;
  Stats stats;
  const Image image = renderScene(testDevice(), scene, settings, stats);
  const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow"),
                    place = channelIndex(image, "P.X"), direction = channelIndex(image, "N.X"),
                    depth = channelIndex(image, "Z");

  enum State : char {
    kUnlit,
    kLit,
    kDark
  };  // unlit: background, or the light doesn't reach the surface anyway
  std::vector<State> truth(std::size_t(kSize.x) * kSize.y, kUnlit);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const float* pixel = image.pixels.data() + i * channels;
    if (!std::isfinite(pixel[depth])) continue;
    const glm::dvec3 point(pixel[place], pixel[place + 1], pixel[place + 2]);
    const glm::dvec3 normal(pixel[direction], pixel[direction + 1], pixel[direction + 2]);
    const glm::dvec3 way = light.kind == LightKind::kDirectional ? -light.direction : light.position - point;
    const double length = glm::length(way);
    if (glm::dot(normal, way) <= 0.05 * length) continue;  // so grazing that an interpolated normal decides
    if (light.kind != LightKind::kDirectional && length >= light.range) continue;
    if (light.kind == LightKind::kSpot && glm::dot(-way / length, light.direction) < std::cos(light.cutoff))
      continue;
    truth[i] = isLit(rays, light, point, normal, pixel[depth]) ? kLit : kDark;
  }

  Verdicts verdicts;
  for (int y = 2; y < kSize.y - 2; ++y)
    for (int x = 2; x < kSize.x - 2; ++x) {
      const std::size_t i = std::size_t(y) * kSize.x + x;
      if (truth[i] == kUnlit) continue;
      const float visibility = image.pixels[i * channels + shadow];
      bool edge = visibility > 0 && visibility < 1;
      for (int v = -2; v <= 2; ++v)
        for (int u = -2; u <= 2; ++u) edge |= truth[i + v * kSize.x + u] != truth[i];
      if (edge) {
        ++verdicts.near_edges;
        continue;
      }
      ++verdicts.compared;
      verdicts.wrongly_lit += truth[i] == kDark && visibility == 1;
      verdicts.wrongly_dark += truth[i] == kLit && visibility == 0;
    }
  return verdicts;
}

class ShadowRays : public testing::TestWithParam<const char*> {};

TEST_P(ShadowRays, AgreeWithTheMapsAwayFromEdges) {
  const Scene scene = loadScene(LUCIOLE_SOURCE_DIR "/scenes/" + std::string(GetParam()) + ".json");
  const RayScene rays = buildRayScene(scene, glm::dvec3(scene.cameras.front().camera_to_world[3]));
  for (const ShadowMethod method : {ShadowMethod::kHard, ShadowMethod::kPcf}) {
    Verdicts sum;
    for (const Light& light : scene.lights) {
      if (!light.shadow) continue;
      const Verdicts one = judge(scene, light, rays, method);
      sum.compared += one.compared;
      sum.near_edges += one.near_edges;
      sum.wrongly_lit += one.wrongly_lit;
      sum.wrongly_dark += one.wrongly_dark;
    }
    ASSERT_GT(sum.compared, 1000);
    std::printf(
        "%s, %s: %d pairs, %d more at edges; lit that should be dark %d, dark that should be lit %d\n",
        GetParam(), method == ShadowMethod::kHard ? "hard" : "pcf", sum.compared, sum.near_edges,
        sum.wrongly_lit, sum.wrongly_dark);
    // What a map of this kind may miss: 0.5 % of the pairs.
    EXPECT_LE(sum.wrongly_lit + sum.wrongly_dark, sum.compared / 200);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShadowRays, testing::Values("cornell", "colonnade", "spheres", "city"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace luciole::test
