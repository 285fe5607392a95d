#include "shadow/exact/light_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <random>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "raster/opacity.hpp"
#include "shade/features.hpp"
#include "shadow/exact/brute_shadows.hpp"
#include "shadow/exact/loose_triangles.hpp"

// Rays on the device say what countUnblocked() says.
namespace luciole::test {
namespace {

struct Pairs {
  std::vector<glm::vec3> starts;
  std::vector<BeamLight> lights;
  std::vector<LightRay> rays;

  void add(const glm::vec3& start, const BeamLight& light) {
    rays.push_back({uint(starts.size()), uint(lights.size())});
    starts.push_back(start);
    lights.push_back(light);
  }
};

struct Traced {
  std::vector<uint> lit, unsure;
  bool isLit(std::size_t ray) const { return (lit[ray / 32] >> ray % 32 & 1) != 0; }
  bool isUnsure(std::size_t ray) const { return !unsure.empty() && (unsure[ray / 32] >> ray % 32 & 1) != 0; }
};

/// Planes x, y, z of the starts.
std::vector<float> planesOf(const Pairs& pairs) {
  std::vector<float> planes;
  for (int axis = 0; axis < 3; ++axis)
    for (const glm::vec3& start : pairs.starts) planes.push_back(start[axis]);
  return planes;
}

Traced trace(OpenedDevice& device, const std::shared_ptr<const TriangleTree>& tree, const Pairs& pairs,
             const std::shared_ptr<const HoleMasks>& masks = nullptr, const std::string& more_defines = "") {
  BeamScene beams;
  prepareBeams(device, {}, tree, masks, 0, beams);
  const std::vector<float> planes = planesOf(pairs);
  const RawArray<float> starts(planes.begin(), planes.end());
  const RawArray<BeamLight> lights(pairs.lights.begin(), pairs.lights.end());
  const RawArray<LightRay> rays(pairs.rays.begin(), pairs.rays.end());
  RawArray<uint> lit(wordsForRays(rays.size()), 0xdeadbeef), unsure(masks ? lit.size() : 0, 0xdeadbeef);
  const Buffer<uint> lit_buffer = borrowedForOutput(device, lit),
                     unsure_buffer = borrowedForOutput(device, unsure);
  FeatureSet features;
  features.set(Feature::kHoles, masks != nullptr);
  traceLightRays(device, featureDefines(features) + more_defines,
                 {.rays = borrowed(device, rays),
                  .ray_count = rays.size(),
                  .starts = borrowed(device, starts),
                  .start_stride = pairs.starts.size(),
                  .lights = borrowed(device, lights),
                  .beams = beams},
                 lit_buffer, unsure_buffer);
  download(device, lit_buffer, lit);
  if (masks) download(device, unsure_buffer, unsure);
  return {{lit.begin(), lit.end()}, {unsure.begin(), unsure.end()}};
}

std::shared_ptr<const TriangleTree> sharedTree(const std::vector<Triangle>& triangles) {
  return std::make_shared<const TriangleTree>(buildTriangleTree(looseScene(triangles), glm::dvec3(0)));
}

/// Traces the pairs with every number of lanes. Returns the number of those that are blocked.
std::size_t expectTheHosts(const std::shared_ptr<const TriangleTree>& tree, const Pairs& pairs,
                           const std::string& more_defines = "") {
  std::vector<bool> blocked;
  for (const LightRay& ray : pairs.rays)
    blocked.push_back(isBlocked(*tree, pairs.starts[ray.point], pairs.lights[ray.light], neverAsked));
  for (const int lanes : widths()) {
    const Traced traced = trace(deviceWithLanes(lanes), tree, pairs, nullptr, more_defines);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < pairs.rays.size(); ++i) wrong += traced.isLit(i) == blocked[i];
    EXPECT_EQ(wrong, 0u) << lanes << " lanes, " << pairs.rays.size() << " pairs";
  }
  return std::size_t(std::count(blocked.begin(), blocked.end(), true));
}

TEST(LightRays, OnAGridOfIntegersTheyMeetCornersEdgesAndPlanes) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> place(-4, 4);
  const auto vector = [&] { return glm::vec3(place(random), place(random), place(random)); };
  std::size_t blocked = 0, all = 0;
  for (int round = 0; round < 40; ++round) {
    std::vector<Triangle> triangles;
    for (int i = 0; i < 1 + 3 * round; ++i) {
      const glm::vec3 middle = 2.0f * vector();
      const auto near = [&] { return middle + glm::trunc(vector() / 2.0f); };
      triangles.push_back({near(), near(), near()});
    }
    Pairs pairs;
    for (int i = 0; i < 200; ++i) {
      glm::vec3 start = vector(), light = vector(), way = light;
      if (i % 2 == 0) {  // through a corner
        const glm::vec3 corner = triangles[std::size_t(i) % triangles.size()][i % 3];
        way = vector() + 2.0f * vector();
        start = corner - float(1 + i % 5) * way;
        light = corner + float(1 + i % 7) * way;
      }
      pairs.add(start, pointAt(light));
      if (way != glm::vec3(0)) pairs.add(start, towards(way));
      pairs.add(start, pointAt(start));
    }
    blocked += expectTheHosts(sharedTree(triangles), pairs);
    all += pairs.rays.size();
  }
  EXPECT_GT(blocked, all / 5);
  EXPECT_LT(blocked, all * 3 / 4);
}

