#include "raster/sample_texture.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "image/srgb.hpp"

namespace luciole {
namespace {

// Functions called in loops over lanes have no branches, so that the loops are vectorized: both sides of each
// choice are cheap and safe to compute.

/// Wraps a texture coordinate into [0, 1]; not finite: as 0. The subtractions are exact for any finite float.
inline double wrapCoordinate(float coordinate, Wrap wrap) {
  const double t = std::abs(coordinate) <= std::numeric_limits<float>::max() ? coordinate : 0.0f;
  const double repeated = t - std::floor(t);
  const double in_pair = t - 2.0 * std::floor(0.5 * t);
  const double mirrored = in_pair > 1.0 ? 2.0 - in_pair : in_pair;
  const double positive = t > 0.0 ? t : 0.0;
  const double clamped = positive < 1.0 ? positive : 1.0;
  const double in_one = wrap == Wrap::kClampToEdge ? clamped : mirrored;
  return wrap == Wrap::kRepeat ? repeated : in_one;
}

/// The two texels on either side of a point along one axis, and the second one's share.
struct Neighbours {
  std::int32_t first;
  std::int32_t second;
  float share;
};

inline Neighbours neighbours(double wrapped, std::int32_t size, Wrap wrap) {
  const double place = wrapped * size - 0.5;
  const double below = std::floor(place);
  const std::int32_t first = std::int32_t(below), last = size - 1;
  // At a mirror the texel beyond the edge is the edge texel again, as it is where coordinates are clamped.
  const std::int32_t before = wrap == Wrap::kRepeat ? last : 0;
  const std::int32_t after = last - before;
  const std::int32_t not_beyond = first < last ? first : last;
  return {first < 0 ? before : not_beyond, first < last ? first + 1 : after, float(place - below)};
}

/// Both are the texel that a point lies in.
inline Neighbours snapped(const Neighbours& around) {
  const std::int32_t nearest = around.share < 0.5f ? around.first : around.second;
  return {nearest, nearest, 0.0f};
}

/// Gives exactly a where both are equal.
inline float mix(float a, float b, float share) { return a + (b - a) * share; }

/// A channel of a texel as a number.
inline float decode(const std::uint16_t* texel, int channel, bool finest) {
  const std::uint16_t code = texel[channel];
  if (channel == 3) return code * (1.0f / 65535.0f);
  return finest ? linearOfSrgb16()[code] : linearOfRoot16(code);
}

float sampleLevel(const Texture& texture, int level, const TextureUse& use, bool nearest, double u, double v,
                  int channel) {
  const MipLevel& mip = texture.levels[std::size_t(level)];
  Neighbours column = neighbours(u, mip.width, use.wrap_u);
  Neighbours row = neighbours(v, mip.height, use.wrap_v);
  if (nearest) {
    column = snapped(column);
    row = snapped(row);
  }
  const auto value = [&](int x, int y) {
    return decode(&mip.texels[(std::size_t(y) * mip.width + x) * 4], channel, level == 0);
  };
  return mix(mix(value(column.first, row.first), value(column.second, row.first), column.share),
             mix(value(column.first, row.second), value(column.second, row.second), column.share), row.share);
}

/// The square of the longer side of a pixel's footprint, in texels of the finest level.
inline float footprintSize(double width, double height, const glm::vec2& duv_dx, const glm::vec2& duv_dy) {
  const double x0 = duv_dx.x * width, y0 = duv_dx.y * height;
  const double x1 = duv_dy.x * width, y1 = duv_dy.y * height;
  return float(std::max(x0 * x0 + y0 * y0, x1 * x1 + y1 * y1));
}

/// The base-2 logarithm of a positive normal float; 128 for infinity.
inline float log2OfPositive(float x) {
  // x = 2^e · m, m from √½ on, and log m = 2 artanh((m − 1) / (m + 1)), whose series is cut off at 2⁻²⁹.
  const std::int32_t bits = std::bit_cast<std::int32_t>(x);
  constexpr std::int32_t kRootOfHalf = 0x3f3504f3;
  const std::int32_t exponent = (bits - kRootOfHalf) >> 23;
  const float m = std::bit_cast<float>(bits - exponent * (1 << 23));
  const float s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
  constexpr float kScale = 2.8853900817779268f;  // 2 / ln 2
  const float series = 1.0f + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7 + s2 * (1.0f / 9))));
  return float(exponent) + kScale * s * series;
}

