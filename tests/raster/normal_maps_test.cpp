// Normals that maps bend, in G-buffers and pictures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "gbuffer/packed_normal.hpp"
#include "image/make_normals.hpp"
#include "raster/raster_scenes.hpp"
#include "scene/tangents.hpp"

namespace luciole::test {
namespace {

/// A normal map of one texel.
Texture mapOf(const glm::vec3& normal) {
  Texture texture;
  texture.levels = {{1, 1, {}}};
  for (int c = 0; c < 3; ++c)
    texture.levels[0].texels.push_back(std::uint16_t((normal[c] * 0.5f + 0.5f) * 65535.0f + 0.5f));
  texture.levels[0].texels.push_back(65535);
  makeNormals(TextureKind::kNormals, texture);
  return texture;
}

/// A wall that faces the camera, with an upright picture.
Scene wall(const glm::vec3& normal) {
  Scene scene = rectangleScene(10, 10, -2, doubleSided());
  for (std::size_t i = 0; i < scene.meshes[0].uvs.size(); ++i)
    scene.meshes[0].uvs[i] = {scene.meshes[0].positions[i].x, -scene.meshes[0].positions[i].y};
  scene.textures = {mapOf(normal)};
  scene.materials[0].normal_map.texture = 0;
  addTangents(scene);
  return scene;
}

GBuffer drawn(const Scene& scene) {
  return rasterize(scene, allObjects(scene), cameraView(frontCamera(), {20, 20}), Shading::kPhong,
                   {.unbent_normal = true, .lift = true});
}

/// A number of the map is off by 2.3 · 2⁻¹⁶ (see MakeNormals), thrice.
constexpr double kError = 4 * 2.3 * 0x1p-16;

void expectNormal(const Scene& scene, const glm::dvec3& expected) {
  const GBuffer gbuffer = drawn(scene);
  const std::size_t n = gbuffer.pixels(), at = gbuffer.index(7, 11);
  const glm::dvec3 normal(gbuffer.normal[at], gbuffer.normal[at + n], gbuffer.normal[at + 2 * n]);
  EXPECT_LE(glm::distance(normal, glm::normalize(expected)), kError)
      << normal.x << " " << normal.y << " " << normal.z;
  EXPECT_LE(glm::distance(unpackNormal(gbuffer.unbent_normal[at]), glm::dvec3(0, 0, 1)), 1e-4);
}

TEST(NormalMaps, RedIsRightGreenIsUpAndBlueIsOut) {
  expectNormal(wall({0.48f, 0, 0.8f}), {0.48, 0, 0.8});
  expectNormal(wall({0, 0.6f, 0.8f}), {0, 0.6, 0.8});
}

TEST(NormalMaps, ScaleMultipliesSlopes) {
  Scene scene = wall({0.3f, -0.4f, 0.8f});
  scene.materials[0].normal_scale = 2;
  expectNormal(scene, {0.6, -0.8, 0.8});
  scene.materials[0].normal_scale = 0;
  expectNormal(scene, {0, 0, 1});
}

TEST(NormalMaps, MirroredObjectsAreMirroredWithTheirMaps) {
  Scene scene = wall({0.6f, 0, 0.8f});
  scene.objects[0].object_to_world = glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1));
  expectNormal(scene, {-0.6, 0, 0.8});
  scene = wall({0, 0.6f, 0.8f});
  scene.objects[0].object_to_world = glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1));
  expectNormal(scene, {0, 0.6, 0.8});
}

TEST(NormalMaps, ABackShowsTheFrontsNormalTurnedRound) {
  // Seen from behind, through a turn about y by 180 degrees: the map's right is now left.
  Scene scene = wall({0.6f, 0, 0.8f});
  scene.objects[0].object_to_world = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -4)) *
                                     glm::rotate(glm::dmat4(1), std::acos(-1.0), glm::dvec3(0, 1, 0));
  expectNormal(scene, {0.6, 0, 0.8});
}

TEST(NormalMaps, WithoutTangentsOrDirectionNormalsStay) {
  expectNormal(wall({0, 0, -1}), {0, 0, 1});
  Scene scene = wall({0.6f, 0, 0.8f});
  for (glm::vec4& tangent : scene.meshes[0].tangents) tangent = glm::vec4(0);
  expectNormal(scene, {0, 0, 1});
  for (glm::vec4& tangent : scene.meshes[0].tangents) tangent = {0, 0, 1, 1};  // along the normal
  expectNormal(scene, {0, 0, 1});
  scene.meshes[0].tangents.clear();
  expectNormal(scene, {0, 0, 1});
}

TEST(NormalMaps, FlatShadingLeavesThemOut) {
  const Scene scene = wall({0.6f, 0, 0.8f});
  const GBuffer gbuffer =
      rasterize(scene, allObjects(scene), cameraView(frontCamera(), {20, 20}), Shading::kFlat, {});
  EXPECT_EQ(gbuffer.normal[gbuffer.index(7, 11)], 0.0f);
  EXPECT_TRUE(gbuffer.geometric_normal.empty() && gbuffer.unbent_normal.empty());
}

TEST(NormalMaps, NormalsAreUnitAndFiniteWhateverAPictureHolds) {
  std::mt19937 random(3);
  for (int i = 0; i < 8; ++i) {
    Scene scene = wall({0, 0, 1});
    scene.textures[0] = randomChain({16 << i % 2, 8}, random);
    scene.materials[0].normal_scale = i % 3 == 0 ? 1000.0f : -0.5f;
    const GBuffer gbuffer = drawn(scene);
    const std::size_t n = gbuffer.pixels();
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x) {
        const std::size_t at = gbuffer.index(x, y);
        const glm::dvec3 normal(gbuffer.normal[at], gbuffer.normal[at + n], gbuffer.normal[at + 2 * n]);
        EXPECT_NEAR(glm::length(normal), 1, 3 * kFloatRounding * 2);
        EXPECT_GE(normal.z, -1e-6);
      }
  }
}

}  // namespace
}  // namespace luciole::test