/// Triangles and walls along the axes, which are boxes without a thickness.
std::vector<Triangle> soupWithWalls(float reach) {
  std::vector<Triangle> triangles = randomTriangles(3000, 0.05f, 3);
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 100; ++i)
      for (glm::vec3& corner : triangles[200 * std::size_t(axis) + std::size_t(i)])
        corner[axis] = 0.125f * float(axis);
  for (Triangle& triangle : triangles)
    for (glm::vec3& corner : triangle) corner *= reach;
  return triangles;
}

/// Pairs in groups of 16 that start and end near each other, and others. Some lie in the walls, along axes,
/// and some end or start at corners, on edges or in triangles.
Pairs pairsAmid(const std::vector<Triangle>& triangles, float reach, int groups) {
  RandomVectors vector(2);
  Pairs pairs;
  const auto onTriangle = [&](std::size_t i, int kind) {
    const auto& [a, b, c] = triangles[i % triangles.size()];
    return kind == 0 ? a : kind == 1 ? 0.5f * a + 0.5f * b : 0.25f * a + 0.25f * b + 0.5f * c;
  };
  for (int group = 0; group < groups; ++group) {
    const glm::vec3 start = vector(), light = vector();
    const float start_size = group % 4 == 0 ? 1.0f : 0.02f, light_size = group % 3 == 0 ? 0.0f : 0.05f;
    for (int i = 0; i < 16; ++i) {
      glm::vec3 s = reach * (start + start_size * vector()), l = reach * (light + light_size * vector());
      const int axis = group / 5 % 3;
      if (group % 5 == 0) s[axis] = l[axis] = reach * 0.125f * float(axis);
      if (group % 10 == 5) {  // a way that is shorter than floats can tell, through a wall at 0
        s[0] = reach * 1e-14f;
        l[0] = -s[0];
      }
      if (group % 7 == 0) l[group % 2] = s[group % 2];
      if (group % 11 == 0) l *= 1e3f;
      const std::size_t of = std::size_t(group * 16 + i);
      if (group % 13 == 0) l = onTriangle(of, i % 3);
      if (group % 13 == 1) s = onTriangle(of, i % 3);
      if (group % 13 == 2) s += 1e-6f * (l - onTriangle(of, i % 3));
      if (group % 13 == 3) l = s + (onTriangle(of, i % 3) - s) * 2.0f;
      if (group % 17 == 0 && i % 4 == 0) l = s;
      const glm::vec3 way = l - s;
      const bool parallel = group % 6 == 1 || (group % 6 == 2 && i % 2 == 0);
      if (parallel && glm::length(way / reach) > 0)
        pairs.add(s, towards(glm::normalize(way / reach)));
      else
        pairs.add(s, pointAt(l));
    }
  }
  return pairs;
}