/// The mip level, by OpenGL 4.6, equations 8.7 and 8.8: the base-2 logarithm of the footprint's longer side
/// in texels. `size` is that side's square.
inline float levelOf(float size, float coarsest) {
  return size > 1.0f ? std::min(0.5f * log2OfPositive(size), coarsest) : 0.0f;
}

/// The level that is looked up in place of `level`. One of two that are as near is the finer.
inline float chosenLevel(float level, Mips mips) {
  if (mips == Mips::kBlended) return level;
  return mips == Mips::kNone ? 0.0f : std::ceil(level - 0.5f);
}

/// The bilinear footprint of a square's points in a level: the indices of the four texels around each point,
/// and the weights of the right and lower ones.
struct SquareTexels {
  Lanes<const std::uint16_t*> first;
  Lanes<std::uint32_t> top_left, top_right, bottom_left, bottom_right;
  Lanes<float> across, down;
};

/// The lookup of a square's pixels: each in two levels, which are mixed by the share of the coarser.
struct SquareLookup {
  SquareTexels finer, coarser;
  LaneMask is_finest;  ///< whether `finer` is level 0, whose codes are others
  Lanes<float> share;
};

void copyTexels(const SquareTexels& texels, const LaneMask& mask, SquareTexels& out) {
  copyLanes(texels.first, mask, out.first);
  copyLanes(texels.top_left, mask, out.top_left);
  copyLanes(texels.top_right, mask, out.top_right);
  copyLanes(texels.bottom_left, mask, out.bottom_left);
  copyLanes(texels.bottom_right, mask, out.bottom_right);
  copyLanes(texels.across, mask, out.across);
  copyLanes(texels.down, mask, out.down);
}

bool any(const LaneMask& mask) {
  std::int32_t found = 0;
  for (int i = 0; i < kSquarePixels; ++i) found |= mask[i];
  return found != 0;
}

/// Sets the points of some pixels to the centres of the texels that contain them.
void snap(const LaneMask& mask, SquareTexels& texels) {
  for (int i = 0; i < kSquarePixels; ++i) {
    if (!mask[i]) continue;
    const bool right = texels.across[i] >= 0.5f, lower = texels.down[i] >= 0.5f;
    const std::uint32_t top = right ? texels.top_right[i] : texels.top_left[i];
    const std::uint32_t bottom = right ? texels.bottom_right[i] : texels.bottom_left[i];
    texels.top_left[i] = texels.top_right[i] = texels.bottom_left[i] = texels.bottom_right[i] =
        lower ? bottom : top;
    texels.across[i] = texels.down[i] = 0.0f;
  }
}

SquareTexels findTexels(const MipLevel& level, const TextureUse& use, const Lanes<double>& u,
                        const Lanes<double>& v) {
  const std::int32_t width = level.width, height = level.height;
  Lanes<std::int32_t> left, right;
  SquareTexels result;
  result.first.fill(level.texels.data());
  for (int i = 0; i < kSquarePixels; ++i) {
    const Neighbours column = neighbours(u[i], width, use.wrap_u);
    left[i] = column.first;
    right[i] = column.second;
    result.across[i] = column.share;
  }
  for (int i = 0; i < kSquarePixels; ++i) {
    const Neighbours row = neighbours(v[i], height, use.wrap_v);
    const std::int32_t top = row.first * width, bottom = row.second * width;
    result.top_left[i] = std::uint32_t(top + left[i]);
    result.top_right[i] = std::uint32_t(top + right[i]);
    result.bottom_left[i] = std::uint32_t(bottom + left[i]);
    result.bottom_right[i] = std::uint32_t(bottom + right[i]);
    result.down[i] = row.share;
  }
  return result;
}

