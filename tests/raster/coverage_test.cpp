#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

/// A fan of triangles around a point; the picture's middle is the origin and a pixel a unit.
Scene fanScene(glm::vec2 center, float radius, int blades) {
  std::vector<glm::vec3> positions{{center, -1.0f}};
  std::vector<glm::uvec3> triangles;
  for (int i = 0; i < blades; ++i) {
    const float angle = float(2.0 * M_PI * i / blades);
    positions.push_back({center + radius * glm::vec2(std::cos(angle), std::sin(angle)), -1.0f});
    triangles.push_back({0, 1 + i, 1 + (i + 1) % blades});
  }
  return meshScene(positions, triangles);
}

void expectFanCoversOnce(glm::vec2 center, int blades) {
  const View view = pixelView({48, 48});
  const float radius = 20.0f;
  const std::vector<int> counts = coverageCounts(fanScene(center, radius, blades), view);
  const double inside = radius * std::cos(M_PI / blades) - kEdgeShift;
  const double outside = radius + kEdgeShift;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      const double distance = glm::length(glm::dvec2(x - 23.5, 23.5 - y) - glm::dvec2(center));
      const int count = counts[y * 48 + x];
      EXPECT_LE(count, 1) << x << ',' << y;
      if (distance < inside) {
        EXPECT_EQ(count, 1) << x << ',' << y;
      }
      if (distance > outside) {
        EXPECT_EQ(count, 0) << x << ',' << y;
      }
    }
}

TEST(Coverage, FansCoverEveryPixelOnceWhereverTheirMiddleLies) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> offset(-1.0f, 1.0f);
  for (int i = 0; i < 40; ++i) expectFanCoversOnce({offset(random), offset(random)}, 3 + i % 14);
}

TEST(Coverage, EdgesAndCornersThroughSamplesBelongToOneTriangle) {
  // Blades of 45 degrees around a sample run through samples all along.
  for (const glm::vec2& center : {glm::vec2(0.5f, 0.5f), glm::vec2(0.0f, 0.0f), glm::vec2(0.5f, 0.0f)})
    for (const int blades : {4, 8}) expectFanCoversOnce(center, blades);
}

TEST(Coverage, AMeshThatFillsThePictureCoversEveryPixelOnce) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> jitter(-0.3f, 0.3f);
  for (const glm::ivec2& size : {glm::ivec2(144, 17), glm::ivec2(31, 64)}) {
    constexpr int kCells = 9;
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (int y = 0; y <= kCells; ++y)
      for (int x = 0; x <= kCells; ++x)
        positions.push_back({(x - 0.5f * kCells + jitter(random)) * 1.5f, y - 0.5f * kCells + jitter(random),
                             -8.0f + jitter(random) * 3.0f});
    for (std::uint32_t y = 0; y < kCells; ++y)
      for (std::uint32_t x = 0; x < kCells; ++x) {
        const std::uint32_t a = y * (kCells + 1) + x;
        const std::uint32_t b = a + kCells + 1;
        triangles.push_back({a, a + 1, b + 1});
        triangles.push_back({a, b + 1, b});
      }
    Camera camera = frontCamera();
    camera.fov_y = 0.4;
    if (size.x > 4 * size.y) camera.fov_y = 0.1;
    for (const int count : coverageCounts(meshScene(positions, triangles), cameraView(camera, size)))
      ASSERT_EQ(count, 1);
  }
}

TEST(Coverage, TrianglesSmallerThanAPixelCoverEverySampleOnce) {
  // Cells of 0.77 pixels; 30 of them are 23 pixels wide, and the picture 20.
  constexpr int kCells = 30;
  std::vector<glm::vec3> positions;
  for (int y = 0; y <= kCells; ++y)
    for (int x = 0; x <= kCells; ++x)
      positions.push_back({0.77f * (x - 0.5f * kCells), 0.77f * (y - 0.5f * kCells), -1.0f});
  const Scene scene = meshScene(positions, gridTriangles(kCells));
  for (const int count : coverageCounts(scene, pixelView({20, 20}))) ASSERT_EQ(count, 1);
  RasterCounts counts;
  draw(scene, pixelView({20, 20}), Shading::kPhong, {}, &counts);
  // Every sample lies in one triangle, so at most 400 of them cover any.
  EXPECT_EQ(counts.submitted, 1800u);
  EXPECT_EQ(counts.back_facing, 0u);
  EXPECT_GE(counts.outside, 1400u);
  EXPECT_LT(counts.outside, 1800u);
}