TEST(LightRays, AmidTrianglesAndWallsOfEveryScale) {
  for (const float reach : {1.0f, 1e-18f, 1e11f}) {
    const std::vector<Triangle> triangles = soupWithWalls(reach);
    const Pairs pairs = pairsAmid(triangles, reach, 400);
    const std::size_t blocked = expectTheHosts(sharedTree(triangles), pairs);
    EXPECT_GT(blocked, pairs.rays.size() / 4) << reach;
    EXPECT_LT(blocked, pairs.rays.size() * 9 / 10) << reach;
  }
}

TEST(LightRays, AmidTrianglesOfAllSizesFromAFewUlpsOn) {
  RandomVectors vector(4);
  std::vector<Triangle> triangles = randomTriangles(50, 1, 11);
  Pairs pairs;
  for (const glm::vec3& centre : {glm::vec3(0), glm::vec3(0.5f, 0.6f, 0.7f)})
    for (float size = 0.1f; size > (centre.x > 0 ? 1e-7f : 1e-15f); size *= 0.3f)
      for (int i = 0; i < 40; ++i) {
        const glm::vec3 middle = centre + 3 * size * vector();
        const Triangle triangle{middle + size * vector(), middle + size * vector(), middle + size * vector()};
        if (i % 2 == 0) triangles.push_back(triangle);
        const glm::vec3 start = centre + (i % 4 == 0 ? 30 : 6) * size * vector();
        const glm::vec3 at = i % 3 == 0   ? triangle[0]
                             : i % 3 == 1 ? 0.5f * triangle[0] + 0.5f * triangle[1]
                                          : 0.3f * triangle[0] + 0.3f * triangle[1] + 0.4f * triangle[2];
        pairs.add(start, pointAt(start + 2.0f * (at - start)));
        pairs.add(start, pointAt(start + 1e3f * (at - start)));
        pairs.add(start, pointAt(at));
        pairs.add(start, towards(glm::normalize((at - start) / size)));
      }
  const std::size_t blocked = expectTheHosts(sharedTree(triangles), pairs);
  EXPECT_GT(blocked, pairs.rays.size() / 4);
  EXPECT_LT(blocked, pairs.rays.size() * 9 / 10);
}

TEST(LightRays, WhateverADeviceLeavesOpen) {
  const std::vector<Triangle> triangles = soupWithWalls(1);
  const Pairs pairs = pairsAmid(triangles, 1, 150);
  for (const char* defines : {" -DNO_DOUBLES", " -DOWN_QUOTIENTS", " -DSTANDARD_ONLY"})
    EXPECT_GT(expectTheHosts(sharedTree(triangles), pairs, defines), 0u) << defines;
}

