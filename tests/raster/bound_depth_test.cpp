#include "raster/bound_depth.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

std::vector<BoundTexel> bounds(const Scene& scene, const View& view, std::span<const float> farthest = {}) {
  const Meshlets meshlets = findMeshlets(scene);
  std::vector<BoundTexel> texels(std::size_t(view.crop_size.x) * view.crop_size.y, {7, 7, 7, 7});
  rasterizeBounds(scene, meshlets, allMeshlets(meshlets), view, farthest, texels);
  return texels;
}

double errorOf(const BoundTexel& texel) {
  return kPlaneError * (std::abs(texel.depth) + std::abs(texel.step_x) + std::abs(texel.step_y));
}

/// The plane at a place of the texel, in texels from its centre.
double planeAt(const BoundTexel& texel, double dx, double dy) {
  return double(texel.depth) + double(texel.step_x) * dx + double(texel.step_y) * dy;
}

using Corners = std::array<glm::dvec3, 3>;
Corners cornersOf(const Mesh& mesh, const glm::uvec3& triangle) {
  return {glm::dvec3(mesh.positions[triangle.x]), glm::dvec3(mesh.positions[triangle.y]),
          glm::dvec3(mesh.positions[triangle.z])};
}

/// A place on the picture, texels from its top left corner, and reversed depth; nothing behind the eye.
std::optional<glm::dvec3> project(const glm::dvec3& p, const View& view) {
  const glm::dvec4 clip = view.projection * view.world_to_view * glm::dvec4(p, 1.0);
  if (clip.w <= 0.0) return std::nullopt;
  return glm::dvec3((0.5 + 0.5 * clip.x / clip.w) * view.size.x, (0.5 - 0.5 * clip.y / clip.w) * view.size.y,
                    clip.z / clip.w);
}

/// A point of a triangle is either not nearer than `others`, or not nearer than the plane.
void expectPointsAreBounded(const Scene& scene, const View& view, const std::vector<BoundTexel>& texels,
                            int points, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const Mesh& mesh = scene.meshes[0];
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners c = cornersOf(mesh, mesh.triangles[i]);
    for (int k = 0; k < points; ++k) {
      double s = unit(random), t = unit(random);
      if (s + t > 1) s = 1 - s, t = 1 - t;
      if (k < 3) s = k == 1, t = k == 2;  // the corners too
      const auto p = project(c[0] + s * (c[1] - c[0]) + t * (c[2] - c[0]), view);
      if (!p || p->x < 0 || p->y < 0 || p->x >= view.size.x || p->y >= view.size.y || p->z < 0) continue;
      const glm::ivec2 at(glm::floor(glm::dvec2(*p)));
      // Within half of the growth the neighbours must know of it as well.
      for (int y = std::max(at.y - 1, 0); y <= std::min(at.y + 1, view.size.y - 1); ++y)
        for (int x = std::max(at.x - 1, 0); x <= std::min(at.x + 1, view.size.x - 1); ++x) {
          const double dx = p->x - x - 0.5, dy = p->y - y - 0.5;
          if (std::max(std::abs(dx), std::abs(dy)) > 0.5 + 0.5 * kBoundGrowth) continue;
          const BoundTexel& texel = texels[std::size_t(y) * view.size.x + x];
          if (p->z <= texel.others) continue;
          // Twice 2⁻²⁴ and 2⁻⁵⁰ for p's own rounding: of places by 2⁻⁴⁰ texels.
          ASSERT_LE(p->z, planeAt(texel, dx, dy) + errorOf(texel) * (1 + 0x1p-10))
              << "triangle " << i << " in texel " << x << ',' << y;
        }
    }
  }
}

