#include "image/build_mips.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "image/srgb.hpp"

namespace luciole {
namespace {

struct Level {
  int width, height;
  std::vector<float> values;  ///< linear, RGBA
};

/// How much of fine texel j of `fine` coarse texel i covers, as a part of what it covers.
float share(int i, int j, int fine) {
  const long long coarse = std::max(1, fine / 2), begin = 1LL * i * fine, end = begin + fine;
  const long long covered = std::min(end, (j + 1) * coarse) - std::max(begin, j * coarse);
  return float(double(std::max(covered, 0LL)) / fine);
}

/// The next level, texel by texel, in float and in the order of rows: what the header says, written down.
Level halved(const Level& fine) {
  Level coarse{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}};
  for (int y = 0; y < coarse.height; ++y) {
    for (int x = 0; x < coarse.width; ++x) {
      float color[3]{}, weighted[3]{}, alpha = 0;
      for (int j = 0; j < fine.height; ++j) {
        for (int i = 0; i < fine.width; ++i) {
          const float weight = share(y, j, fine.height) * share(x, i, fine.width);
          if (weight == 0) continue;
          const float* texel = &fine.values[(std::size_t(j) * fine.width + i) * 4];
          const float opaque = weight * texel[3];
          for (int c = 0; c < 3; ++c) {
            color[c] += weight * texel[c];
            weighted[c] += opaque * texel[c];
          }
          alpha += opaque;
        }
      }
      for (int c = 0; c < 3; ++c) coarse.values.push_back(alpha > 0 ? weighted[c] / alpha : color[c]);
      coarse.values.push_back(alpha);
    }
  }
  return coarse;
}

enum class Alphas { kOpaque, kNone, kRows, kAny };

Texture someTexture(int width, int height, Alphas alphas) {
  Texture texture{"it", {MipLevel{width, height, {}}}};
  std::uint32_t state = 7;
  const auto random = [&] { return std::uint16_t((state = state * 1664525u + 1013904223u) >> 16); };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) texture.levels[0].texels.push_back(random());
      const bool opaque = alphas == Alphas::kOpaque || (alphas == Alphas::kRows && y % 8 < 4);
      texture.levels[0].texels.push_back(opaque ? 65535 : alphas == Alphas::kNone ? 0 : random());
    }
  }
  return texture;
}

TEST(BuildMips, EveryLevelIsTheMeanToTheBit) {
  for (const Alphas alphas : {Alphas::kOpaque, Alphas::kNone, Alphas::kRows, Alphas::kAny}) {
    for (const auto& [width, height] : {std::pair{1, 1},
                                        {2, 2},
                                        {1, 16},
                                        {16, 1},
                                        {64, 32},
                                        {24, 40},
                                        {7, 20},
                                        {20, 7},
                                        {23, 17},
                                        {5, 3}}) {
      SCOPED_TRACE(testing::Message() << width << " x " << height << ", alphas " << int(alphas));
      Texture texture = someTexture(width, height, alphas);
      const Texels finest = texture.levels[0].texels;
      buildMips(texture);
      EXPECT_EQ(texture.levels[0].texels, finest);
      bool varies = false;
      Level level{width, height, {}};
      for (std::size_t i = 0; i < finest.size(); ++i) {
        level.values.push_back(i % 4 == 3 ? float(finest[i]) * (1.0f / 65535.0f)
                                          : linearOfSrgb16()[finest[i]]);
        varies |= i % 4 == 3 && finest[i] != finest[3];
      }
      EXPECT_EQ(texture.alpha_varies, varies);
      for (std::size_t l = 1; l < texture.levels.size(); ++l) {
        level = halved(level);
        ASSERT_EQ(texture.levels[l].width, level.width);
        ASSERT_EQ(texture.levels[l].height, level.height);
        ASSERT_EQ(texture.levels[l].texels.size(), level.values.size());
        for (std::size_t i = 0; i < level.values.size(); ++i) {
          const float unit = std::min(level.values[i], 1.0f);
          ASSERT_EQ(texture.levels[l].texels[i],
                    std::uint16_t((i % 4 == 3 ? unit : std::sqrt(unit)) * 65535.0f + 0.5f))
              << "level " << l << ", value " << i;
        }
      }
      EXPECT_EQ(level.width * level.height, 1);
    }
  }
}

}  // namespace
}  // namespace luciole