TEST(LightRays, CornersBehindAStartBehindThePlaneDoNotBlock) {
  // As in exact_ray_test.cpp: triangles so small that rounding turns them.
  Scene scene = looseScene(randomTriangles(500, 1e-3f, 7));
  scene.objects[0].object_to_world[3] = {50, 60, 70, 1};
  const auto tree = std::make_shared<const TriangleTree>(buildTriangleTree(scene, glm::dvec3(0)));
  Pairs pairs;
  for (std::size_t i = 0; i < tree->triangles.size(); ++i) {
    const std::size_t block = i / kTreeWidth, slot = i % kTreeWidth;
    if ((tree->block_bits[block] >> slot & 1) == 0) continue;
    const auto at = [&](int row) {
      return double(tree->blocks[(block * kBlockRows + std::size_t(row)) * kTreeWidth + slot]);
    };
    const auto vector = [&](int row) { return glm::dvec3(at(row), at(row + 1), at(row + 2)); };
    const glm::dvec3 a = vector(0), b = vector(3), c = vector(6), normal = vector(kPlaneRows);
    const glm::dvec3 turned = glm::cross(b - a, c - a), axis = glm::cross(turned, normal);
    if (glm::length(axis) == 0) continue;
    const glm::dvec3 between =
        glm::normalize(glm::cross(axis, glm::normalize(turned) + glm::normalize(normal)));
    for (const double side : {1.0, -1.0}) {
      const glm::vec3 start = (a + b + c) / 3.0 + 20 * side * between,
                      beyond = glm::dvec3(start) + 5 * side * between;
      pairs.add(start, pointAt(beyond));
      pairs.add(start, towards(side * between));
      pairs.add(start, pointAt(glm::dvec3(start) - 40 * side * between));
    }
  }
  expectTheHosts(tree, pairs);
}

TEST(LightRays, NeitherOrderNorNumberChangesABit) {
  const std::vector<Triangle> triangles = soupWithWalls(1);
  const auto tree = sharedTree(triangles);
  Pairs pairs = pairsAmid(triangles, 1, 100);
  OpenedDevice& device = deviceWithLanes(8);
  const Traced all = trace(device, tree, pairs);
  std::vector<bool> lit;
  for (std::size_t i = 0; i < pairs.rays.size(); ++i) lit.push_back(all.isLit(i));
  std::vector<LightRay> rays = pairs.rays;
  std::shuffle(rays.begin(), rays.end(), std::mt19937(5));
  for (const std::size_t count : {1u, 15u, 16u, 17u, 31u, 32u, 33u, 255u, 256u, 257u, 1500u}) {
    pairs.rays.assign(rays.begin(), rays.begin() + std::ptrdiff_t(count));
    const Traced traced = trace(device, tree, pairs);
    for (std::size_t i = 0; i < 32 * traced.lit.size(); ++i)
      ASSERT_EQ(traced.isLit(i), i < count && lit[rays[i].point]) << i << " of " << count;
  }
}

/// Noise in alpha, in blocks of 4 × 4 texels.
Texture noise(std::mt19937& random) {
  constexpr int kSide = 16;
  MipLevel level{kSide, kSide, {}};
  std::array<std::uint16_t, kSide * kSide / 16> blocks;
  for (std::uint16_t& block : blocks) block = std::uint16_t(random() & 0xffff);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      for (int channel = 0; channel < 4; ++channel)
        level.texels.push_back(channel < 3 ? 65535 : blocks[std::size_t(y / 4 * 4 + x / 4)]);
  Texture texture;
  texture.levels = {level};
  texture.alpha_varies = true;
  return texture;
}

