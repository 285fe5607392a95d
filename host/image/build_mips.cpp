#include "image/build_mips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "image/srgb.hpp"

namespace luciole {
namespace {

/// A level in linear light, RGBA, colours not multiplied by alpha.
struct LinearLevel {
  int width = 0;
  int height = 0;
  std::vector<float> values;
};

/// The texels that coarse texel i covers, from `first` on, and the share of each.
struct Footprint {
  int first = 0;
  int count = 0;
  std::array<float, 3> weights{};
};

/// One side of the box filter: `fine` texels to max(1, fine / 2). In units of 1 / coarse, coarse texel i
/// covers [i·fine, (i + 1)·fine) and fine texel j [j·coarse, (j + 1)·coarse), so all is exact in integers
/// until the division.
std::vector<Footprint> footprints(int fine) {
  const int coarse = std::max(1, fine / 2);
  std::vector<Footprint> result(coarse);
  for (int i = 0; i < coarse; ++i) {
    const long long begin = 1LL * i * fine, end = begin + fine;
    Footprint& footprint = result[i];
    footprint.first = int(begin / coarse);
    for (long long j = footprint.first; j * coarse < end; ++j) {
      const long long covered = std::min(end, (j + 1) * coarse) - std::max(begin, j * coarse);
      footprint.weights[footprint.count++] = float(double(covered) / fine);
    }
  }
  return result;
}

LinearLevel decode(const MipLevel& level) {
  const std::vector<float>& linear_of_code = linearOfSrgb16();
  LinearLevel linear{level.width, level.height, std::vector<float>(level.texels.size())};
  for (std::size_t i = 0; i < level.texels.size(); i += 4) {
    for (int c = 0; c < 3; ++c) linear.values[i + c] = linear_of_code[level.texels[i + c]];
    linear.values[i + 3] = float(level.texels[i + 3]) * (1.0f / 65535.0f);
  }
  return linear;
}

MipLevel encode(const LinearLevel& linear) {
  MipLevel level{linear.width, linear.height, std::vector<std::uint16_t>(linear.values.size())};
  const auto code = [](float unit) { return std::uint16_t(unit * 65535.0f + 0.5f); };
  for (std::size_t i = 0; i < level.texels.size(); i += 4) {
    for (int c = 0; c < 3; ++c) level.texels[i + c] = code(std::sqrt(std::min(linear.values[i + c], 1.0f)));
    level.texels[i + 3] = code(std::min(linear.values[i + 3], 1.0f));
  }
  return level;
}

/// The mean over a rectangle of fine texels: R G B A to `mean`.
void average(const LinearLevel& fine, const Footprint& across, const Footprint& down, float* mean) {
  float color[3]{}, weighted[3]{}, alpha = 0;
  for (int y = 0; y < down.count; ++y) {
    const float* texel = &fine.values[(std::size_t(down.first + y) * fine.width + across.first) * 4];
    for (int x = 0; x < across.count; ++x, texel += 4) {
      const float weight = down.weights[y] * across.weights[x];
      const float opaque = weight * texel[3];
      for (int c = 0; c < 3; ++c) {
        color[c] += weight * texel[c];
        weighted[c] += opaque * texel[c];
      }
      alpha += opaque;
    }
  }
  for (int c = 0; c < 3; ++c) mean[c] = alpha > 0 ? weighted[c] / alpha : color[c];
  mean[3] = alpha;
}

LinearLevel halve(const LinearLevel& fine) {
  const std::vector<Footprint> columns = footprints(fine.width), rows = footprints(fine.height);
  LinearLevel coarse{int(columns.size()), int(rows.size()),
                     std::vector<float>(columns.size() * rows.size() * 4)};
  float* mean = coarse.values.data();
  for (const Footprint& row : rows) {
    for (const Footprint& column : columns) {
      average(fine, column, row, mean);
      mean += 4;
    }
  }
  return coarse;
}

bool alphaVaries(const MipLevel& level) {
  for (std::size_t i = 3; i < level.texels.size(); i += 4)
    if (level.texels[i] != level.texels[3]) return true;
  return false;
}

}  // namespace

void buildMips(Texture& texture) {
  texture.alpha_varies = alphaVaries(texture.levels.front());
  LinearLevel level = decode(texture.levels.front());
  while (level.width > 1 || level.height > 1) {
    level = halve(level);
    texture.levels.push_back(encode(level));
  }
}

}  // namespace luciole
