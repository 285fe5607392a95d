#include "raster/sample_texture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "luciole/gbuffer.hpp"
#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

/// Interpolation of values up to 1 takes 3 mixes of 3 roundings each on the way; texel centres are hit to
/// 2⁻²⁴ of the picture's width, so 16 texels err by 16 · 2⁻²⁴ of the difference of two texels.
constexpr float kTolerance = (9.0f + 16.0f) * 0x1p-24f;

/// A chain of levels whose red is what `red(level, x, y)` says, as a code 0 or 65535, alpha 1.
template <class Red>
Texture chain(int width, int height, Red red) {
  Texture texture;
  for (int level = 0;; ++level) {
    MipLevel mip{width, height, {}};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (const int code : {red(level, x, y) ? 65535 : 0, 0, 0, 65535})
          mip.texels.push_back(std::uint16_t(code));
    texture.levels.push_back(mip);
    if (width == 1 && height == 1) return texture;
    width = std::max(1, width / 2);
    height = std::max(1, height / 2);
  }
}

float redAt(const Texture& texture, Wrap wrap, glm::vec2 uv, glm::vec2 dx = {}, glm::vec2 dy = {}) {
  return sampleTexture(texture, {0, wrap, wrap}, uv, dx, dy, 0);
}

constexpr Wrap kWraps[] = {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge};

TEST(SampleTexture, OneTexelIsTheSameEverywhere) {
  const Texture texture{"", {{1, 1, {65535, 257 * 188, 0, 32768}}}};
  for (const Wrap wrap : kWraps)
    for (const float u : {-7.3f, 0.0f, 0.5f, 1.0f, 1e30f, -1e30f, std::numeric_limits<float>::max()}) {
      const auto value = [&](int channel) {
        return sampleTexture(texture, {0, wrap, wrap}, {u, -u}, {3.0f, 0.0f}, {}, channel);
      };
      EXPECT_EQ(value(0), 1.0f);
      // sRGB 188/255 decodes to 0.5028865 (IEC 61966-2-1); alpha is linear.
      EXPECT_NEAR(value(1), 0.5028865f, 2e-7f);
      EXPECT_EQ(value(2), 0.0f);
      EXPECT_NEAR(value(3), 32768.0f / 65535.0f, 0x1p-24f);
    }
}

TEST(SampleTexture, TheNearestTexelIsTakenWhereAsked) {
  const Texture texture = chain(2, 2, [](int, int x, int y) { return x == 1 && y == 0; });
  TextureUse use{0, Wrap::kClampToEdge, Wrap::kClampToEdge, true};
  for (int i = 0; i < 64; ++i) {
    const float u = (float(i) + 0.5f) / 64;
    EXPECT_EQ(sampleTexture(texture, use, {u, 0.25f}, {}, {}, 0), i < 32 ? 0.0f : 1.0f) << i;
    EXPECT_EQ(sampleTexture(texture, use, {u, 0.75f}, {}, {}, 0), 0.0f) << i;
  }
  use.wrap_u = use.wrap_v = Wrap::kRepeat;
  EXPECT_EQ(sampleTexture(texture, use, {-0.01f, 0.01f}, {}, {}, 0), 1.0f) << "across the edge";
}

TEST(SampleTexture, MipsAreChosenByName) {
  // Each level is red where its number is odd.
  const Texture texture = chain(8, 8, [](int level, int, int) { return level % 2 == 1; });
  const auto red = [&](Mips mips, float footprint) {
    TextureUse use;
    use.mips = mips;
    return sampleTexture(texture, use, {0.5f, 0.5f}, {footprint / 8, 0}, {}, 0);
  };
  EXPECT_EQ(red(Mips::kBlended, 2), 1.0f);
  EXPECT_EQ(red(Mips::kNone, 2), 0.0f);
  EXPECT_EQ(red(Mips::kNearest, 2), 1.0f);
  EXPECT_EQ(red(Mips::kNearest, 1.3f), 0.0f);  // level 0.38
  EXPECT_EQ(red(Mips::kNearest, 1.5f), 1.0f);  // level 0.58
  EXPECT_EQ(red(Mips::kNearest, 100), 1.0f) << "the coarsest is level 3";
  // A minified pixel on the finest level, by the nearest texel.
  const Texture two = chain(2, 2, [](int, int x, int) { return x == 1; });
  TextureUse use{0, Wrap::kRepeat, Wrap::kRepeat, false, true, Mips::kNone};
  EXPECT_EQ(sampleTexture(two, use, {0.6f, 0.25f}, {1, 0}, {}, 0), 1.0f);
  EXPECT_EQ(sampleTexture(two, use, {0.4f, 0.25f}, {1, 0}, {}, 0), 0.0f);
  EXPECT_GT(sampleTexture(two, use, {0.4f, 0.25f}, {}, {}, 0), 0.0f) << "magnified texels are mixed";
}

