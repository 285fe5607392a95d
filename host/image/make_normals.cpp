#include "image/make_normals.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "image/build_mips.hpp"
#include "image/srgb.hpp"

namespace luciole {
namespace {

float numberOf(std::uint16_t code, bool linear) {
  return linear ? linearOfSrgb16()[code] : float(code) * (1.0f / 65535.0f);
}

std::uint16_t codeOf(double number) {
  return srgb16OfLinear16()[std::size_t(std::clamp(number, 0.0, 1.0) * 65535 + 0.5)];
}

bool looksLikeNormals(const MipLevel& level, bool linear) {
  std::array<double, 3> mean{};
  const std::size_t count = level.texels.size() / 4;
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c) mean[c] += numberOf(level.texels[4 * i + c], linear) / double(count);
  return std::abs(mean[0] - 0.5) < 0.15 && std::abs(mean[1] - 0.5) < 0.15 && mean[2] >= 0.7;
}

std::vector<float> heightsOf(const MipLevel& level, bool linear) {
  std::vector<float> heights(level.texels.size() / 4);
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const std::uint16_t* texel = &level.texels[4 * i];
    heights[i] =
        (numberOf(texel[0], linear) + numberOf(texel[1], linear) + numberOf(texel[2], linear)) * (1.0f / 3);
  }
  return heights;
}

void fromHeights(bool linear, MipLevel& level) {
  const std::vector<float> heights = heightsOf(level, linear);
  const int width = level.width, height = level.height;
  const double up = kBumpHeight * std::max(width, height) / 2;  // a difference spans two texels
  tbb::parallel_for(0, height, [&](int y) {
    const float* row = &heights[std::size_t(y) * width];
    const float* above = &heights[std::size_t(y == 0 ? height - 1 : y - 1) * width];
    const float* below = &heights[std::size_t(y == height - 1 ? 0 : y + 1) * width];
    for (int x = 0; x < width; ++x) {
      const double slope_x = up * (row[x == width - 1 ? 0 : x + 1] - row[x == 0 ? width - 1 : x - 1]);
      const double slope_y = up * (above[x] - below[x]);  // upwards
      const double scale = 0.5 / std::sqrt(slope_x * slope_x + slope_y * slope_y + 1);
      std::uint16_t* texel = &level.texels[(std::size_t(y) * width + x) * 4];
      texel[0] = codeOf(0.5 - slope_x * scale);
      texel[1] = codeOf(0.5 - slope_y * scale);
      texel[2] = codeOf(0.5 + scale);
      texel[3] = 65535;
    }
  });
}

void recode(bool linear, MipLevel& level) {
  const std::vector<std::uint16_t>& codes = srgb16OfLinear16();
  for (std::size_t i = 0; i < level.texels.size(); i += 4) {
    for (int c = 0; c < 3 && !linear; ++c) level.texels[i + c] = codes[level.texels[i + c]];
    level.texels[i + 3] = 65535;
  }
}

}  // namespace

void makeNormals(TextureKind kind, Texture& texture) {
  texture.levels.resize(1);
  MipLevel& finest = texture.levels.front();
  if (kind == TextureKind::kBump && !looksLikeNormals(finest, texture.linear))
    fromHeights(texture.linear, finest);
  else
    recode(texture.linear, finest);
  buildMips(texture);
  texture.kind = kind;
  texture.linear = true;
}

}  // namespace luciole