/// Finds the texels of a map for the wanted pixels of a square.
void findMap(const Texture& texture, const TextureUse& use, const SquareFootprints& footprints,
             const LaneMask& wanted, SquareLookup& lookup) {
  const double width = texture.levels[0].width, height = texture.levels[0].height;
  const float coarsest = float(texture.levels.size() - 1);
  Lanes<double> u, v;
  for (int i = 0; i < kSquarePixels; ++i) u[i] = wrapCoordinate(footprints.u[i], use.wrap_u);
  for (int i = 0; i < kSquarePixels; ++i) v[i] = wrapCoordinate(footprints.v[i], use.wrap_v);
  Lanes<std::int32_t> finer, coarser;
  LaneMask is_finest, is_magnified;
  Lanes<float> share, level;
  for (int i = 0; i < kSquarePixels; ++i) {
    const float size = footprintSize(width, height, {footprints.du_dx[i], footprints.dv_dx[i]},
                                     {footprints.du_dy[i], footprints.dv_dy[i]});
    level[i] = levelOf(size, coarsest);
    is_magnified[i] = size <= 1.0f;
  }
  if (use.mips != Mips::kBlended)
    for (float& l : level) l = chosenLevel(l, use.mips);
  for (int i = 0; i < kSquarePixels; ++i) {
    finer[i] = std::int32_t(level[i]);
    share[i] = level[i] - float(finer[i]);
    coarser[i] = finer[i] + (share[i] != 0.0f);
    is_finest[i] = finer[i] == 0;
  }
  std::int32_t least = std::numeric_limits<std::int32_t>::max(), most = 0;
  for (int i = 0; i < kSquarePixels; ++i) {
    least = std::min(least, wanted[i] ? finer[i] : least);
    most = std::max(most, wanted[i] ? coarser[i] : most);
  }
  copyLanes(share, wanted, lookup.share);
  copyLanes(is_finest, wanted, lookup.is_finest);
  for (std::int32_t l = least; l <= most; ++l) {
    LaneMask as_finer, as_coarser;
    for (int i = 0; i < kSquarePixels; ++i) {
      as_finer[i] = wanted[i] & (finer[i] == l);
      as_coarser[i] = wanted[i] & (coarser[i] == l);
    }
    const bool any_finer = any(as_finer), any_coarser = any(as_coarser);
    if (!any_finer && !any_coarser) continue;
    const SquareTexels texels = findTexels(texture.levels[std::size_t(l)], use, u, v);
    if (any_finer) copyTexels(texels, as_finer, lookup.finer);
    if (any_coarser) copyTexels(texels, as_coarser, lookup.coarser);
  }
  if (!use.nearest_magnified && !use.nearest_minified) return;
  LaneMask nearest;
  for (int i = 0; i < kSquarePixels; ++i)
    nearest[i] = wanted[i] & (is_magnified[i] ? use.nearest_magnified : use.nearest_minified);
  snap(nearest, lookup.finer);
  snap(nearest, lookup.coarser);
}

/// Asks for the cache lines of the left texels. (Inlined first, or else GCC takes it for a function without
/// effect.)
[[gnu::always_inline]] inline void prefetch(const SquareTexels& texels) {
  for (int i = 0; i < kSquarePixels; ++i) {
    __builtin_prefetch(texels.first[i] + std::size_t(texels.top_left[i]) * 4);
    __builtin_prefetch(texels.first[i] + std::size_t(texels.bottom_left[i]) * 4);
  }
}

/// Red, green, blue and a number without meaning. GCC and Clang make vector instructions of these types on
/// any machine.
using Color = float __attribute__((vector_size(4 * sizeof(float))));
/// Two colours, one behind the other.
using Colors = float __attribute__((vector_size(8 * sizeof(float))));

/// The linear colours of two texels.
template <bool kFinest>
inline void decode(const std::uint16_t* first, const std::uint16_t* second, Colors& out) {
  if constexpr (kFinest) {
    const float* linear = linearOfSrgb16().data();
    out = Colors{linear[first[0]],  linear[first[1]],  linear[first[2]],  0.0f,
                 linear[second[0]], linear[second[1]], linear[second[2]], 0.0f};
  } else {
    using Codes = std::uint16_t __attribute__((vector_size(8 * sizeof(std::uint16_t))));
    using WideCodes = std::int32_t __attribute__((vector_size(8 * sizeof(std::int32_t))));
    std::uint64_t both[2];
    std::memcpy(both, first, sizeof both[0]);
    std::memcpy(both + 1, second, sizeof both[1]);
    Codes codes;
    std::memcpy(&codes, both, sizeof codes);
    // As in linearOfRoot16().
    out = __builtin_convertvector(__builtin_convertvector(codes, WideCodes), Colors) * (1.0f / 65535.0f);
    out *= out;
  }
}

