#include "shade/shade_tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "kernels/shared.h"
#include "lighting/light_gbuffer.hpp"
#include "scene/models.hpp"

namespace luciole::test {
namespace {

struct LitTiles {
  Plane color;
  TileCounts counts;
};

LitTiles litByTiles(OpenedDevice& device, const Lighting& lighting, const GBuffer& gbuffer, TileBlock block) {
  ShadeFrame frame = lighting.lights.frame;
  frame.plane_stride = uint(gbuffer.pixels());
  frame.texel_count = 1;
  const GBufferBuffers buffers = borrowedGBuffer(device, gbuffer, {}, {}, {}, {}, lighting.unlit);
  LitTiles lit;
  lit.color.assign(3 * gbuffer.pixels(), -1.0f);
  const Buffer<float> image = borrowedForOutput(device, lit.color);
  lit.counts = shadeTiles(device, {featureDefines(lighting.features) + lighting.math_defines, {}},
                          {.frame = frame,
                           .gbuffer = buffers,
                           .tiles_x = gbuffer.tiles_x,
                           .tiles_y = gbuffer.tiles_y,
                           .block = block,
                           .lights = lighting.lights.light_buffer,
                           .luminaires = lighting.lights.luminaire_buffer,
                           .tree = lighting.lights.tree_buffer,
                           .tree_stride = lighting.lights.tree.stride,
                           .image = image});
  download(device, image, lit.color);
  return lit;
}

/// By bits, so that −0 is not 0. Those of every block, and of lists. What is counted doesn't depend on
/// blocks.
void expectBitsOfLists(OpenedDevice& device, const Scene& scene, const GBuffer& gbuffer, Model model) {
  const ShadeSettings settings{.model = model};
  const FeatureSet features =
      neededFeatures(scene, gbuffer.camera, {.specular = true, .emission = true}, settings);
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, gbuffer.camera, View{}, features, settings, lighting, stats);
  const LitPlanes by_lists = lightGBuffer(device, scene, lighting,
                                          {lighting.lights, features, gbuffer, {.list_length = true}}, stats);
  ASSERT_TRUE(lighting.lists.tiles > 0) << "whoever asks for the length of lists gets lists";
  const TileCounts counts = litByTiles(device, lighting, gbuffer, {4, 4}).counts;
  // A light in reach of a tile lights no more than its pixels.
  EXPECT_LE(counts.pairs, counts.entries * kTilePixels);
  for (const TileBlock block :
       {TileBlock{4, 4}, TileBlock{16, 1}, TileBlock{2, 2}, TileBlock{1, 1}, TileBlock{3, 5}}) {
    const LitTiles by_tiles = litByTiles(device, lighting, gbuffer, block);
    ASSERT_EQ(
        std::memcmp(by_tiles.color.data(), by_lists.color.data(), by_lists.color.size() * sizeof(float)), 0)
        << "blocks of " << block.width << "x" << block.height << ", " << scene.lights.size() << " lights";
    EXPECT_EQ(by_tiles.counts.entries, counts.entries);
    EXPECT_EQ(by_tiles.counts.pairs, counts.pairs);
  }
}

class ShadeTiles : public testing::TestWithParam<int> {};

TEST_P(ShadeTiles, GiveTheBitsOfListsForEveryModelFogAndKindOfLight) {
  OpenedDevice& device = deviceWithLanes(GetParam());
  Random random(5);
  int round = 0;
  for (const glm::ivec2& size : {glm::ivec2(130, 71), glm::ivec2(400, 9)}) {
    for (const int lights : {17, 300}) {
      Camera camera = randomCamera(random);
      camera.orthographic = round % 3 == 1;
      camera.half_height = 10;
      Scene scene = randomScene(camera, lights, random);
      scene.fog = randomFog(static_cast<FogMode>(round % 4), random);
      // Without it facing decides, too.
      if (round % 2 == 0)
        for (Light& light : scene.lights) light.ambient = {};
      const GBuffer gbuffer = randomGBuffer(camera, size.x, size.y, 0.4, random);
      ASSERT_NO_FATAL_FAILURE(
          expectBitsOfLists(device, scene, gbuffer, kAllModels[round % std::size(kAllModels)]))
          << "round " << round;
      ++round;
    }
  }
}

/// Squares of so many pixels a side at a depth of 2 m and of 200 m in turns, all facing the camera.
GBuffer gappedGBuffer(const Camera& camera, int side, int square) {
  Random random(2);
  GBuffer gbuffer = randomGBuffer(camera, side, side, 0, random);
  const std::size_t n = gbuffer.pixels();
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const std::size_t place = gbuffer.index(x, y);
      const float depth = (x / square + y / square) % 2 == 0 ? 2.0f : 200.0f;
      gbuffer.position[place] = depth * (float(x) / float(side) - 0.5f);
      gbuffer.position[place + n] = depth * (0.5f - float(y) / float(side));
      gbuffer.position[place + 2 * n] = -depth;
      for (int c = 0; c < 3; ++c) gbuffer.normal[place + c * n] = c == 2 ? 1.0f : 0.0f;
    }
  return gbuffer;
}

/// Lights between the depths of gappedGBuffer(), which reach none of its pixels.
Scene lightsInGap() {
  Random random(3);
  Scene scene;
  for (int i = 0; i < 500; ++i) {
    Light light;
    light.position = {random.between(-20, 20), random.between(-20, 20), random.between(-150, -30)};
    light.range = 10;
    scene.lights.push_back(light);
  }
  return scene;
}

