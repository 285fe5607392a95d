#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <random>
#include <utility>

#include "kernels/shared.h"
#include "raster/raster_scenes.hpp"
#include "scene/tangents.hpp"

namespace luciole::test {
namespace {

/// Something of everything: textures with holes, vertex colours, triangles of all sizes, some behind the
/// camera.
Scene busyScene() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (int i = 0; i < 900; ++i) {
    const glm::vec3 center = 5.0f * vector() + glm::vec3(0, 0, -5);
    const float radius = i % 10 == 0 ? 20.0f : 0.7f;
    const std::uint32_t first = std::uint32_t(positions.size());
    for (int k = 0; k < 3; ++k) positions.push_back(center + radius * vector());
    triangles.push_back({first, first + 1, first + 2});
  }
  Scene scene = meshScene(positions, triangles);
  Mesh& mesh = scene.meshes[0];
  for (glm::vec3& normal : mesh.normals) normal = glm::normalize(vector());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    mesh.colors.push_back({0.5f + 0.5f * vector(), 0.9f});
    mesh.uvs.push_back(4.0f * glm::vec2(unit(random), unit(random)));
  }
  Texture texture;
  texture.alpha_varies = true;
  for (int size = 8; size >= 1; size /= 2) {
    MipLevel level{size, size, {}};
    for (int i = 0; i < 4 * size * size; ++i) level.texels.push_back(std::uint16_t(random()));
    texture.levels.push_back(level);
  }
  scene.textures.push_back(texture);
  scene.materials[0].diffuse_map.texture = 0;
  scene.materials[0].emission = glm::vec3(0.5f);
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].alpha_cutoff = 0.4f;
  scene.materials.push_back(scene.materials[1]);
  scene.materials[2].blended = true;
  for (std::size_t i = 0; i < mesh.triangle_materials.size(); i += 2)
    mesh.triangle_materials[i] = 1 + i / 2 % 2;
  addAllTangents(scene);
  return scene;
}

constexpr PlaneSet kAll{.specular = true,
                        .ambient = true,
                        .emission = true,
                        .geometric_normal = true,
                        .lift = true,
                        .tangent = true,
                        .uv = true,
                        .object = true,
                        .material = true};

TEST(Invariance, ACropIsACutOutBitForBit) {
  const Scene scene = busyScene();
  View view = cameraView(frontCamera(), {211, 167});
  view.sample = {0.3, 0.8};
  const GBuffer whole = draw(scene, view, Shading::kPhong, kAll);
  const std::vector<ShadowTexel> whole_depth = depthOf(scene, view);
  for (const glm::ivec4& crop : {glm::ivec4(0, 0, 211, 167),
                                 {17, 23, 100, 90},
                                 {64, 64, 64, 64},
                                 {63, 1, 2, 166},
                                 {210, 166, 1, 1},
                                 {130, 0, 81, 33}}) {
    view.crop_origin = {crop.x, crop.y};
    view.crop_size = {crop.z, crop.w};
    const GBuffer part = draw(scene, view, Shading::kPhong, kAll);
    const std::vector<ShadowTexel> part_depth = depthOf(scene, view);
    ASSERT_EQ(glm::ivec2(part.width, part.height), view.crop_size);
    EXPECT_EQ(part.picture_size, view.size);
    EXPECT_EQ(part.crop_origin, view.crop_origin);
    for (int y = 0; y < crop.w; ++y)
      for (int x = 0; x < crop.z; ++x) {
        const std::size_t i = part.index(x, y);
        const std::size_t j = whole.index(x + crop.x, y + crop.y);
        const auto expect_same = [&](const Plane& a, const Plane& b, int components) {
          for (int k = 0; k < components; ++k)
            ASSERT_EQ(a[k * part.pixels() + i], b[k * whole.pixels() + j]) << x << ',' << y;
        };
        expect_same(part.position, whole.position, 3);
        expect_same(part.normal, whole.normal, 3);
        expect_same(part.diffuse, whole.diffuse, 3);
        expect_same(part.specular, whole.specular, 4);
        expect_same(part.ambient, whole.ambient, 3);
        expect_same(part.emission, whole.emission, 3);
        ASSERT_EQ(part.geometric_normal[i], whole.geometric_normal[j]);
        ASSERT_EQ(part.lift[i], whole.lift[j]);
        expect_same(part.uv, whole.uv, 2);
        ASSERT_EQ(part.tangent[i], whole.tangent[j]);
        ASSERT_EQ(part.object[i], whole.object[j]);
        ASSERT_EQ(part.material[i], whole.material[j]);
        ASSERT_TRUE(sameTexel(part_depth[std::size_t(y) * crop.z + x],
                              whole_depth[std::size_t(y + crop.y) * 211 + x + crop.x]))
            << x << ',' << y;
      }
  }
}