TEST(SampleTexture, NonFiniteCoordinatesReadAsZero) {
  const Texture texture = chain(4, 4, [](int, int x, int y) { return x == 0 && y == 0; });
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const Wrap wrap : kWraps) {
    const float at_zero = redAt(texture, wrap, {0.0f, 0.0f});
    for (const float bad : {nan, inf, -inf}) EXPECT_EQ(redAt(texture, wrap, {bad, bad}), at_zero);
  }
  // A footprint that is not a number is none.
  EXPECT_EQ(redAt(texture, Wrap::kRepeat, {0.125f, 0.125f}, {nan, 0.0f}), 1.0f);
}

TEST(SampleTexture, TexelsLieAtTheirCentresAndBlendLinearly) {
  const Texture texture = chain(4, 2, [](int, int x, int y) { return x == 2 && y == 0; });
  const Wrap clamp = Wrap::kClampToEdge;
  EXPECT_EQ(redAt(texture, clamp, {0.625f, 0.25f}), 1.0f);
  EXPECT_EQ(redAt(texture, clamp, {0.375f, 0.25f}), 0.0f);
  EXPECT_EQ(redAt(texture, clamp, {0.625f, 0.75f}), 0.0f);
  EXPECT_NEAR(redAt(texture, clamp, {0.5625f, 0.25f}), 0.75f, kTolerance);
  EXPECT_NEAR(redAt(texture, clamp, {0.5f, 0.5f}), 0.25f, kTolerance);
  EXPECT_EQ(redAt(texture, clamp, {0.625f, 0.0f}), 1.0f);
}

TEST(SampleTexture, WrapModes) {
  const Texture left = chain(4, 1, [](int, int x, int) { return x == 0; });
  // Texel centres at ⅛, ⅜ …; u = 0 lies between the first texel and the one that the mode puts before it.
  EXPECT_NEAR(redAt(left, Wrap::kRepeat, {0.0f, 0.5f}), 0.5f, kTolerance);
  EXPECT_EQ(redAt(left, Wrap::kMirroredRepeat, {0.0f, 0.5f}), 1.0f);
  EXPECT_EQ(redAt(left, Wrap::kClampToEdge, {0.0f, 0.5f}), 1.0f);
  for (const float turn : {-3.0f, -1.0f, 1.0f, 2.0f, 1000.0f}) {
    EXPECT_EQ(redAt(left, Wrap::kRepeat, {turn + 0.125f, 0.5f}), 1.0f) << turn;
    const bool mirrored = std::fmod(turn, 2.0f) != 0.0f;
    EXPECT_EQ(redAt(left, Wrap::kMirroredRepeat, {turn + 0.125f, 0.5f}), mirrored ? 0.0f : 1.0f) << turn;
    EXPECT_EQ(redAt(left, Wrap::kMirroredRepeat, {turn + 0.875f, 0.5f}), mirrored ? 1.0f : 0.0f) << turn;
    EXPECT_EQ(redAt(left, Wrap::kClampToEdge, {turn + 0.125f, 0.5f}), turn < 0.0f ? 1.0f : 0.0f) << turn;
  }
  // The seam of a repeat on the far side.
  EXPECT_NEAR(redAt(left, Wrap::kRepeat, {0.9375f, 0.5f}), 0.25f, kTolerance);
}

TEST(SampleTexture, EachAxisHasItsOwnMode) {
  const Texture texture = chain(2, 2, [](int, int x, int y) { return x == 0 && y == 1; });
  EXPECT_EQ(sampleTexture(texture, {0, Wrap::kRepeat, Wrap::kClampToEdge}, {1.25f, 1.25f}, {}, {}, 0), 1.0f);
  EXPECT_EQ(sampleTexture(texture, {0, Wrap::kClampToEdge, Wrap::kRepeat}, {1.25f, 1.25f}, {}, {}, 0), 0.0f);
}

