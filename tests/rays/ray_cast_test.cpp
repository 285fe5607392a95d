#include "rays/ray_cast.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "luciole/load_scene.hpp"
#include "rays/shadow_rays.hpp"

namespace luciole {
namespace {

/// Every mesh gets holes: around every third vertex its triangles are open.
Scene sceneWithHoles() {
  Scene scene = loadScene(LUCIOLE_SOURCE_DIR "/scenes/colonnade.json");
  for (Mesh& mesh : scene.meshes) {
    mesh.colors.assign(mesh.positions.size(), glm::vec4(1));
    for (std::size_t i = 0; i < mesh.colors.size(); i += 3) mesh.colors[i].a = 0;
  }
  for (Material& material : scene.materials) material.alpha_cutoff = 0.5f;
  return scene;
}

glm::dvec3 cameraPlace(const Scene& scene) { return glm::dvec3(scene.cameras.front().camera_to_world[3]); }

/// Rays of all lengths from surfaces that the camera sees, and every third from anywhere.
std::vector<ShadowRay> randomRays(const Scene& scene, const RayScene& rays, std::size_t count,
                                  std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> spread(-1, 1);
  const auto direction = [&] {
    return glm::normalize(glm::dvec3(spread(random), spread(random), spread(random)));
  };
  const glm::dvec3 eye = cameraPlace(scene);
  std::vector<ShadowRay> result;
  while (result.size() < count) {
    const glm::dvec3 way = direction();
    const auto hit = castRay(rays, eye, way);
    const bool anywhere = result.size() % 3 == 2 || !hit;
    const glm::dvec3 from = anywhere ? eye + 10 * spread(random) * way : eye + hit->distance * way;
    const double distance =
        result.size() % 2 == 0 ? std::numeric_limits<double>::infinity() : 5 + 5 * spread(random);
    result.push_back({from, direction(), distance});
  }
  return result;
}

std::vector<std::uint8_t> oneByOne(const RayScene& scene, std::span<const ShadowRay> rays) {
  std::vector<std::uint8_t> blocked;
  for (const ShadowRay& ray : rays)
    blocked.push_back(isBlocked(scene, ray.from, ray.direction, ray.distance));
  return blocked;
}

TEST(RayCast, RaysThatNoFloatHoldsMeetNothing) {
  Scene scene = loadScene(LUCIOLE_SOURCE_DIR "/scenes/cornell.json");
  const RayScene rays = buildRayScene(scene, glm::dvec3(0));
  const double infinite = std::numeric_limits<double>::infinity(), none = std::nan("");
  const glm::dvec3 here(0), ahead(0, 0, -1);
  const std::vector<ShadowRay> impossible{{{1e38, 0, 0}, ahead, 1},   {{0, 2e18, 0}, ahead, infinite},
                                          {{none, 0, 0}, ahead, 1},   {here, {none, 0, 0}, infinite},
                                          {here, {0, none, 0}, none}, {{infinite, none, 0}, ahead, 1}};
  for (const ShadowRay& ray : impossible) {
    EXPECT_FALSE(castRay(rays, ray.from, ray.direction));
    EXPECT_FALSE(isBlocked(rays, ray.from, ray.direction, ray.distance));
  }
  // Beside one that can be cast.
  std::vector<ShadowRay> all = impossible;
  all.push_back({cameraPlace(scene), -glm::dvec3(scene.cameras.front().camera_to_world[2]), infinite});
  std::vector<std::uint8_t> blocked(all.size(), 7), expected(all.size(), 0);
  expected.back() = 1;
  areBlocked(rays, all, blocked);
  EXPECT_EQ(blocked, expected);
}

TEST(RayCast, ManyRaysAtOnceAreBlockedAsOneByOne) {
  const Scene scene = sceneWithHoles();
  const RayScene with_holes = buildShadowRays(scene, cameraPlace(scene)),
                 solid = buildRayScene(scene, cameraPlace(scene));
  std::vector<std::uint8_t> answers_with_holes;
  for (const std::size_t count : {1, 7, 17, 93, 100000}) {
    const std::vector<ShadowRay> rays = randomRays(scene, solid, count, std::uint32_t(count));
    for (const RayScene* ray_scene : {&with_holes, &solid}) {
      // One more, which must stay as it is.
      std::vector<std::uint8_t> blocked(count + 1, 7);
      areBlocked(*ray_scene, rays, std::span(blocked).first(count));
      EXPECT_EQ(blocked.back(), 7);
      blocked.pop_back();
      EXPECT_EQ(blocked, oneByOne(*ray_scene, rays)) << count;
      if (ray_scene == &with_holes) answers_with_holes = blocked;
      // Holes, and the triangle that a ray starts from, made a difference.
      else
        EXPECT_TRUE(count < 93 || blocked != answers_with_holes);
    }
  }
  EXPECT_GT(std::count(answers_with_holes.begin(), answers_with_holes.end(), 1), 10000);
  EXPECT_GT(std::count(answers_with_holes.begin(), answers_with_holes.end(), 0), 10000);
}

TEST(RayCast, NoRaysAreNoWork) { areBlocked(RayScene{}, {}, {}); }

}  // namespace
}  // namespace luciole
