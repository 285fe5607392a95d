#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "kernels/shared.h"
#include "luciole/gbuffer_file.hpp"
#include "pictures/shot.hpp"
#include "single_precision.hpp"

namespace luciole::test {
namespace {

TEST(HardTiles, BackgroundAloneNeedsNoLights) {
  // A ball in the middle of a picture, which in each direction is lit by both lights: they give ambient
  // light.
  const glm::ivec2 size(105, 77);
  const Shot shot =
      shoot(R"({"camera": {"eye": [0, 0, 9], "target": [0, 0, 0]}, "background": [0.1, 0.2, 0.3],
    "objects": [{"primitive": "sphere"}],
    "lights": [{"type": "point", "position": [3, 3, 3], "ambient": 0.01}, {"type": "directional", "direction": [0, -1, -1], "ambient": 0.01}]})",
            size);
  const int side = kTileSize, columns = (size.x + side - 1) / side;
  std::vector<bool> shows(std::size_t(columns) * ((size.y + side - 1) / side));
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      if (isCovered(shot.gbuffer, x, y)) shows[std::size_t(y / side) * columns + x / side] = true;
  const auto with_ball = std::size_t(std::count(shows.begin(), shows.end(), true));
  EXPECT_GT(with_ball, 3u);
  EXPECT_LT(with_ball, shows.size() / 2);
  Stats stats;
  const Image image = renderScene(testDevice(), shot.scene, shot.settings, stats);
  EXPECT_EQ(countOf(stats, "list_entries"), 2 * with_ball);
  EXPECT_EQ(countOf(stats, "pixels_lit"), std::uint64_t(coveredPixels(shot.gbuffer)));
  expectAsTheReference(shot);  // background to the bit
  expectCullingChangesNothing(shot);
}

TEST(HardTiles, SurfacesThatCrossTheNearPlane) {
  // A wall from beside the camera to far ahead, cut at 2 m, before a wall across the view at 40 m; a lamp on
  // either side of the cut.
  const glm::ivec2 size(93, 71);
  const double near = 2;
  const Shot shot = shoot(
      fmt::format(
          R"({{"camera": {{"eye": [0, 0, 0], "target": [0, 0, -1], "fov_y": 70, "near": {}, "far": 100}},
    "materials": {{"m": {{"diffuse": 0.8, "double_sided": true}}, "back": {{"diffuse": [0, 0, 1]}}}},
    "objects": [{{"primitive": "plane", "scale": 30, "rotate": [0, 0, 90], "translate": [0.6, 0, 0], "material": "m"}},
                {{"primitive": "plane", "scale": 200, "rotate": [90, 0, 0], "translate": [0, 0, -40], "material": "back"}}],
    "lights": [{{"type": "point", "position": [0, 0, -1.5], "range": 1.5}}, {{"type": "point", "position": [0.2, 0.3, -2.2], "range": 1.2}},
               {{"type": "point", "position": [0, 0, -39], "range": 5}}]}})",
          near),
      size);
  const double reach = std::tan(shot.settings.camera.fov_y / 2), pixel = 2 * reach / size.y;
  int on_wall = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec3 way = pixelRay(shot.settings.camera, size, x + 0.5, y + 0.5).direction;
      // The wall x = 0.6 from 2 m to its end at 15 m: where way.x is from 0.04 to 0.3.
      const double edge = kEdgeShift * pixel;
      const float z = positionAt(shot.gbuffer, x, y).z;
      if (way.x > 0.6 / 15 + edge && way.x < 0.6 / near - edge) {
        // Rounded to a float, and in double before by operations on corners 30 m away.
        ASSERT_NEAR(z, -0.6 / way.x, kUnit * 0.6 / way.x + 1e-12) << x << "," << y;
        ++on_wall;
      } else if (way.x < 0.6 / 15 - edge || way.x > 0.6 / near + edge) {
        ASSERT_NEAR(z, -40, 40 * kUnit + 1e-12) << x << "," << y;
      }
    }
  EXPECT_GT(on_wall, 500);
  expectAsTheReference(shot);
  expectCullingChangesNothing(shot);
}