/// Every plane is that of a solid triangle that covers the texel's grown square.
int expectPlanesAreOfCoveringTriangles(const Scene& scene, const Camera& camera, const View& view,
                                       const std::vector<BoundTexel>& texels) {
  const Mesh& mesh = scene.meshes[0];
  constexpr double kReach = 0.5 + 0.99 * kBoundGrowth;
  int planes = 0;
  for (int y = 0; y < view.size.y; ++y)
    for (int x = 0; x < view.size.x; ++x) {
      const BoundTexel& texel = texels[std::size_t(y) * view.size.x + x];
      if (texel.depth == -std::numeric_limits<float>::infinity()) {
        EXPECT_EQ(texel.step_x, 0);
        EXPECT_EQ(texel.step_y, 0);
        continue;
      }
      ++planes;
      bool found = false;
      for (std::size_t i = 0; i < mesh.triangles.size() && !found; ++i) {
        if (scene.materials[mesh.triangle_materials[i]].alpha_cutoff > 0) continue;
        const Corners c = cornersOf(mesh, mesh.triangles[i]);
        bool same = true;
        for (const double dx : {-kReach, kReach})
          for (const double dy : {-kReach, kReach}) {
            if (!same) continue;
            const Ray ray = pixelRay(camera, view.size, x + 0.5 + dx, y + 0.5 + dy);
            const auto hit = intersect(ray, c[0], c[1], c[2]);
            const auto p = hit ? project(ray.origin + hit->t * ray.direction, view) : std::nullopt;
            same = p && std::abs(p->z - planeAt(texel, dx, dy)) <= errorOf(texel) * (1 + 0x1p-10);
          }
        found = same;
      }
      EXPECT_TRUE(found) << x << ',' << y;
    }
  return planes;
}

/// Triangles of all sizes in front of a camera at the origin, and some that reach behind it.
Scene soup(unsigned seed, int count, bool behind) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  const auto any = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const auto first = std::uint32_t(positions.size());
    positions.insert(positions.end(), {a, b, c});
    triangles.push_back({first, first + 1, first + 2});
  };
  for (int i = 0; i < count; ++i) {
    const glm::vec3 middle = glm::vec3(0, 0, -6) + any() * glm::vec3(4, 4, 4);
    const float size = 4.0f * std::exp2(-12.0f * std::abs(unit(random)));
    const glm::vec3 a = middle + any() * size, b = middle + any() * size, c = middle + any() * size;
    switch (i % 6) {
      case 0:  // sliver
        add(a, b, glm::mix(a, b, 0.3f) + any() * size * 1e-4f);
        break;
      case 1:  // no area at all
        add(a, b, i % 4 ? a : b);
        break;
      case 2:  // edge on: in a plane through the eye
        add(a, b, glm::mix(a, b, 0.7f) * 1.25f);
        break;
      case 3:  // two in a plane
        add(a, b, c);
        add(a, c, a + (c - b));
        break;
      default:
        add(a, b, c);
    }
    if (behind && i % 10 == 0) add(a, b, -c);
  }
  for (int i = 0; i < 6; ++i) {
    const glm::vec3 middle(0, 0, -9.5f);
    add(middle + any() * 9.0f, middle + any() * 9.0f, middle + any() * 9.0f);
  }
  Scene scene = meshScene(positions, triangles);
  scene.materials.push_back(doubleSided());
  scene.materials.back().alpha_cutoff = 0.5f;
  for (std::size_t i = 0; i < triangles.size(); i += 7) scene.meshes[0].triangle_materials[i] = 1;
  return scene;
}

Camera soupCamera(bool orthographic) {
  Camera camera = frontCamera();
  camera.orthographic = orthographic;
  camera.half_height = 4;
  camera.near = 0.02;
  camera.far = 40;
  return camera;
}

TEST(BoundDepth, NoPointOfAnyTriangleIsNearerThanBothPlaneAndOthers) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const Scene scene = soup(seed, 40 + 30 * int(seed), seed % 2);
    const View view = cameraView(soupCamera(seed % 3 == 0), {100, 80});
    ASSERT_NO_FATAL_FAILURE(expectPointsAreBounded(scene, view, bounds(scene, view), 3000, seed)) << seed;
  }
}

TEST(BoundDepth, PlanesAreOfSolidTrianglesThatCoverTheTexel) {
  int planes = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Scene scene = soup(seed, 100, seed % 2);
    const Camera camera = soupCamera(seed % 3 == 0);
    const View view = cameraView(camera, {100, 80});
    planes += expectPlanesAreOfCoveringTriangles(scene, camera, view, bounds(scene, view));
  }
  EXPECT_GT(planes, 6 * 1000);
}

