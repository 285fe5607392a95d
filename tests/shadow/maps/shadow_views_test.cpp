#include "shadow/maps/shadow_views.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "shadow/maps/shadow_scenes.hpp"
#include "shadow/maps/texel_place.hpp"

namespace luciole::test {
namespace {

TEST(ShadowViews, SpotsThatOneMapIsTooFlatForGetACube) {
  Light spot;
  spot.kind = LightKind::kSpot;
  spot.cutoff = 1.0;  // 57°
  EXPECT_FALSE(usesCubeMap(spot));
  spot.cutoff = 1.1;  // 63°
  EXPECT_TRUE(usesCubeMap(spot));
}

TEST(ShadowViews, AMapHasAViewAndALookupAFace) {
  const Scene scene = terrainScene();
  const View camera = cameraView(scene.cameras.front(), {200, 100});
  const PlanInput input{camera, ShadowMethod::kSoft, glm::inverse(camera.world_to_view), sceneBounds(scene)};
  for (const Light& light : scene.lights) {
    const PlannedMap map = planMap(light, input, 200);
    EXPECT_EQ(map.views.size(), map.faces.size());
    EXPECT_LE(int(map.faces.size()), facesOf(light));
    for (std::size_t i = 0; i < map.faces.size(); ++i) {
      EXPECT_EQ(map.views[i].crop_size, glm::ivec2(200));
      EXPECT_EQ(map.faces[i].low, float(borderOf(200, ShadowMethod::kSoft)));
      EXPECT_EQ(map.faces[i].high, 200 - map.faces[i].low);
      EXPECT_EQ(map.faces[i].width, 0u);  // nothing is drawn
    }
  }
}

TEST(ShadowViews, LookupsAndViewsAgreeOnEveryTexel) {
  const Scene scene = terrainScene();
  const ShadowMaps maps = planFor(scene);
  const View camera = cameraView(scene.cameras.front(), {200, 100});
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(-6, 6);
  int compared = 0;
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 world(place(random), 0.2 * place(random), place(random));
    const glm::dvec4 seen = camera.world_to_view * glm::dvec4(world, 1);
    for (const ShadowMap& map : maps.maps) {
      if (map.kind == kCubeMap) continue;  // tests/kernels/shadow_test.cpp knows the order of the faces
      const auto row = [&](const float4& r) { return glm::dot(glm::dvec4(r.x, r.y, r.z, r.w), seen); };
      const double u = row(map.to_map_x), v = row(map.to_map_y), w = row(map.to_map_z);
      const bool parallel = map.kind == kParallelMap;
      for (std::size_t f = map.first_face; f < map.first_face + map.face_count; ++f) {
        const auto texel = texelOn(maps.planned[f], world);
        if (!texel || (!parallel && w < 0.5)) continue;
        const ShadowFace& face = maps.faces[f];
        const double divide = parallel ? 1 : w;
        const glm::dvec2 looked_up(face.middle_x + face.scale * u / divide,
                                   face.middle_y - face.scale * v / divide);
        // The rows' four floats and those of the face round once, in coordinates up to 15 m, and 30 texels a
        // tangent or a metre times the scale; w from 0.5 m on doubles it.
        const double allowed = 0x1p-24 * (8 * 15 * face.scale / (parallel ? 1 : 0.25) +
                                          4 * std::abs(face.middle_x) + 4 * std::abs(face.middle_y));
        ASSERT_LE(glm::length(looked_up - *texel), allowed) << "face " << f;
        const glm::dvec4 clip =
            maps.planned[f].view.projection * (maps.planned[f].view.world_to_view * glm::dvec4(world, 1));
        const double depth = parallel ? w : map.depth_scale / w + map.depth_offset;
        ASSERT_NEAR(depth, clip.z / clip.w,
                    0x1p-24 * (parallel ? 64 : 64 * map.depth_scale / (w * w)) + 0x1p-24);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 5000);
}

TEST(ShadowViews, MovingCameraLeavesTexelsWhereTheyAreInTheWorld) {
  Scene scene = terrainScene();
  scene.lights.resize(1);
  // It sees 14.65 m far; texels change their size where that passes 16 m, or 11.3 m.
  scene.cameras.front().camera_to_world =
      scene.cameras.front().camera_to_world * glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -1));
  const ShadowMaps home = planFor(scene);
  const double texel = 1 / home.faces.front().scale;
  const glm::dmat4 place = scene.cameras.front().camera_to_world;
  std::mt19937 random(12);
  std::uniform_real_distribution<double> unit(-1, 1);
  int jumps = 0;
  for (int i = 0; i < 50; ++i) {
    const double reach = i % 2 ? texel : 30 * texel;
    const glm::dvec3 way = reach * glm::dvec3(unit(random), unit(random), unit(random));
    // Turned too: the cascades are around spheres.
    scene.cameras.front().camera_to_world =
        glm::rotate(glm::translate(glm::dmat4(1), way) * place, 0.02 * unit(random), glm::dvec3(0, 1, 0));
    const ShadowMaps moved = planFor(scene);
    ASSERT_EQ(moved.faces.size(), home.faces.size());
    for (std::size_t f = 0; f < home.faces.size(); ++f) {
      EXPECT_EQ(moved.planned[f].view.size, home.planned[f].view.size);
      EXPECT_EQ(moved.faces[f].scale, home.faces[f].scale);
      for (const glm::dvec3& point : {glm::dvec3(0), {3.1, 0.7, -2.3}}) {
        const glm::dvec2 shift =
            texelOn(moved.planned[f], point).value() - texelOn(home.planned[f], point).value();
        // Some twenty roundings of doubles of up to 10⁴ texels.
        ASSERT_LE(glm::length(shift - glm::round(shift)), 20 * 0x1p-53 * 1e4) << "cascade " << f;
        jumps += glm::round(shift) != glm::dvec2(0);
      }
    }
  }
  EXPECT_GT(jumps, 0);  // it follows the camera
}

}  // namespace
}  // namespace luciole::test
