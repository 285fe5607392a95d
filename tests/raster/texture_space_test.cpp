// G-buffers in texture space.
#include "raster/texture_space.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "luciole/error.hpp"
#include "raster/raster_scenes.hpp"
#include "scene/tangents.hpp"

namespace luciole::test {
namespace {

constexpr PlaneSet kAll{
    .specular = true, .ambient = true, .emission = true, .unbent_normal = true, .lift = true, .model = true};

/// A bumpy sheet from −1 to 1 that faces +z, of random normals and colours, with a diffuse map and a normal
/// map, all laid out as one sees it.
Scene sheet() {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-1, 1);
  constexpr std::uint32_t kCells = 6;
  std::vector<glm::vec3> positions;
  for (std::uint32_t y = 0; y <= kCells; ++y)
    for (std::uint32_t x = 0; x <= kCells; ++x)
      positions.emplace_back(2.0f * float(x) / kCells - 1, 2.0f * float(y) / kCells - 1,
                             0.1f * number(random));
  Scene scene = meshScene(positions, gridTriangles(kCells));
  Mesh& mesh = scene.meshes[0];
  for (std::size_t i = 0; i < positions.size(); ++i) {
    mesh.normals[i] = glm::normalize(glm::vec3(0.3f * number(random), 0.3f * number(random), 1));
    mesh.uvs.emplace_back((positions[i].x + 1) / 2, (1 - positions[i].y) / 2);
    mesh.colors.emplace_back(number(random) + 1, number(random) + 1, number(random) + 1, 1);
  }
  Texture normals = randomChain({16, 16}, random);
  normals.kind = TextureKind::kNormals;
  // Bent normals are then no shorter than 1 before they are normalized.
  for (MipLevel& level : normals.levels)
    for (std::size_t i = 2; i < level.texels.size(); i += 4) level.texels[i] = 65535;
  scene.textures = {randomChain({32, 32}, random), normals};
  scene.materials[0].diffuse_map.texture = 0;
  scene.materials[0].normal_map.texture = 1;
  scene.materials[0].specular = {0.1f, 0.2f, 0.3f};
  addTangents(scene);
  return scene;
}

/// A parallel camera that sees the sheet as its map is.
Camera above() {
  Camera camera;
  camera.orthographic = true;
  camera.camera_to_world[3] = {0, 0, 2, 1};
  return camera;
}

/// How much two groups differ where both show something, at most.
double difference(const Plane& a, const Plane& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::isfinite(a[i]) && std::isfinite(b[i])) most = std::max(most, std::abs(double(a[i]) - b[i]));
  return most;
}

// A camera that looks at a sheet as its map lies sees the same. Coordinates are floats, and so is the map's
// copy of the mesh: places are off by three roundings of 1, 3 · 2⁻²⁴, and coordinates by half of that. A
// map's values change by 1 within a texel, along two axes: its colours by 32 · 2 · 1.5 · 2⁻²⁴, which
// vertices' colours double, its slopes, which are twice the values, by 2 · 16 · 2 · 1.5 · 2⁻²⁴.
TEST(TextureSpace, HasWhatACameraSeesThatLooksAtTheMap) {
  const Scene scene = sheet();
  constexpr glm::ivec2 kSize(50, 50);
  const GBuffer seen = rasterize(scene, allObjects(scene), cameraView(above(), kSize), Shading::kPhong, kAll);
  const TextureSpace map = rasterizeTextureSpace(scene, 0, kSize, above(), kAll);
  EXPECT_EQ(map.covered, std::size_t(kSize.x) * kSize.y);
  EXPECT_EQ(map.overlapping, 0u);
  constexpr double kError = 2 * 32 * 2 * 1.5 * 0x1p-24;
  EXPECT_LE(difference(seen.position, map.gbuffer.position), kError);
  EXPECT_LE(difference(seen.normal, map.gbuffer.normal), kError);
  EXPECT_LE(difference(seen.diffuse, map.gbuffer.diffuse), kError);
  EXPECT_LE(difference(seen.specular, map.gbuffer.specular), 0);
  EXPECT_LE(difference(seen.lift, map.gbuffer.lift), kError);
  EXPECT_GT(*std::max_element(map.gbuffer.lift.begin(), map.gbuffer.lift.end()), 1e-4f);
  EXPECT_FALSE(map.gbuffer.knows_camera);
}