/// A wall with lamps before it that each reach some tiles, and one with a shadow.
constexpr const char* kWall =
    R"({"camera": {"eye": [0, 0, 4], "target": [0, 0, 0]}, "background": [0.5, 0.25, 0.125], "ambient": 0.1,
  "materials": {"m": {"specular": 0.5, "shininess": 12}},
  "objects": [{"primitive": "plane", "scale": 4, "rotate": [90, 0, 0], "material": "m"}, {"primitive": "sphere", "scale": 0.3, "translate": [-0.5, 0.3, 0.6], "material": "m"}],
  "lights": [{"type": "point", "position": [0.5, 0.5, 1], "range": 1.5}, {"type": "point", "position": [-1, -1, 0.5], "range": 1, "color": [1, 0, 0]},
             {"type": "spot", "position": [-1, 1, 2], "direction": [0.5, -0.5, -1], "cutoff": 40, "shadow": true},
             {"type": "directional", "direction": [0.2, 0.1, -1], "intensity": 0.3, "shadow": true}, {"type": "point", "position": [0, 2, 2], "color": 0.3, "shadow": true}]})";

/// Moves one pixel of the wall to infinity and almost there, through a file, as another program's G-buffer
/// would come.
void moveOnePixelAway(ShadowMethod shadows) {
  const glm::ivec2 size(48, 33), odd(21, 17);
  const Shot shot = shoot(sceneFromJson(kWall), size, [&](RenderSettings& settings) {
    settings.shade.shadows = shadows;
    settings.shade.shadow_limits.size = 128;
  });
  for (const glm::vec3& position : {glm::vec3(0, 0, -kInfinity),
                                    {kInfinity, 0, -5},
                                    {0, -kInfinity, -5},
                                    {std::nanf(""), 0, -5},
                                    {0, 0, -1e8f},
                                    {1e18f, 1e18f, -1e18f},
                                    {1e19f, 0, -1e20f},
                                    {3e38f, -3e38f, -3e38f}}) {
    const TemporaryFolder folder;
    GBuffer gbuffer = shot.gbuffer;
    for (int c = 0; c < 3; ++c)
      gbuffer.position[gbuffer.index(odd.x, odd.y) + c * gbuffer.pixels()] = position[c];
    writeGBuffer(gbuffer, folder / "g.exr", {});
    const GBuffer read = readGBuffer(folder / "g.exr");
    RenderSettings settings = shot.settings;
    settings.shade.culling = Culling::kNone;
    Stats stats;
    const Image all = shadeGBuffer(testDevice(), shot.scene, read, settings, stats);
    settings.shade.culling = Culling::kTiles;
    const Image image = shadeGBuffer(testDevice(), shot.scene, read, settings, stats);
    ASSERT_EQ(image.pixels, all.pixels);
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        if (glm::ivec2(x, y) == odd) continue;
        ASSERT_EQ(colorAt(image, x, y), colorAt(shot.image, x, y)) << x << "," << y;
      }
    const glm::vec3 color = colorAt(image, odd.x, odd.y);
    if (!(std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z))) {
      EXPECT_EQ(color, shot.scene.background);
    } else if (position.z > -1e19f && shadows == ShadowMethod::kOff) {
      // The squared distance is a float still: shaded as well as any.
      for (int c = 0; c < 3; ++c) {
        const Interval bounds =
            shadeInterval(shot.scene, read, read.index(odd.x, odd.y), c, Model::kPhong).widened(2 * kUnit);
        EXPECT_TRUE(color[c] >= bounds.low && color[c] <= bounds.high) << position.x << ": " << color[c];
      }
    }
    // A surface of 0.8 + 0.5 under lights of 1, 1, 1, 0.3 and 0.3 at most, and ambient light.
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(color[c] >= 0 && color[c] <= 1.3 * 3.6 + 0.1) << color[c];
  }
}

TEST(HardTiles, OnePixelFarAwayHarmsNoOther) { moveOnePixelAway(ShadowMethod::kOff); }
TEST(HardTiles, OnePixelFarAwayHarmsNoOtherAmongShadows) { moveOnePixelAway(ShadowMethod::kPcf); }