/// Compares a triangle's coverage in a pixelView with its three edges, but for pixels that the edges touch.
void expectCoversTriangle(const std::array<glm::dvec2, 3>& corners, glm::ivec2 size) {
  std::vector<glm::vec3> positions;
  for (const glm::dvec2& corner : corners) positions.push_back({glm::vec2(corner), -1.0f});
  const GBuffer gbuffer = draw(meshScene(positions, {{0, 1, 2}}), pixelView(size));
  std::size_t inside_count = 0;
  std::size_t outside_count = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec2 p(x + 0.5 - 0.5 * size.x, 0.5 * size.y - y - 0.5);
      double nearest = 1e300;  // signed distance to the edges, > 0 inside
      for (int i = 0; i < 3; ++i) {
        const glm::dvec2 a(positions[i]);
        const glm::dvec2 edge = glm::dvec2(positions[(i + 1) % 3]) - a;
        nearest = std::min(nearest, (edge.x * (p.y - a.y) - edge.y * (p.x - a.x)) / glm::length(edge));
      }
      if (std::abs(nearest) < kEdgeShift) continue;
      ASSERT_EQ(isCovered(gbuffer, x, y), nearest > 0.0) << x << ',' << y;
      ++(nearest > 0.0 ? inside_count : outside_count);
    }
  EXPECT_GT(inside_count, 0u);
  EXPECT_GT(outside_count, 0u);
}

TEST(Coverage, AMillionPixels) {
  expectCoversTriangle({glm::dvec2(-700.3, -690.2), {712.9, -702.7}, {-650.1, 705.8}}, {1440, 1440});
}

TEST(Coverage, CornersAMillionPixelsAway) {
  expectCoversTriangle({glm::dvec2(-1e6, -1e6 - 20), {1e6, 1e6}, {-1e6, 3e6}}, {300, 200});
  expectCoversTriangle({glm::dvec2(10.3, 5.2), {1e6, -3e5}, {1e6, 4e5}}, {300, 200});
  expectCoversTriangle({glm::dvec2(-2e6, 10.25), {2e6, 10.25}, {0.0, 1e6}}, {300, 200});
}

TEST(Coverage, ASampleOffsetMovesThePicture) {
  // A triangle moved by (dx, −dy) pixels, seen by samples moved by (dx, dy), covers the same pixels.
  const std::vector<glm::vec3> positions{{-11.3f, -7.9f, -1.0f}, {12.6f, -9.4f, -1.0f}, {2.1f, 13.7f, -1.0f}};
  View view = pixelView({32, 32});
  const GBuffer centered = draw(meshScene(positions, {{0, 1, 2}}), view);
  std::vector<glm::vec3> moved = positions;
  for (glm::vec3& p : moved) p += glm::vec3(0.25f, 0.375f, 0.0f);
  view.sample = {0.75, 0.125};
  const GBuffer shifted = draw(meshScene(moved, {{0, 1, 2}}), view);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) EXPECT_EQ(isCovered(centered, x, y), isCovered(shifted, x, y));
  EXPECT_TRUE(isCovered(centered, 16, 16));
  EXPECT_EQ(positionAt(shifted, 16, 16).x, positionAt(centered, 16, 16).x + 0.25f);
}

TEST(Coverage, DegenerateTrianglesCoverNothingAndHarmNobody) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const float big = std::numeric_limits<float>::max();
  const std::vector<glm::vec3> positions{{-9, -9, -2}, {9, -9, -2},     {0, 9, -2},   {nan, 0, -1},
                                         {inf, 0, -1}, {0, 0, -inf},    {-5, -5, -1}, {5, 5, -1},
                                         {0, 0, -1},   {big, big, -big}};
  const Scene scene = meshScene(
      positions, {{0, 1, 3}, {0, 1, 4}, {0, 1, 5}, {6, 7, 8}, {6, 6, 7}, {6, 6, 6}, {9, 9, 0}, {0, 1, 2}});
  Camera camera = frontCamera();
  const View perspective = cameraView(camera, {20, 20});
  for (const View& view : {pixelView({20, 20}), perspective}) {
    RasterCounts counts;
    const GBuffer gbuffer = draw(scene, view, Shading::kPhong, {}, &counts);
    EXPECT_EQ(counts.outside, 7u);
    const GBuffer alone = draw(meshScene({positions[0], positions[1], positions[2]}, {{0, 1, 2}}), view);
    EXPECT_EQ(gbuffer.position, alone.position);
    EXPECT_TRUE(isCovered(gbuffer, 10, 10));
  }
}

