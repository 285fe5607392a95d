#include "shadow/maps/cascades.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "raster/rasterize.hpp"
#include "shadow/maps/shadow_scenes.hpp"
#include "shadow/maps/texel_place.hpp"

namespace luciole::test {
namespace {

TEST(Cascades, EachReachesThreeTimesAsFarAsTheOneBefore) {
  Camera camera;  // at the origin, along −z
  const View view = cameraView(camera, {200, 100});
  const std::vector<Sphere> spheres = cascadeSpheres(view, {{-100, -100, -99}, {100, 100, 0}});
  ASSERT_EQ(spheres.size(), std::size_t(kCascades));
  // From the near end of its part to the far one a cascade is three times as large as the one before; the
  // first two begin at 0.
  for (int i = 2; i < kCascades - 1; ++i) {
    EXPECT_NEAR(spheres[i].radius / spheres[i - 1].radius, 3.0, 1e-12) << i;  // some twenty roundings
  }
}

TEST(Cascades, NoneIsLargerThanTheScene) {
  const View view = cameraView(Camera{}, {200, 100});
  const Bounds scene{{-1, -1, -3}, {1, 1, -2}};
  const std::vector<Sphere> spheres = cascadeSpheres(view, scene);
  for (const Sphere& sphere : spheres) EXPECT_LE(sphere.radius, 0.5 * glm::distance(scene.low, scene.high));
  EXPECT_EQ(spheres.back().middle, glm::dvec3(0, 0, -2.5));
}

/// What a camera over the terrain sees, in world space.
std::vector<glm::dvec3> seenPoints(const Scene& scene, const View& view) {
  const GBuffer gbuffer = rasterize(scene, allObjects(scene), view, Shading::kFlat, {});
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < gbuffer.pixels(); ++i) {
    const glm::dvec3 p(gbuffer.position[i], gbuffer.position[gbuffer.pixels() + i],
                       gbuffer.position[2 * gbuffer.pixels() + i]);
    if (std::isfinite(p.z)) points.emplace_back(scene.cameras.front().camera_to_world * glm::dvec4(p, 1));
  }
  return points;
}

TEST(Cascades, CoverAllThatIsSeenTheFinestFirst) {
  for (const auto& [orthographic, shift] :
       {std::pair(false, glm::dvec2(0)), {true, glm::dvec2(0)}, {false, {-0.8, 0.4}}, {true, {-0.8, 0.4}}}) {
    Scene scene = terrainScene();
    scene.lights.resize(1);
    scene.cameras.front().shift = shift;
    scene.cameras.front().orthographic = orthographic;
    scene.cameras.front().half_height = 2;
    const View view = cameraView(scene.cameras.front(), {200, 100});
    const ShadowMaps maps = planShadowMaps(scene, view, ShadowMethod::kHard, {.size = 512});
    EXPECT_EQ(maps.faces.size() > 1, !orthographic);
    for (std::size_t i = 1; i < maps.faces.size(); ++i)
      EXPECT_LT(maps.faces[i].scale, maps.faces[i - 1].scale);
    std::vector<int> used(maps.faces.size());
    const std::vector<glm::dvec3> points = seenPoints(scene, view);
    for (const glm::dvec3& point : points) {
      const auto place = placeOf(maps, maps.maps.front(), point);
      ASSERT_TRUE(place) << point.x << ' ' << point.y << ' ' << point.z;
      ++used[place->face];
    }
    EXPECT_GT(points.size(), 15000u);
    if (!orthographic) {
      EXPECT_GT(std::count_if(used.begin(), used.end(), [](int count) { return count > 100; }), 1);
    }
  }
}

}  // namespace
}  // namespace luciole::test