TEST(HardTiles, NormalsThatAFileHasInAnotherLengthAreMadeUnit) {
  // Culling by the way that surfaces face, and Phong's mirror, count on unit normals.
  const Shot shot = shoot(sceneFromJson(kWall), {48, 33});
  const TemporaryFolder folder;
  GBuffer gbuffer = shot.gbuffer;
  const std::size_t n = gbuffer.pixels();
  constexpr std::array<float, 6> kLengths{1, 1e-20f, 1e-3f, 0.999f, 1e3f, 1e18f};
  for (std::size_t i = 0; i < 3 * n; ++i) gbuffer.normal[i] *= kLengths[i % n % kLengths.size()];
  writeGBuffer(gbuffer, folder / "g.exr", {});
  const GBuffer read = readGBuffer(folder / "g.exr");
  for (int y = 0; y < gbuffer.height; ++y)
    for (int x = 0; x < gbuffer.width; ++x) {
      if (!isCovered(gbuffer, x, y)) continue;
      const std::size_t i = gbuffer.index(x, y);
      for (std::size_t c = i; c < 3 * n; c += n) {
        if (i % kLengths.size() == 0) {
          ASSERT_EQ(read.normal[c], shot.gbuffer.normal[c]) << "unit already";
        } else {
          // Rounded by the product, by the new length and once more.
          ASSERT_NEAR(read.normal[c], shot.gbuffer.normal[c], 4 * kUnit);
        }
      }
    }
  RenderSettings settings = shot.settings;
  settings.shade.culling = Culling::kNone;
  Stats stats;
  const Image all = shadeGBuffer(testDevice(), shot.scene, read, settings, stats);
  settings.shade.culling = Culling::kTiles;
  EXPECT_EQ(shadeGBuffer(testDevice(), shot.scene, read, settings, stats).pixels, all.pixels);
}

TEST(HardTiles, NearAndFarInOneTile) {
  // A ball at 2 m before a wall at 90 000 km, both lit from near and far: tiles that hold both are that deep.
  const glm::ivec2 size(48, 40);
  const Shot shot = shoot(R"({"camera": {"eye": [0, 0, 0], "target": [0, 0, -1], "near": 1e-6, "far": 1e8},
    "objects": [{"primitive": "sphere", "scale": 0.5, "translate": [0.1, 0, -2]}, {"primitive": "plane", "scale": 5e8, "rotate": [90, 0, 0], "translate": [0, 0, -9e7]}],
    "lights": [{"type": "point", "position": [1, 1, -1], "range": 2}, {"type": "point", "position": [1e7, 0, -8e7], "range": 5e7},
               {"type": "point", "position": [0, 0, 1], "range": 1e9}, {"type": "point", "position": [3, 0, -4e7], "range": 1e6}]})",
                          size);
  EXPECT_EQ(coveredPixels(shot.gbuffer), size.x * size.y);
  // A float's rounding, and a double's at the wall's corners.
  EXPECT_NEAR(positionAt(shot.gbuffer, 1, 1).z, -9e7, 9e7 * kUnit + 5e8 * 20 * 0x1p-53);
  EXPECT_GT(positionAt(shot.gbuffer, 24, 20).z, -2);
  expectAsTheReference(shot);
  expectCullingChangesNothing(shot);
}

/// Something in every corner of the picture, whatever its shape.
constexpr const char* kCrowd =
    R"({"camera": {"eye": [0.4, 1, 4], "target": [0, 0.5, 0], "fov_y": 60}, "background": [0, 0, 0.25], "ambient": 0.05,
  "materials": {"m": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 20, "segments": 9, "material": "m"}, {"primitive": "torus", "segments": 24, "translate": [0, 0.5, 0], "rotate": [60, 0, 20], "material": "m"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "intensity": 0.5}, {"type": "point", "position": [1, 2, 2], "range": 4},
             {"type": "point", "position": [-1, 0.3, 1], "range": 1.5, "color": [1, 0, 0]}, {"type": "spot", "position": [0, 4, 0], "direction": [0, -1, 0], "inner_cone": 10, "outer_cone": 30}]})";

class Sizes : public testing::TestWithParam<std::array<int, 2>> {};