TEST(LightRays, ThroughHolesMasksDecideNearlyAllAndTexturesTheRest) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> place(-2, 2);
  const std::vector<Triangle> triangles = randomTriangles(400, 0.4f, 9);
  Scene scene = looseScene(triangles, 1);
  scene.textures = {noise(random)};
  scene.materials[1].diffuse_map.texture = 0;
  Mesh& mesh = scene.meshes[0];
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) mesh.uvs.push_back({place(random), place(random)});
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 5) mesh.triangle_materials[i] = 0;
  const auto tree = std::make_shared<const TriangleTree>(buildTriangleTree(scene, glm::dvec3(0)));
  const auto masks = std::make_shared<const HoleMasks>(makeHoleMasks(scene, *tree));
  const std::vector<PlacedObject> objects = placeObjects(scene, allObjects(scene), glm::dmat4(1));
  std::size_t asked = 0;
  const HoleTest is_hole = [&](std::uint32_t triangle, const glm::dvec3& weights) {
    ++asked;
    return isHoleAt(scene, objectOfTriangle(objects, triangle), triangle, weights);
  };
  const Pairs pairs = pairsAmid(triangles, 1, 400);
  std::vector<bool> blocked;
  for (const LightRay& ray : pairs.rays)
    blocked.push_back(isBlocked(*tree, pairs.starts[ray.point], pairs.lights[ray.light], is_hole));
  ASSERT_GT(asked, pairs.rays.size());
  const std::size_t all_blocked = std::size_t(std::count(blocked.begin(), blocked.end(), true));
  EXPECT_GT(all_blocked, pairs.rays.size() / 4);
  EXPECT_LT(all_blocked, pairs.rays.size() * 9 / 10);
  BeamScene host;
  host.tree = tree;
  const std::vector<float> starts = planesOf(pairs);
  for (const int lanes : widths()) {
    Traced traced = trace(deviceWithLanes(lanes), tree, pairs, masks);
    std::size_t wrong = 0, unsure = 0, both = 0;
    for (std::size_t i = 0; i < pairs.rays.size(); ++i) {
      unsure += traced.isUnsure(i);
      both += traced.isUnsure(i) && traced.isLit(i);
      wrong += !traced.isUnsure(i) && traced.isLit(i) == blocked[i];
    }
    EXPECT_EQ(wrong, 0u) << lanes;
    EXPECT_EQ(both, 0u) << lanes;
    EXPECT_GT(unsure, 0u) << lanes;
    EXPECT_LT(unsure, pairs.rays.size() / 10) << lanes;
    EXPECT_EQ(settleRays(host, pairs.rays, starts, pairs.lights, is_hole, traced.unsure, traced.lit), unsure);
    for (std::size_t i = 0; i < pairs.rays.size(); ++i) wrong += traced.isLit(i) == blocked[i];
    EXPECT_EQ(wrong, 0u) << lanes;
  }
}

TEST(LightRays, StartWhereBeamsDo) {
  for (const bool lifted : {false, true}) {
    Random random(3);
    Camera camera;
    camera.camera_to_world = glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(0.1, 0.5, 0.9));
    GBuffer gbuffer = randomGBuffer(camera, 40, 20, 0.8, random);
    if (lifted)
      for (std::size_t i = 0; i < gbuffer.pixels(); ++i)
        gbuffer.lift.push_back(float(random.between(0, 0.1)));
    for (const int lanes : widths()) {
      OpenedDevice& device = deviceWithLanes(lanes);
      auto tree = std::make_shared<TriangleTree>(*sharedTree(randomTriangles(5, 0.5f, 1)));
      tree->scale = 0.25f;
      BeamScene beams;
      prepareBeams(device, camera, tree, nullptr, 0, beams);
      RawArray<float> starts(3 * gbuffer.pixels());
      const Buffer<float> buffer = borrowedForOutput(device, starts);
      FeatureSet features;
      features.set(Feature::kLift, lifted);
      rayStarts(device, featureDefines(features),
                {.plane_stride = gbuffer.pixels(),
                 .position = borrowed(device, gbuffer.position),
                 .normal = borrowed(device, gbuffer.normal),
                 .lift = borrowed(device, gbuffer.lift),
                 .beams = beams},
                buffer);
      download(device, buffer, starts);
      for (std::size_t place = 0; place < gbuffer.pixels(); ++place) {
        if (!std::isfinite(gbuffer.position[place + 2 * gbuffer.pixels()])) continue;
        const glm::vec3 truth = startInTree(beams, gbuffer, place);
        for (int axis = 0; axis < 3; ++axis)
          ASSERT_EQ(starts[place + std::size_t(axis) * gbuffer.pixels()], truth[axis]) << lanes;
      }
    }
  }
}

TEST(LightRays, InAnEmptySceneAllIsLit) {
  Pairs pairs;
  for (int i = 0; i < 100; ++i) pairs.add(glm::vec3(i), pointAt(glm::vec3(1, 2, i)));
  EXPECT_EQ(expectTheHosts(sharedTree({}), pairs), 0u);
}

}  // namespace
}  // namespace luciole::test
