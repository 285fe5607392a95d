#include "image/build_mips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "image/srgb.hpp"

namespace luciole {
namespace {

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

/// A row of a level in linear light, RGBA, colours not multiplied by alpha.
struct LinearRow {
  std::vector<float> values;
  bool opaque = false;  ///< every alpha is exactly 1
};

/// Makes a level from the rows of the next finer one. These come one by one, from the top down, and no row of
/// a level is read by more than two of the next, of three rows at most: so three are kept.
struct Halving {
  MipLevel& level;
  std::vector<Footprint> columns, rows;
  std::array<LinearRow, 3> kept{};
  int taken = 0;  ///< fine rows
  int made = 0;   ///< coarse rows

  LinearRow& next() { return kept[taken % kept.size()]; }
};

/// A row of the finest level. Returns whether all its alphas are `alpha`.
bool decode(const std::uint16_t* texels, std::uint16_t alpha, LinearRow& row) {
  const float* linear_of_code = linearOfSrgb16().data();
  std::uint16_t unlike_one = 0, unlike = 0;
  for (std::size_t i = 0; i < row.values.size(); i += 4) {
    for (int c = 0; c < 3; ++c) row.values[i + c] = linear_of_code[texels[i + c]];
    row.values[i + 3] = float(texels[i + 3]) * (1.0f / 65535.0f);
    unlike_one |= texels[i + 3] ^ 65535;
    unlike |= texels[i + 3] ^ alpha;
  }
  row.opaque = unlike_one == 0;
  return unlike == 0;
}

void encode(const std::vector<float>& values, std::uint16_t* texels) {
  const auto code = [](float unit) { return std::uint16_t(int(unit * 65535.0f + 0.5f)); };
  for (std::size_t i = 0; i < values.size(); ++i) texels[i] = code(std::sqrt(std::min(values[i], 1.0f)));
  for (std::size_t i = 3; i < values.size(); i += 4) texels[i] = code(std::min(values[i], 1.0f));
}

/// The mean over a rectangle of fine texels: R G B A to `mean`.
void average(const Halving& halving, const Footprint& across, const Footprint& down, float* mean) {
  float color[3]{}, weighted[3]{}, alpha = 0;
  for (int y = 0; y < down.count; ++y) {
    const float* texel = &halving.kept[(down.first + y) % halving.kept.size()].values[across.first * 4];
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

/// The same for a whole row where each mean is of 2 × 2 opaque texels. The weight is a power of two and the
/// alphas are 1, so it gives the same bits.
void averageFours(const float* top, const float* bottom, std::size_t values, float* __restrict means) {
  for (std::size_t i = 0; i < values; i += 4, top += 8, bottom += 8)
    for (int c = 0; c < 4; ++c) means[i + c] = 0.25f * (top[c] + top[c + 4] + bottom[c] + bottom[c + 4]);
}

bool isEven(const std::vector<Footprint>& side) { return side.front().count == 2; }

/// Takes the fine row that was written to chain[0].next(), and makes of it what rows can now be made, here
/// and in the coarser levels.
void takeRow(std::span<Halving> chain) {
  Halving& halving = chain[0];
  ++halving.taken;
  while (halving.made < halving.level.height) {
    const Footprint& down = halving.rows[halving.made];
    if (down.first + down.count > halving.taken) return;
    LinearRow last{std::vector<float>(chain.size() > 1 ? 0 : 4)};  // one texel, of which nothing is made
    LinearRow& row = chain.size() > 1 ? chain[1].next() : last;
    const LinearRow& top = halving.kept[down.first % halving.kept.size()];
    const LinearRow& bottom = halving.kept[(down.first + 1) % halving.kept.size()];
    row.opaque = isEven(halving.columns) && isEven(halving.rows) && top.opaque && bottom.opaque;
    if (row.opaque) {
      averageFours(top.values.data(), bottom.values.data(), row.values.size(), row.values.data());
    } else {
      for (int x = 0; x < halving.level.width; ++x)
        average(halving, halving.columns[x], down, &row.values[std::size_t(x) * 4]);
    }
    encode(row.values, &halving.level.texels[std::size_t(halving.made) * row.values.size()]);
    ++halving.made;
    if (chain.size() > 1) takeRow(chain.subspan(1));
  }
}

/// Adds the levels, whose texels are not yet written, and what makes each of them.
std::vector<Halving> makeChain(Texture& texture) {
  std::vector<MipLevel>& levels = texture.levels;
  while (levels.back().width > 1 || levels.back().height > 1) {
    const int width = std::max(1, levels.back().width / 2), height = std::max(1, levels.back().height / 2);
    levels.push_back({width, height, Texels(std::size_t(width) * height * 4)});
  }
  std::vector<Halving> chain;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const MipLevel& fine = levels[i - 1];
    chain.push_back({levels[i], footprints(fine.width), footprints(fine.height)});
    for (LinearRow& row : chain.back().kept) row.values.resize(std::size_t(fine.width) * 4);
  }
  return chain;
}

}  // namespace

void buildMips(Texture& texture) {
  texture.alpha_varies = false;
  std::vector<Halving> chain = makeChain(texture);
  const MipLevel& finest = texture.levels.front();
  const std::size_t row_values = std::size_t(finest.width) * 4;
  for (int y = 0; y < finest.height && !chain.empty(); ++y) {
    const bool alike = decode(&finest.texels[y * row_values], finest.texels[3], chain[0].next());
    texture.alpha_varies |= !alike;
    takeRow(chain);
  }
}

}  // namespace luciole