TEST_P(Sizes, RenderWholeAndInParts) {
  const glm::ivec2 size(GetParam()[0], GetParam()[1]);
  const Shot shot = shoot(kCrowd, size);
  ASSERT_EQ(shot.image.pixels.size(), std::size_t(3) * size.x * size.y);
  EXPECT_GT(coveredPixels(shot.gbuffer), 0);
  expectAsTheReference(shot);
  expectCullingChangesNothing(shot);
  const glm::ivec2 third = size / 3, last = size - 1;
  for (const Crop& crop : {Crop{0, 0, size.x, size.y},
                           {last.x, last.y, 1, 1},
                           {0, last.y, size.x, 1},
                           {last.x, 0, 1, size.y},
                           {third.x, third.y, std::max(third.x, 1), std::max(third.y, 1)}}) {
    RenderSettings settings = shot.settings;
    settings.crop = crop;
    Stats stats;
    const Image part = renderScene(testDevice(), shot.scene, settings, stats);
    ASSERT_EQ(part.width, crop.width);
    ASSERT_EQ(part.height, crop.height);
    for (int y = 0; y < crop.height; ++y)
      for (int x = 0; x < crop.width; ++x)
        ASSERT_EQ(colorAt(part, x, y), colorAt(shot.image, crop.x + x, crop.y + y))
            << "crop " << crop.x << "," << crop.y << ": " << x << "," << y;
  }
}

using Side = std::array<int, 2>;
INSTANTIATE_TEST_SUITE_P(HardTiles, Sizes,
                         testing::Values(Side{1, 1}, Side{1, 93}, Side{93, 1}, Side{1, 4096}, Side{4096, 1},
                                         Side{7, 7}, Side{7, 93}, Side{93, 144}, Side{144, 17}, Side{17, 31},
                                         Side{16, 16}, Side{15, 33}),
                         [](const auto& side) { return fmt::format("{}x{}", side.param[0], side.param[1]); });

TEST(HardTiles, LightsBehindBesideAndAroundTheCamera) {
  // A floor and walls around the camera; each light's place in view axes, and its range. All reach something
  // that is seen, though most are not in the picture themselves.
  const std::array<glm::dvec4, 10> places{{{0, 0, 3, 6},        // behind
                                           {0.5, 0.5, 40, 43},  // far behind
                                           {0, 0, 0, 5},        // in the eye
                                           {0, 0, 1e-9, 5},     // next to it
                                           {0, 0, 0.1, 5},      // in the near plane
                                           {-9, 0, 2, 12},      // beside
                                           {0, 30, -5, 31},     // above
                                           {3, -20, 9, 26},     // below, behind
                                           {0, 0, -50, 48},     // beyond the far wall
                                           {0, 0, 1000, 1010}}};
  const glm::ivec2 size(80, 60);
  const auto room = [&](std::string lights) {
    return shoot(fmt::format(R"({{"camera": {{"eye": [0, 0, 0], "target": [0, 0, -1], "fov_y": 75}},
      "materials": {{"m": {{"diffuse": [0.6, 0.7, 0.8], "specular": 0.25, "shininess": 8, "double_sided": true}}}},
      "objects": [{{"primitive": "box", "scale": [6, 4, 14], "translate": [0.3, 0.1, 1], "material": "m"}}, {{"primitive": "sphere", "segments": 24, "scale": 0.5, "translate": [0.4, -0.3, -2], "material": "m"}}],
      "lights": [{}]}})",
                             lights),
                 size);
  };
  std::string all;
  for (const glm::dvec4& place : places) {
    const std::string light = fmt::format(R"({{"type": "point", "position": [{}, {}, {}], "range": {}}})",
                                          place.x, place.y, place.z, place.w);
    SCOPED_TRACE(light);
    const Shot shot = room(light);
    EXPECT_GT(*std::max_element(shot.image.pixels.begin(), shot.image.pixels.end()), 0.0f);
    expectAsTheReference(shot);
    expectCullingChangesNothing(shot);
    all += (all.empty() ? "" : ", ") + light;
  }
  const Shot shot = room(all);
  expectAsTheReference(shot);
  expectCullingChangesNothing(shot);
}

}  // namespace
}  // namespace luciole::test