TEST(Invariance, TheNumberOfThreadsChangesNothing) {
  const Scene scene = busyScene();
  const View view = cameraView(frontCamera(), {211, 167});
  const auto with_threads = [&](std::size_t threads) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    RasterCounts counts;
    GBuffer gbuffer = draw(scene, view, Shading::kPhong, kAll, &counts);
    return std::tuple(gbuffer, depthOf(scene, view), counts.outside);
  };
  const auto [one, one_depth, one_outside] = with_threads(1);
  for (const std::size_t threads : {2, 5}) {
    const auto [many, many_depth, many_outside] = with_threads(threads);
    EXPECT_EQ(one.position, many.position);
    EXPECT_EQ(one.normal, many.normal);
    EXPECT_EQ(one.diffuse, many.diffuse);
    EXPECT_EQ(one.specular, many.specular);
    EXPECT_EQ(one.ambient, many.ambient);
    EXPECT_EQ(one.emission, many.emission);
    EXPECT_EQ(one.geometric_normal, many.geometric_normal);
    EXPECT_EQ(one.lift, many.lift);
    EXPECT_EQ(one.tangent, many.tangent);
    EXPECT_EQ(one.uv, many.uv);
    EXPECT_EQ(one.object, many.object);
    EXPECT_EQ(one.material, many.material);
    EXPECT_TRUE(std::ranges::equal(one_depth, many_depth, sameTexel));
    EXPECT_EQ(one_outside, many_outside);
  }
}

TEST(Invariance, TheMemoryOfAUsedGBufferLeavesNothingInTheNextOne) {
  const Scene busy = busyScene(), sparse = rectangleScene(1.0f, 1.0f, -5.0f);
  for (const glm::ivec2& size : {glm::ivec2(211, 167), {100, 90}, {260, 300}}) {
    for (const PlaneSet& planes : {kAll, PlaneSet{}}) {
      GBuffer used = draw(busy, cameraView(frontCamera(), {211, 167}), Shading::kPhong, kAll);
      const View view = cameraView(frontCamera(), size);
      const GBuffer fresh = draw(sparse, view, Shading::kPhong, planes);
      const GBuffer next =
          rasterize(sparse, allObjects(sparse), view, Shading::kPhong, planes, {}, nullptr, std::move(used));
      EXPECT_EQ(next.width, fresh.width);
      EXPECT_EQ(next.height, fresh.height);
      EXPECT_EQ(next.position, fresh.position);
      EXPECT_EQ(next.normal, fresh.normal);
      EXPECT_EQ(next.diffuse, fresh.diffuse);
      EXPECT_EQ(next.specular, fresh.specular);
      EXPECT_EQ(next.ambient, fresh.ambient);
      EXPECT_EQ(next.emission, fresh.emission);
      EXPECT_EQ(next.geometric_normal, fresh.geometric_normal);
      EXPECT_EQ(next.lift, fresh.lift);
      EXPECT_EQ(next.tangent, fresh.tangent);
      EXPECT_EQ(next.uv, fresh.uv);
      EXPECT_EQ(next.object, fresh.object);
      EXPECT_EQ(next.material, fresh.material);
    }
  }
}

TEST(Invariance, OddSizesAreFilledAndTheirPaddingShowsNothing) {
  const Scene scene = rectangleScene(100.0f, 100.0f, -5.0f);
  for (const glm::ivec2& size : {glm::ivec2(1, 1), {7, 93}, {144, 17}, {16, 16}, {65, 64}}) {
    const GBuffer gbuffer = draw(scene, cameraView(frontCamera(), size), Shading::kPhong, kAll);
    EXPECT_EQ(gbuffer.tiles_x, (size.x + 15) / 16);
    EXPECT_EQ(gbuffer.tiles_y, (size.y + 15) / 16);
    EXPECT_EQ(gbuffer.position.size(), 3 * gbuffer.pixels());
    EXPECT_EQ(gbuffer.specular.size(), 4 * gbuffer.pixels());
    for (int y = 0; y < gbuffer.tiles_y * kTileSize; ++y)
      for (int x = 0; x < gbuffer.tiles_x * kTileSize; ++x) {
        const glm::vec3 position = positionAt(gbuffer, x, y);
        if (x < size.x && y < size.y) {
          ASSERT_EQ(position.z, -5.0f);
        } else {
          ASSERT_EQ(position, glm::vec3(0.0f, 0.0f, -std::numeric_limits<float>::infinity()));
          ASSERT_EQ(valueAt(gbuffer.normal, gbuffer, x, y), glm::vec3(0.0f));
          ASSERT_EQ(valueAt(gbuffer.diffuse, gbuffer, x, y), glm::vec3(0.0f));
        }
      }
  }
}

TEST(Invariance, PlanesNobodyAsksForAreEmpty) {
  const GBuffer gbuffer = draw(rectangleScene(1, 1, -2), cameraView(frontCamera(), {20, 20}));
  EXPECT_TRUE(gbuffer.specular.empty());
  EXPECT_TRUE(gbuffer.ambient.empty());
  EXPECT_TRUE(gbuffer.emission.empty());
  EXPECT_TRUE(gbuffer.geometric_normal.empty() && gbuffer.unbent_normal.empty());
  EXPECT_TRUE(gbuffer.lift.empty());
}

TEST(Invariance, AnEmptySceneShowsNothing) {
  Scene scene;
  const GBuffer gbuffer = draw(scene, cameraView(frontCamera(), {20, 20}));
  EXPECT_FALSE(isCovered(gbuffer, 10, 10));
  scene = meshScene({}, {});
  RasterCounts counts;
  EXPECT_FALSE(
      isCovered(draw(scene, cameraView(frontCamera(), {20, 20}), Shading::kPhong, {}, &counts), 10, 10));
  EXPECT_EQ(counts.submitted, 0u);
}

}  // namespace
}  // namespace luciole::test