TEST(SampleTexture, TheLevelFollowsTheLongerSide) {
  // Level 2 alone is red.
  const Texture texture = chain(64, 16, [](int level, int, int) { return level == 2; });
  const auto red = [&](glm::vec2 dx, glm::vec2 dy) {
    return redAt(texture, Wrap::kRepeat, {0.4f, 0.3f}, dx, dy);
  };
  EXPECT_EQ(red({}, {}), 0.0f);
  EXPECT_EQ(red({1.0f / 64, 0}, {}), 0.0f);
  EXPECT_NEAR(red({4.0f / 64, 0}, {}), 1.0f, kTolerance);
  EXPECT_NEAR(red({0, 4.0f / 16}, {1.0f / 64, 0}), 1.0f, kTolerance);
  EXPECT_NEAR(red({}, {0, 4.0f / 16}), 1.0f, kTolerance);
  // Side of (4, 4)/√2 texels: 4 long.
  EXPECT_NEAR(red(glm::vec2(4.0f / 64, 4.0f / 16) * std::sqrt(0.5f), {}), 1.0f, kTolerance);
  // Halfway between levels 1 and 2 in the logarithm.
  EXPECT_NEAR(red({std::exp2(1.5f) / 64, 0}, {}), 0.5f, kTolerance);
  EXPECT_NEAR(red({std::exp2(2.25f) / 64, 0}, {}), 0.75f, kTolerance);
}

TEST(SampleTexture, TheFinestLevelIsSrgbAndTheOthersAreRoots) {
  const Texture texture{"", {{2, 1, {257 * 188, 0, 0, 0, 257 * 188, 0, 0, 0}}, {1, 1, {13107, 0, 0, 0}}}};
  EXPECT_NEAR(redAt(texture, Wrap::kRepeat, {0.25f, 0.5f}), 0.5028865f, 2e-7f);
  // 13107 / 65535 is 1/5; its square has two roundings.
  EXPECT_NEAR(redAt(texture, Wrap::kRepeat, {0.25f, 0.5f}, {1.0f, 0.0f}), 0.04f, 0.04f * 3 * 0x1p-24f);
}

TEST(SampleTexture, HugeFootprintsReadTheCoarsestLevel) {
  const Texture texture = chain(64, 16, [](int level, int, int) { return level == 6; });
  for (const float side : {1.0f, 100.0f, 1e20f, std::numeric_limits<float>::max()})
    EXPECT_EQ(redAt(texture, Wrap::kRepeat, {0.4f, 0.3f}, {side, side}, {}), 1.0f);
}

// Bit for bit, whatever the maps, wraps and levels, and however far out the coordinates are.
TEST(SampleTexture, SquaresOfPixelsSeeWhatEachPixelSees) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-3.0f, 3.0f), exponent(-12.0f, 3.0f);
  std::uniform_int_distribution<int> coin(0, 1), texture(-1, 1), wrap(0, 2);
  const std::vector<Texture> textures{randomChain({64, 16}, random), randomChain({7, 5}, random)};
  const auto step = [&] { return (coin(random) ? 1.0f : -1.0f) * std::exp2(exponent(random)); };
  for (int repeat = 0; repeat < 200; ++repeat) {
    SquareFootprints at;
    Lanes<TextureUse> uses;
    Lanes<const TextureUse*> maps;
    for (int i = 0; i < kSquarePixels; ++i) {
      at.u[i] = coin(random) ? place(random) : 1e30f * place(random);
      at.v[i] = i == 5 ? std::numeric_limits<float>::quiet_NaN() : place(random);
      at.du_dx[i] = step(), at.dv_dx[i] = step(), at.du_dy[i] = step(), at.dv_dy[i] = step();
      uses[i] = {texture(random),   kWraps[wrap(random)], kWraps[wrap(random)],
                 coin(random) == 0, coin(random) == 0,    Mips(wrap(random))};
      // In every other square pixels share their maps, as they mostly do in pictures.
      const TextureUse& use = uses[repeat % 2 ? i % (1 + repeat % 3) : i];
      maps[i] = use.texture < 0 ? nullptr : &use;
    }
    const Lanes3<float> seen = sampleTextures(textures, maps, at);
    for (int i = 0; i < kSquarePixels; ++i)
      for (int c = 0; c < 3; ++c)
        EXPECT_EQ(seen[c][i], maps[i]
                                  ? sampleTexture(textures[maps[i]->texture], *maps[i], {at.u[i], at.v[i]},
                                                  {at.du_dx[i], at.dv_dx[i]}, {at.du_dy[i], at.dv_dy[i]}, c)
                                  : 1.0f);
  }
}

TEST(Square, PixelsLieInTheOrderOfAGBuffer) {
  GBuffer gbuffer;
  gbuffer.tiles_x = gbuffer.tiles_y = 2;
  for (int i = 0; i < kSquarePixels; ++i)
    EXPECT_EQ(gbuffer.index(20 + kSquareLayout.x[i], 8 + kSquareLayout.y[i]), gbuffer.index(20, 8) + i);
}

}  // namespace
}  // namespace luciole::test