TEST(TextureSpace, ShowsFrontsWhicheverWayAChartIsWound) {
  Scene scene = sheet();
  scene.materials[0].normal_map.texture = -1;
  const TextureSpace upright = rasterizeTextureSpace(scene, 0, {24, 24}, above(), kAll);
  for (glm::vec2& uv : scene.meshes[0].uvs) uv.x = 1 - uv.x;
  const TextureSpace mirrored = rasterizeTextureSpace(scene, 0, {24, 24}, above(), kAll);
  const GBuffer &a = upright.gbuffer, &b = mirrored.gbuffer;
  const std::size_t n = a.pixels();
  for (int x = 0; x < 24; ++x)
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(a.position[a.index(x, 7) + c * n], b.position[b.index(23 - x, 7) + c * n], 1e-5);
      EXPECT_NEAR(a.normal[a.index(x, 7) + c * n], b.normal[b.index(23 - x, 7) + c * n], 1e-5);
    }
}

TEST(TextureSpace, TexelsThatAChartCoversInPartShowTheNearestPlaceOfIt) {
  Scene scene = rectangleScene(1, 1, 0, doubleSided());
  Mesh& mesh = scene.meshes[0];
  // A chart from 1.75 to 6.25 texels of 8: of texel 6 a quarter, not the middle.
  mesh.uvs.clear();
  for (const glm::vec3& position : mesh.positions)
    mesh.uvs.emplace_back((4 + 2.25f * position.x) / 8, (4 - 2.25f * position.y) / 8);
  const TextureSpace map = rasterizeTextureSpace(scene, 0, {8, 8}, above(), {});
  EXPECT_EQ(map.covered, 16u);
  const GBuffer& gbuffer = map.gbuffer;
  EXPECT_NEAR(gbuffer.position[gbuffer.index(6, 3)], 1, 1e-6) << "its right edge";
  EXPECT_NEAR(gbuffer.position[gbuffer.index(5, 3)], 1.5 / 2.25, 1e-6);
  EXPECT_FALSE(std::isfinite(gbuffer.position[gbuffer.index(0, 3) + 2 * gbuffer.pixels()]));
}

TEST(TextureSpace, CountsTexelsOfSeveralTriangles) {
  Scene scene = rectangleScene(1, 1, 0, doubleSided());
  Mesh& mesh = scene.meshes[0];
  mesh.uvs.clear();
  for (const glm::vec3& position : mesh.positions)
    mesh.uvs.emplace_back((position.x + 1) / 2, (position.y + 1) / 2);
  EXPECT_EQ(rasterizeTextureSpace(scene, 0, {8, 8}, above(), {}).overlapping, 0u);
  mesh.triangles.push_back(mesh.triangles[0]);
  mesh.triangle_materials.push_back(0);
  const TextureSpace map = rasterizeTextureSpace(scene, 0, {8, 8}, above(), {});
  EXPECT_EQ(map.covered, 64u);
  EXPECT_NEAR(double(map.overlapping), 32, 4) << "half of the square, and its diagonal";
}

TEST(TextureSpace, TakesTheSecondCoordinatesAndSuchOfAnotherSquare) {
  Scene scene = sheet();
  scene.meshes[0].lightmap_uvs = scene.meshes[0].uvs;
  for (glm::vec2& uv : scene.meshes[0].uvs) uv *= 7.0f;
  const std::vector<glm::vec2> expected = scene.meshes[0].lightmap_uvs;
  EXPECT_EQ(lightMapUvs(scene, scene.meshes[0]), expected);
  for (glm::vec2& uv : scene.meshes[0].lightmap_uvs) uv += glm::vec2(-3, 1);
  const std::vector<glm::vec2> moved = lightMapUvs(scene, scene.meshes[0]);
  for (std::size_t i = 0; i < moved.size(); ++i) EXPECT_LE(glm::distance(moved[i], expected[i]), 1e-6f);
}

TEST(TextureSpace, RefusesCoordinatesThatAreNotThereOrLeaveASquare) {
  Scene scene = sheet();
  scene.meshes[0].uvs[3].x = 1.5f;
  EXPECT_THAT([&] { lightMapUvs(scene, scene.meshes[0]); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("fit into a square")));
  scene.meshes[0].uvs.clear();
  EXPECT_THAT([&] { lightMapUvs(scene, scene.meshes[0]); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("has no texture coordinates")));
}

}  // namespace
}  // namespace luciole::test