TEST_P(ShadeTiles, FindNoLightInTheGapBetweenNearAndFarSurfaces) {
  OpenedDevice& device = deviceWithLanes(GetParam());
  const Camera camera;
  const GBuffer gbuffer = gappedGBuffer(camera, 64, 8);
  Scene scene = lightsInGap();
  const FeatureSet features = neededFeatures(scene, camera, {.specular = true, .emission = true}, {});
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, camera, View{}, features, {}, lighting, stats);
  const TileCounts in_gap = litByTiles(device, lighting, gbuffer, {4, 4}).counts;
  EXPECT_EQ(in_gap.entries, 0u);
  EXPECT_EQ(in_gap.pairs, 0u);
  // One of them moves to a far square, in front of which it lights nothing of another.
  scene.lights[7].position = {200 * (12.0 / 64 - 0.5), 200 * (0.5 - 20.0 / 64), -199};
  Lighting moved;
  prepareLighting(device, scene, camera, View{}, features, {}, moved, stats);
  const TileCounts at_surface = litByTiles(device, moved, gbuffer, {4, 4}).counts;
  EXPECT_EQ(at_surface.entries, 1u);
  EXPECT_GT(at_surface.pairs, 0u);
  EXPECT_LE(at_surface.pairs, 64u);
  expectBitsOfLists(device, scene, gbuffer, Model::kPhong);
}

// No box around such a group of pixels is without the gap: its very pixels decide.
TEST_P(ShadeTiles, FindNoLightInAGapBetweenNeighbouringPixels) {
  OpenedDevice& device = deviceWithLanes(GetParam());
  const Camera camera;
  const GBuffer gbuffer = gappedGBuffer(camera, 64, 1);
  const Scene scene = lightsInGap();
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, camera, View{},
                  neededFeatures(scene, camera, {.specular = true, .emission = true}, {}), {}, lighting,
                  stats);
  for (const TileBlock block : {TileBlock{4, 4}, TileBlock{1, 1}}) {
    const TileCounts in_gap = litByTiles(device, lighting, gbuffer, block).counts;
    EXPECT_EQ(in_gap.entries, 0u);
    EXPECT_EQ(in_gap.pairs, 0u);
  }
  lightGBuffer(device, scene, lighting, {lighting.lights, lighting.features, gbuffer, {.list_length = true}},
               stats);
  EXPECT_GT(lighting.lists.tiles, 0u);
  EXPECT_EQ(lighting.lists.entries, 0u);
}

// Whether a surface faces a directional light doesn't depend on where it is: in a parallel view it may face
// away from the eye.
TEST_P(ShadeTiles, FindDirectionalLightsWhereSurfacesFaceAwayFromTheEye) {
  Camera camera;
  camera.orthographic = true;
  camera.half_height = 20;
  Random random(6);
  GBuffer gbuffer = randomGBuffer(camera, 40, 40, 0, random);
  const std::size_t n = gbuffer.pixels();
  const glm::vec3 normal(0.8f, 0, 0.6f);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x)
      for (int c = 0; c < 3; ++c) {
        const std::size_t place = gbuffer.index(x, y);
        gbuffer.position[place + c * n] = (c == 0 ? 15.0f : c == 1 ? 0.0f : -5.0f) + 0.01f * float(x - y);
        gbuffer.normal[place + c * n] = normal[c];
      }
  Scene scene = lightsInGap();
  scene.lights[7].position = {15, 0, -4};
  scene.lights[8].kind = LightKind::kDirectional;
  scene.lights[8].direction = -glm::normalize(glm::dvec3(normal));
  expectBitsOfLists(deviceWithLanes(GetParam()), scene, gbuffer, Model::kPhong);
}

// Each pixel meets more lights than are found at once, and more than a block of a sum takes.
TEST_P(ShadeTiles, GiveTheBitsOfListsForAHundredThousandLights) {
  OpenedDevice& device = deviceWithLanes(GetParam());
  const Camera camera;
  Random random(4);
  GBuffer gbuffer = gappedGBuffer(camera, 40, 8);
  Scene scene;
  for (int i = 0; i < 100000; ++i) {
    Light light;
    const double depth = random.chance(0.5) ? 1.5 : random.between(150, 210);
    light.position = {depth * random.between(-1, 1), depth * random.between(-1, 1), -depth};
    light.diffuse = light.specular = 0.01 * random.color();
    light.range = float(0.02 * depth * random.between(0.5, 8));
    scene.lights.push_back(light);
  }
  expectBitsOfLists(device, scene, gbuffer, Model::kPhong);
}

INSTANTIATE_TEST_SUITE_P(Lanes, ShadeTiles, testing::ValuesIn(widths()), testing::PrintToStringParamName());

TEST(ShadeTiles, BlocksAreAsLargeAsThereAreEnoughOf) {
  for (const std::size_t threads : {1, 2, 64}) {
    for (const glm::ivec2& tiles : {glm::ivec2(1, 1), {1000, 1}, {1, 1000}, {120, 68}, {1250, 1250}}) {
      const TileBlock block = chooseBlock(tiles.x, tiles.y, threads);
      EXPECT_LE(block.width * block.height, kBlockTiles);
      EXPECT_TRUE(tiles.y > 1 || block.height == 1) << "a row of tiles is cut into pieces of a row";
      EXPECT_TRUE(tiles.x > 1 || block.width == 1) << "and a column into pieces of a column";
      const auto blocks = [tiles](int width, int height) {
        return std::size_t((tiles.x + width - 1) / width) * std::size_t((tiles.y + height - 1) / height);
      };
      EXPECT_TRUE(block.width * block.height == 1 || blocks(block.width, block.height) >= 64 * threads);
    }
  }
  EXPECT_EQ(chooseBlock(1250, 1250, 64).width, 4);
}

}  // namespace
}  // namespace luciole::test