TEST(BoundDepth, ATiltedQuadIsCertainInsideItsTriangles) {
  const Scene scene = meshScene({{-3, -3, -4}, {3, -3, -5}, {3, 3, -7}, {-3, 3, -6}}, {{0, 1, 2}, {0, 2, 3}});
  const Camera camera = soupCamera(false);
  const View view = cameraView(camera, {90, 90});
  const std::vector<BoundTexel> texels = bounds(scene, view);
  int inside = 0, certain = 0;
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 90; ++x)
      for (const glm::uvec3& triangle : scene.meshes[0].triangles) {
        const Corners c = cornersOf(scene.meshes[0], triangle);
        bool covers = true;
        for (const double dx : {-0.02, 1.02})
          for (const double dy : {-0.02, 1.02})
            covers = covers && intersect(pixelRay(camera, view.size, x + dx, y + dy), c[0], c[1], c[2]);
        if (!covers) continue;
        ++inside;
        certain += texels[y * 90 + x].depth > 0 && texels[y * 90 + x].others == 0;
      }
  EXPECT_GT(inside, 3000);
  EXPECT_EQ(certain, inside);
}

TEST(BoundDepth, ASecondSurfaceBehindLeavesOthersAtZeroAndOneInFrontTakesThePlane) {
  Scene scene =
      meshScene({{-90, -90, -5}, {90, -90, -5}, {0, 180, -5}, {-90, -90, -4}, {90, -90, -4}, {0, 180, -4}},
                {{0, 1, 2}, {3, 4, 5}});
  const View view = pixelView({70, 20});
  for (const BoundTexel& texel : bounds(scene, view)) {
    const double near = project({0, 0, -4}, view)->z;
    EXPECT_NEAR(texel.depth, near, 0x1p-24 * near);
    EXPECT_EQ(texel.others, 0);
  }
  // In either order.
  std::swap(scene.meshes[0].triangles[0], scene.meshes[0].triangles[1]);
  for (const BoundTexel& texel : bounds(scene, view)) {
    EXPECT_NEAR(texel.depth, project({0, 0, -4}, view)->z, 0x1p-24);
    EXPECT_EQ(texel.others, 0);
  }
  std::swap(scene.meshes[0].triangles[0], scene.meshes[0].triangles[1]);
  // With holes it stays in front, but covers nothing.
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].alpha_cutoff = 0.5f;
  scene.meshes[0].triangle_materials[1] = 1;
  for (const BoundTexel& texel : bounds(scene, view)) {
    EXPECT_NEAR(texel.depth, project({0, 0, -5}, view)->z, 0x1p-24);
    EXPECT_GE(texel.others, project({0, 0, -4}, view)->z);
    EXPECT_NEAR(texel.others, project({0, 0, -4}, view)->z, 0x1p-23);
  }
}

TEST(BoundDepth, OthersIsNoHigherThanASurfaceReachesInTheGrownTexel) {
  Scene scene = meshScene({{-9, -8, -4}, {9, -8, -5}, {0, 15, -12}}, {{0, 1, 2}});
  const View view = cameraView(soupCamera(false), {70, 70});
  const std::vector<BoundTexel> planes = bounds(scene, view);
  scene.materials[0].alpha_cutoff = 0.5f;
  const std::vector<BoundTexel> masked = bounds(scene, view);
  int compared = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].depth < 0) continue;
    ++compared;
    const double reach = 0.5 + kBoundGrowth;
    const double highest =
        planes[i].depth + reach * (std::abs(planes[i].step_x) + std::abs(planes[i].step_y));
    // The plane's error, and a float's rounding upwards.
    EXPECT_NEAR(masked[i].others, highest, errorOf(planes[i]) + 0x1p-23 * highest);
  }
  EXPECT_GT(compared, 3000);
}

TEST(BoundDepth, ATriangleBetweenTheCentresOfTexelsIsSeen) {
  // Around the corner that four texels share, a hundredth of a texel wide; another seen exactly edge on.
  const Scene scene = meshScene({{0.004f, 0, -3},
                                 {-0.004f, 0.004f, -3},
                                 {0, -0.004f, -2},
                                 {5.2f, 5.3f, -1},
                                 {5.2f, 5.3f, -9},
                                 {5.2f, 5.3f, -4}},
                                {{0, 1, 2}, {3, 4, 5}});
  const View view = pixelView({20, 20});
  const std::vector<BoundTexel> texels = bounds(scene, view);
  int seen = 0;
  for (const BoundTexel& texel : texels) seen += texel.others > 0;
  EXPECT_EQ(seen, 5);
  for (const glm::ivec2& at : {glm::ivec2(9, 9), glm::ivec2(10, 9), glm::ivec2(9, 10), glm::ivec2(10, 10)})
    EXPECT_GE(texels[at.y * 20 + at.x].others, project({0, 0, -3}, view)->z);
  EXPECT_GE(texels[4 * 20 + 15].others, project({0, 0, -1}, view)->z);
}

