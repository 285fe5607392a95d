#include "raster/clip.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

TEST(Clip, SharedEdgesGetTheSameCornersWhicheverWayTheyRun) {
  const View view = cameraView(frontCamera(), {64, 64});
  const ClipVolume volume = clipVolume(view);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1e4, 1e4);
  const auto point = [&] {
    return view.projection * glm::dvec4(place(random), place(random), place(random), 1.0);
  };
  int shared = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec4 a = point();
    const glm::dvec4 b = point();
    const ClipPolygon left = clipTriangle({a, b, point()}, volume);
    const ClipPolygon right = clipTriangle({b, a, point()}, volume);
    // Points on the line through a and b: what is left of the edge. Both triangles must have the same ones.
    const auto on_edge = [&](const ClipPolygon& polygon) {
      std::vector<glm::dvec4> points;
      for (int k = 0; k < polygon.count; ++k) {
        const glm::dvec4 p = polygon.corners[k];
        const double t = glm::dot(p - a, b - a) / glm::dot(b - a, b - a);
        // Corners are computed within some 10 ε of the largest coordinate (guard · 10⁴), other edges pass by
        // farther.
        if (glm::length(p - (a + t * (b - a))) < 1e-7) points.push_back(p);
      }
      std::sort(points.begin(), points.end(),
                [](const glm::dvec4& p, const glm::dvec4& q) { return p.x < q.x; });
      return points;
    };
    const auto of_left = on_edge(left);
    const auto of_right = on_edge(right);
    ASSERT_EQ(of_left.size(), of_right.size());
    for (std::size_t k = 0; k < of_left.size(); ++k) ASSERT_EQ(of_left[k], of_right[k]);
    shared += int(of_left.size());
  }
  EXPECT_GT(shared, 1000);
}

TEST(Clip, WhatIsLeftLiesInTheVolumeAtAnyScale) {
  Camera camera = frontCamera();
  camera.near = 1e-6;
  camera.far = 1e32;
  const View view = cameraView(camera, {64, 48});
  const ClipVolume volume = clipVolume(view);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> exponent(-8.0, 30.0);
  std::uniform_real_distribution<double> sign(-1.0, 1.0);
  const auto number = [&] { return std::copysign(std::pow(10.0, exponent(random)), sign(random)); };
  const auto point = [&] { return view.projection * glm::dvec4(number(), number(), number(), 1.0); };
  int corners = 0;
  for (int i = 0; i < 20000; ++i) {
    const ClipPolygon polygon = clipTriangle({point(), point(), point()}, volume);
    for (int k = 0; k < polygon.count; ++k) {
      const glm::dvec4& p = polygon.corners[k];
      // The near plane's place itself is rounded.
      ASSERT_GE(p.w, volume.near_w * (1.0 - 4 * 0x1p-53));
      ++corners;
    }
  }
  EXPECT_GT(corners, 1000);
}

/// Compares a floor, drawn, with its rays: coverage away from edges, and positions.
void expectFloor(double height, double pitch, double near, double far, double extent, glm::ivec2 size) {
  const float e = float(extent);
  Scene scene = meshScene({{-e, 0, -e}, {e, 0, -e}, {e, 0, e}, {-e, 0, e}}, {{0, 2, 1}, {0, 3, 2}});
  Camera camera;
  camera.near = near;
  camera.far = far;
  camera.camera_to_world =
      glm::rotate(glm::translate(glm::dmat4(1.0), {0.3, height, 0.2}), pitch, {1.0, 0.0, 0.0});
  const View view = cameraView(camera, size);
  const GBuffer gbuffer = draw(scene, view);
  int covered = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      int hits = 0;
      int sides = 0;  // of the floor's diagonal
      glm::dvec3 expected;
      for (const Ray& ray : raysAround(camera, size, x, y)) {
        const glm::dvec3 direction = glm::dmat3(camera.camera_to_world) * ray.direction;
        const double t = -height / direction.y;  // also the depth, as rays advance by 1 along −z
        const glm::dvec3 world = glm::dvec3(camera.camera_to_world[3]) + t * direction;
        const bool hit = t >= near && t <= far && std::abs(world.x) <= extent && std::abs(world.z) <= extent;
        if (hits == 0 && hit) expected = t * ray.direction;
        hits += hit;
        sides += world.x > world.z ? 1 : -1;
      }
      if (hits == 0) {
        ASSERT_FALSE(isCovered(gbuffer, x, y)) << x << ',' << y;
      }
      // Where the floor's two triangles meet, a pixel may show the other one's edge.
      if (hits < 5 || std::abs(sides) < 5) continue;
      ++covered;
      ASSERT_TRUE(isCovered(gbuffer, x, y)) << x << ',' << y;
      // Stored as float. In double, the weights of a floor of that extent err by some 10 ε, thus the position
      // by 10 ε · extent, and by the slope under which the ray meets the floor: t · |direction| / height
      // times that.
      const double slack = 10.0 * 0x1p-53 * extent * (1.0 + glm::length(expected) / height);
      ASSERT_LE(glm::length(glm::dvec3(positionAt(gbuffer, x, y)) - expected),
                kFloatRounding * glm::length(expected) + slack)
          << x << ',' << y;
    }
  EXPECT_GT(covered, size.x * size.y / 10);
}