TEST(Coverage, SliversStayInsideTheirTriangles) {
  // Steep in depth and thinner than the grid of corners: a plane continued beyond the edge would leave far
  // behind.
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-20.0f, 20.0f);
  std::uniform_real_distribution<float> thin(-0.01f, 0.01f);
  std::size_t covered = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 a(place(random), place(random), -30.0f);
    const glm::vec3 b(place(random), place(random), -40.0f);
    const glm::vec3 c = 0.5f * (a + b) + glm::vec3(thin(random), thin(random), -900.0f);
    const Scene scene = meshScene({a, b, c}, {{0, 1, 2}});
    const View view = pixelView({40, 40});
    const GBuffer gbuffer = draw(scene, view);
    const auto depth = [&](const glm::vec3& p) { return float((view.projection * glm::dvec4(p, 1.0)).z); };
    const float low_depth = std::min({depth(a), depth(b), depth(c)});
    const float high_depth = std::max({depth(a), depth(b), depth(c)});
    for (const ShadowTexel& texel : depthOf(scene, view)) {
      if (texel.depth == 0.0f) continue;
      ASSERT_GE(texel.depth, low_depth);
      ASSERT_LE(texel.depth, high_depth);
    }
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        if (!isCovered(gbuffer, x, y)) continue;
        ++covered;
        const glm::vec3 p = positionAt(gbuffer, x, y);
        // A weighted mean of the corners in double, stored as float.
        const glm::vec3 slack(float(kFloatRounding) * 1000.0f);
        const glm::vec3 low = glm::min(glm::min(a, b), c) - slack;
        const glm::vec3 high = glm::max(glm::max(a, b), c) + slack;
        ASSERT_TRUE(glm::all(glm::lessThanEqual(low, p)) && glm::all(glm::lessThanEqual(p, high)));
      }
  }
  EXPECT_GT(covered, 10u);
}

/// A picture-filling rectangle twice at the same place, in material 0 and then 1. The material `masked` has a
/// hole in the left half, to be cut out by the alpha of its map; diffuse red is 0.25 of the first material
/// and 0.75 of the second.
Scene twiceTheSame(std::uint32_t masked) {
  Scene scene = rectangleScene(10.0f, 10.0f, -1.0f);
  scene.materials.push_back(scene.materials[0]);
  scene.materials[0].diffuse.r = 0.25f;
  scene.materials[1].diffuse.r = 0.75f;
  Texture texture;
  texture.levels.push_back({2, 1, {65535, 65535, 65535, 0, 65535, 65535, 65535, 65535}});
  texture.alpha_varies = true;
  scene.textures.push_back(texture);
  scene.materials[masked].alpha_map = {0, Wrap::kClampToEdge, Wrap::kClampToEdge};
  scene.materials[masked].alpha_cutoff = 0.5f;
  Mesh& mesh = scene.meshes[0];
  mesh.triangles.insert(mesh.triangles.end(), {mesh.triangles[0], mesh.triangles[1]});
  mesh.triangle_materials = {0, 0, 1, 1};
  return scene;
}

TEST(Coverage, AtEqualDepthTheFirstTriangleWinsWithHolesOrWithout) {
  for (const std::uint32_t masked : {0u, 1u}) {
    const GBuffer gbuffer = draw(twiceTheSame(masked), pixelView({20, 20}));
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x) {
        const bool hole = masked == 0 && x < 10;
        ASSERT_EQ(valueAt(gbuffer.diffuse, gbuffer, x, y).r, hole ? 0.75f : 0.25f) << x << ',' << y;
      }
  }
}

TEST(Coverage, NothingIsSeenOnTheFarPlaneWithHolesOrWithout) {
  Camera camera = frontCamera();
  camera.orthographic = true;
  camera.half_height = 10.0;
  camera.near = 1.0;
  camera.far = 2.0;
  Scene scene = twiceTheSame(0);
  for (glm::vec3& position : scene.meshes[0].positions) position.z = -2.0f;
  const GBuffer gbuffer = draw(scene, cameraView(camera, {20, 20}));
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) ASSERT_FALSE(isCovered(gbuffer, x, y)) << x << ',' << y;
}

}  // namespace
}  // namespace luciole::test