TEST(BoundDepth, AFloorThatReachesBehindTheEyeIsAPlaneWhereItIsSeen) {
  const Scene scene = meshScene({{-60, -1, 30}, {60, -1, 30}, {0, -1, -35}}, {{0, 1, 2}});
  const Camera camera = soupCamera(false);
  const View view = cameraView(camera, {64, 64});
  const std::vector<BoundTexel> texels = bounds(scene, view);
  EXPECT_GT(expectPlanesAreOfCoveringTriangles(scene, camera, view, texels), 1200);
  for (int i = 0; i < 64 * 20; ++i) EXPECT_EQ(texels[i].others, 0) << "above the horizon " << i;
}

TEST(BoundDepth, WhatReachesBehindTheNearPlaneMayBeAnywhereInItsTexels) {
  // Through the whole pyramid, from behind the eye to far ahead, around the axis.
  const Scene through = meshScene({{-0.001f, 0, 1}, {0.001f, 0.0005f, 1}, {0.5f, 0.3f, -9}}, {{0, 1, 2}});
  // Between the eye and the near plane, as wide as a quarter of the picture.
  const Scene close = meshScene({{0, 0, -0.01f}, {0.002f, 0, -0.01f}, {0, 0.002f, -0.01f}}, {{0, 1, 2}});
  const View view = cameraView(soupCamera(false), {64, 64});
  ASSERT_NO_FATAL_FAILURE(expectPointsAreBounded(through, view, bounds(through, view), 20000, 1));
  const std::vector<BoundTexel> texels = bounds(close, view);
  EXPECT_TRUE(std::isinf(texels[31 * 64 + 32].others));
  EXPECT_TRUE(std::isinf(texels[26 * 64 + 34].others));
  EXPECT_EQ(texels[40 * 64 + 20].others, 0);
  for (const BoundTexel& texel : texels) EXPECT_EQ(texel.depth, -std::numeric_limits<float>::infinity());
}

TEST(BoundDepth, ATriangleThroughTheEyeMayBeAnywhere) {
  const Scene scene = meshScene({{-1, -1, -1}, {1, 1, 1}, {0, 1, 0}}, {{0, 1, 2}});
  for (const BoundTexel& texel : bounds(scene, cameraView(soupCamera(false), {8, 8})))
    EXPECT_TRUE(std::isinf(texel.others));
}

TEST(BoundDepth, ACropAndThreadsChangeNothing) {
  const Scene scene = soup(5, 400, true);
  const View view = cameraView(soupCamera(false), {150, 140});
  const std::vector<BoundTexel> whole = bounds(scene, view);
  const auto expectSame = [&](const View& part, const std::vector<BoundTexel>& texels) {
    for (int y = 0; y < part.crop_size.y; ++y)
      ASSERT_EQ(std::memcmp(&texels[std::size_t(y) * part.crop_size.x],
                            &whole[std::size_t(y + part.crop_origin.y) * 150 + part.crop_origin.x],
                            part.crop_size.x * sizeof(BoundTexel)),
                0);
  };
  for (const glm::ivec4& crop :
       {glm::ivec4(0, 0, 1, 1), glm::ivec4(61, 3, 70, 137), glm::ivec4(64, 64, 64, 64)}) {
    View part = view;
    part.crop_origin = {crop.x, crop.y};
    part.crop_size = {crop.z, crop.w};
    expectSame(part, bounds(scene, part));
  }
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  expectSame(view, bounds(scene, view));
}

TEST(BoundDepth, BinsOfInfinityAreLeftAloneAndFartherTrianglesMayBeMissing) {
  const Scene scene = meshScene({{-90, -90, -5}, {90, -90, -5}, {0, 180, -5}}, {{0, 1, 2}});
  const View view = pixelView({130, 60});
  const float depth = float(project({0, 0, -5}, view)->z);
  const std::vector<float> farthest{std::nextafter(depth, 0.0f), std::numeric_limits<float>::infinity(),
                                    1.0f};
  const std::vector<BoundTexel> texels = bounds(scene, view, farthest);
  EXPECT_NEAR(texels[63].depth, depth, 0x1p-24);
  EXPECT_EQ(texels[64].depth, 7);
  EXPECT_EQ(texels[127].others, 7);
  EXPECT_EQ(texels[128].depth, -std::numeric_limits<float>::infinity());
  EXPECT_EQ(texels[128].others, 0);
}

}  // namespace
}  // namespace luciole::test
