// Shadow maps held against rays (Embree), light by light, in this project's own scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rays/ray_cast.hpp"
#include "render_json.hpp"
#include "shadow/maps/shadow_maps.hpp"
#include "shadow/maps/texel_place.hpp"

namespace luciole::test {
namespace {

constexpr glm::ivec2 kSize{320, 180};

/// How near to a shadow's edge a map may be wrong, in texels: a filtered lookup reads texels whose centres
/// are up to one away along both of the map's axes.
constexpr double kEdgeTexels = std::numbers::sqrt2;

/// Pixels that a light would reach if nothing were in its way. The map calls those dark where it lets less
/// than half through.
struct Verdicts {
  int lit = 0, dark = 0;                  ///< what the rays say, away from edges of the shadow
  int wrongly_lit = 0, wrongly_dark = 0;  ///< of those, what the map says otherwise
  int near_edges = 0, wrong_near_edges = 0;
};

bool hasPlace(const Light& light) { return light.kind != LightKind::kDirectional; }

glm::dvec3 wayToLight(const Light& light, const glm::dvec3& point) {
  return hasPlace(light) ? light.position - point : -light.direction;
}

/// A pixel's point in world space.
struct Surface {
  glm::dvec3 point;
  glm::dvec3 normal;  ///< the triangle's own
  glm::dvec3 shading_normal;
  double eye_distance;
};

/// Whether the light reaches the surface where nothing is in its way. Leaves out what it only grazes: there a
/// texel covers 20 times its side on the triangle, and near the shading normal's horizon rounding decides
/// whether the pixel counts as lit at all.
bool isExposed(const Light& light, const Surface& surface) {
  const glm::dvec3 way = wayToLight(light, surface.point);
  const double length = glm::length(way);
  if (glm::dot(surface.shading_normal, way) <= 1e-3 * length) return false;
  if (std::abs(glm::dot(surface.normal, way)) <= 0.05 * length) return false;
  if (hasPlace(light) && length >= light.range) return false;
  return light.kind != LightKind::kSpot || glm::dot(-way / length, light.direction) > std::cos(light.cutoff);
}

/// Whether a ray from the surface reaches the light. It starts off the surface by 1e-5 of the lengths whose
/// floats round by 6e-8: the point's distance from the world's origin, as the pixel has it, and from the eye,
/// where the rays have theirs.
bool isLit(const RayScene& rays, const Light& light, const Surface& surface) {
  const double lift = 1e-5 * (surface.eye_distance + glm::length(surface.point));
  const glm::dvec3 from = surface.point + lift * surface.normal;
  const glm::dvec3 way = wayToLight(light, from);
  const auto hit = castRay(rays, from, glm::normalize(way));
  return !hit || (hasPlace(light) && hit->distance >= glm::length(way));
}

/// Whether one of nine points has another truth: eight around in the triangle's plane, kEdgeTexels away as
/// the light sees it, and one as far above.
bool isNearEdge(const RayScene& rays, const Light& light, double texel_side, const Surface& surface,
                bool lit) {
  const glm::dvec3 to_light = glm::normalize(wayToLight(light, surface.point));
  const glm::dvec3 any = std::abs(to_light.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(to_light, any)), up = glm::cross(right, to_light);
  const double reach = kEdgeTexels * texel_side;
  const auto differsAt = [&](const glm::dvec3& shift) {
    Surface nearby = surface;
    nearby.point += shift;
    return isLit(rays, light, nearby) != lit;
  };
  if (differsAt(reach * surface.normal)) return true;
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::numbers::pi / 4;
    const glm::dvec3 across = reach * (std::cos(angle) * right + std::sin(angle) * up);
    // Back into the plane along the light's rays.
    const double along = -glm::dot(surface.normal, across) / glm::dot(surface.normal, to_light);
    if (differsAt(across + along * to_light)) return true;
  }
  return false;
}

/// Counts what a scene's map of its only light says, against the rays.
void judge(const Scene& scene, const RayScene& rays, ShadowMethod method, Verdicts& verdicts) {
  RenderSettings settings;
  settings.size = kSize;
  settings.camera = scene.cameras.front();
  settings.aovs = {Aov::kShadow, Aov::kPosition, Aov::kNormal, Aov::kDepth};
  settings.shade.shadows = method;
  Stats stats;
  const Image image = renderScene(testDevice(), scene, settings, stats);
  settings.shading = Shading::kFlat;
  settings.shade.shadows = ShadowMethod::kOff;
  const Image flat = renderScene(testDevice(), scene, settings, stats);
  const std::size_t channels = image.channels.size(), shadow = channelIndex(image, "shadow"),
                    place = channelIndex(image, "P.X"), direction = channelIndex(image, "N.X"),
                    depth = channelIndex(image, "Z");
  const Light& light = scene.lights.front();
  const ShadowMaps maps =
      planShadowMaps(scene, cameraView(settings.camera, kSize), method, settings.shade.shadow_limits);
  const glm::dvec3 eye(settings.camera.camera_to_world[3]);

  for (std::size_t i = 0; i < image.pixels.size(); i += channels) {
    const float* pixel = image.pixels.data() + i;
    if (!std::isfinite(pixel[depth])) continue;
    Surface surface{
        {pixel[place], pixel[place + 1], pixel[place + 2]},
        {flat.pixels[i + direction], flat.pixels[i + direction + 1], flat.pixels[i + direction + 2]},
        {pixel[direction], pixel[direction + 1], pixel[direction + 2]},
        0};
    surface.eye_distance = glm::distance(surface.point, eye);
    if (!isExposed(light, surface)) continue;
    const auto texel = placeOf(maps, maps.maps.front(), surface.point);
    ASSERT_TRUE(texel) << fmt::format("no texel for {} {} {}", surface.point.x, surface.point.y,
                                      surface.point.z);
    const bool lit = isLit(rays, light, surface), map_lit = pixel[shadow] >= 0.5f;
    if (isNearEdge(rays, light, texel->side, surface, lit)) {
      ++verdicts.near_edges;
      verdicts.wrong_near_edges += lit != map_lit;
      continue;
    }
    ++(lit ? verdicts.lit : verdicts.dark);
    verdicts.wrongly_lit += !lit && map_lit;
    verdicts.wrongly_dark += lit && !map_lit;
  }
}

class ShadowRays : public testing::TestWithParam<const char*> {};

TEST_P(ShadowRays, AgreeWithTheMapsAwayFromEdges) {
  const Scene scene = loadScene(fmt::format("{}/scenes/{}.json", LUCIOLE_SOURCE_DIR, GetParam()));
  const RayScene rays = buildRayScene(scene, glm::dvec3(scene.cameras.front().camera_to_world[3]));
  for (const ShadowMethod method : {ShadowMethod::kHard, ShadowMethod::kPcf}) {
    Verdicts sum;
    Scene one_light = scene;
    for (const Light& light : scene.lights) {
      if (!light.shadow) continue;
      one_light.lights = {light};
      judge(one_light, rays, method, sum);
    }
    const std::string numbers = fmt::format(
        "away from edges {} lit and {} dark, of them wrong {} and {}; near edges {}, of them wrong {}",
        sum.lit, sum.dark, sum.wrongly_dark, sum.wrongly_lit, sum.near_edges, sum.wrong_near_edges);
    const char* name = method == ShadowMethod::kHard ? "hard" : "pcf";
    RecordProperty(name, numbers);
    fmt::print("{}, {}: {}\n", GetParam(), name, numbers);
    EXPECT_GT(sum.lit, 1000);
    EXPECT_GT(sum.dark, 1000);
    // What the project promises for its maps: 0.5 %.
    EXPECT_LE((sum.wrongly_lit + sum.wrongly_dark) * 200, sum.lit + sum.dark);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ShadowRays, testing::Values("cornell", "colonnade", "spheres", "city"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace luciole::test