/// A channel at a lane of a square.
inline float readChannel(const SquareTexels& at, int lane, int channel, bool finest) {
  const auto value = [&](const Lanes<std::uint32_t>& places) {
    return decode(at.first[lane] + std::size_t(places[lane]) * 4, channel, finest);
  };
  return mix(mix(value(at.top_left), value(at.top_right), at.across[lane]),
             mix(value(at.bottom_left), value(at.bottom_right), at.across[lane]), at.down[lane]);
}

/// The colour at a lane of a square.
template <bool kFinest>
inline void readTexels(const SquareTexels& at, int lane, Color& color) {
  const auto texel = [&](const Lanes<std::uint32_t>& places) {
    return at.first[lane] + std::size_t(places[lane]) * 4;
  };
  Colors left, right;
  decode<kFinest>(texel(at.top_left), texel(at.bottom_left), left);
  decode<kFinest>(texel(at.top_right), texel(at.bottom_right), right);
  const Colors both = left + (right - left) * at.across[lane];
  std::array<Color, 2> rows;
  std::memcpy(rows.data(), &both, sizeof rows);
  color = rows[0] + (rows[1] - rows[0]) * at.down[lane];
}

}  // namespace

float texelsInside(const Texture& texture, const TextureUse& use, glm::vec2 duv_dx, glm::vec2 duv_dy) {
  if (use.mips == Mips::kNone) return 0.0f;
  const MipLevel& finest = texture.levels[0];
  return footprintSize(finest.width, finest.height, duv_dx, duv_dy);
}

float sampleTexture(const Texture& texture, const TextureUse& use, glm::vec2 uv, glm::vec2 duv_dx,
                    glm::vec2 duv_dy, int channel) {
  const double u = wrapCoordinate(uv.x, use.wrap_u);
  const double v = wrapCoordinate(uv.y, use.wrap_v);
  const MipLevel& finest = texture.levels.front();
  const float size = footprintSize(finest.width, finest.height, duv_dx, duv_dy);
  const float level = chosenLevel(levelOf(size, float(texture.levels.size() - 1)), use.mips);
  const bool nearest = size <= 1.0f ? use.nearest_magnified : use.nearest_minified;
  const int finer = int(level);
  const float share = level - float(finer);
  const float fine = sampleLevel(texture, finer, use, nearest, u, v, channel);
  if (share == 0.0f) return fine;
  return mix(fine, sampleLevel(texture, finer + 1, use, nearest, u, v, channel), share);
}

Lanes3<float> sampleTextures(std::span<const Texture> textures, const Lanes<const TextureUse*>& uses,
                             const SquareFootprints& footprints) {
  SquareLookup lookup{};
  Lanes<const TextureUse*> left = uses;
  for (int lane = 0; lane < kSquarePixels; ++lane) {
    const TextureUse* use = left[lane];
    if (!use) continue;
    LaneMask wanted;
    for (int i = 0; i < kSquarePixels; ++i) {
      wanted[i] = left[i] == use;
      left[i] = wanted[i] ? nullptr : left[i];
    }
    findMap(textures[std::size_t(use->texture)], *use, footprints, wanted, lookup);
  }
  // Of all pixels before the first is read, which hides most of the memory's latency.
  prefetch(lookup.finer);
  prefetch(lookup.coarser);
  Lanes3<float> colors;
  for (int i = 0; i < kSquarePixels; ++i) {
    Color color{1.0f, 1.0f, 1.0f};
    if (uses[i]) {
      if (lookup.is_finest[i])
        readTexels<true>(lookup.finer, i, color);
      else
        readTexels<false>(lookup.finer, i, color);
      if (lookup.share[i] != 0.0f) {
        Color coarse;
        readTexels<false>(lookup.coarser, i, coarse);
        color += (coarse - color) * lookup.share[i];
      }
    }
    for (int c = 0; c < 3; ++c) colors[c][i] = color[c];
  }
  return colors;
}

Lanes<float> sampleChannel(const Texture& texture, const TextureUse& use, const SquareFootprints& footprints,
                           const LaneMask& wanted, int channel) {
  SquareLookup lookup{};
  findMap(texture, use, footprints, wanted, lookup);
  Lanes<float> values{};
  for (int i = 0; i < kSquarePixels; ++i) {
    if (!wanted[i]) continue;
    values[i] = readChannel(lookup.finer, i, channel, lookup.is_finest[i]);
    if (lookup.share[i] != 0.0f)
      values[i] = mix(values[i], readChannel(lookup.coarser, i, channel, false), lookup.share[i]);
  }
  return values;
}

}  // namespace luciole