TEST(Clip, AFloorUnderAndBehindTheCamera) {
  expectFloor(1.5, 0.0, 0.1, 1e3, 500.0, {144, 93});
  expectFloor(1.5, -0.6, 0.1, 1e3, 500.0, {144, 93});
  expectFloor(1.5, -M_PI / 2, 0.1, 1e3, 500.0, {93, 144});
  expectFloor(1e-3, -0.3, 1e-6, 1e8, 1e4, {64, 64});
  expectFloor(20.0, -0.1, 1.0, 100.0, 1e5, {64, 64});
}

TEST(Clip, CornersInTheEyesPlaneAndAtTheEye) {
  // w = 0 or next to it at one, two and three corners: no crash, and what is drawn lies beyond the near
  // plane.
  Camera camera = frontCamera();
  camera.near = 1e-6;
  camera.far = 1e8;
  const View view = cameraView(camera, {50, 40});
  for (const float w : {0.0f, 1e-12f, -1e-12f, 1e-30f}) {
    const std::vector<glm::vec3> corners{{0, 0, -w}, {3, 0, -w},  {-2, 5, -w},
                                         {1, 1, -4}, {-1, 2, -7}, {1e9f, 1, 1e9f}};
    for (const glm::uvec3& triangle :
         {glm::uvec3(0, 3, 4), {0, 1, 3}, {1, 2, 3}, {0, 1, 2}, {3, 4, 5}, {1, 5, 4}}) {
      const GBuffer gbuffer = draw(meshScene(corners, {triangle}), view);
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 50; ++x) {
          if (!isCovered(gbuffer, x, y)) continue;
          // Beyond the near plane, whose corners round by some ε of themselves.
          ASSERT_LT(positionAt(gbuffer, x, y).z, -0.999e-6f);
        }
    }
  }
}

TEST(Clip, FromInsideABoxEveryPixelShowsAWall) {
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 3 : -3, i & 2 ? 2 : -2, i & 4 ? 5 : -5});
  const Scene scene = meshScene(corners, {{0, 1, 3},
                                          {0, 3, 2},
                                          {4, 7, 5},
                                          {4, 6, 7},
                                          {0, 4, 5},
                                          {0, 5, 1},
                                          {2, 3, 7},
                                          {2, 7, 6},
                                          {0, 2, 6},
                                          {0, 6, 4},
                                          {1, 5, 7},
                                          {1, 7, 3}});
  for (int turn = 0; turn < 12; ++turn) {
    Camera camera = frontCamera();
    camera.fov_y = 2.0;
    camera.camera_to_world =
        glm::rotate(glm::dmat4(1.0), 0.55 * turn, glm::normalize(glm::dvec3(1, 2, 0.5 * turn)));
    const GBuffer gbuffer = draw(scene, cameraView(camera, {93, 70}));
    for (int y = 0; y < 70; ++y)
      for (int x = 0; x < 93; ++x) {
        ASSERT_TRUE(isCovered(gbuffer, x, y));
        const glm::dvec3 p =
            glm::abs(glm::dmat3(camera.camera_to_world) * glm::dvec3(positionAt(gbuffer, x, y)));
        // On a wall, the others not passed: |p| ≤ √38 < 7, stored as float.
        ASSERT_NEAR(std::max({p.x / 3.0, p.y / 2.0, p.z / 5.0}), 1.0, 7.0 * kFloatRounding);
      }
  }
}

TEST(Clip, TheNearPlaneCutsAtItsDistance) {
  // A wall seen along itself: x = 1, from z = 0 to −10; what is nearer than 2 m is cut away.
  const Scene scene =
      meshScene({{1, -50, 0}, {1, -50, -10}, {1, 50, -10}, {1, 50, 0}}, {{0, 1, 2}, {0, 2, 3}});
  Camera camera;
  camera.near = 2.0;
  camera.far = 8.0;
  camera.fov_y = M_PI / 2;
  const GBuffer gbuffer = draw(scene, cameraView(camera, {400, 400}));
  float nearest = -1e9f;
  float farthest = 0.0f;
  for (int x = 0; x < 400; ++x)
    if (isCovered(gbuffer, x, 200)) {
      nearest = std::max(nearest, positionAt(gbuffer, x, 200).z);
      farthest = std::min(farthest, positionAt(gbuffer, x, 200).z);
    }
  // Pixel columns are 1/200 apart at depth 1: there the wall is at depth 1 / (0.005 k), so within (z² ·
  // 0.005) m of the planes.
  EXPECT_LE(nearest, -2.0f);
  EXPECT_GE(nearest, -2.0f - 4.0f * 0.006f);
  EXPECT_GE(farthest, -8.0f);
  EXPECT_LE(farthest, -8.0f + 64.0f * 0.006f);
}

}  // namespace
}  // namespace luciole::test
