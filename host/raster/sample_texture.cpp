#include "raster/sample_texture.hpp"

#include <algorithm>
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

/// Gives exactly a where both are equal.
inline float mix(float a, float b, float share) { return a + (b - a) * share; }

float sampleLevel(const Texture& texture, int level, Wrap wrap_u, Wrap wrap_v, double u, double v,
                  int channel) {
  const MipLevel& mip = texture.levels[std::size_t(level)];
  const Neighbours column = neighbours(u, mip.width, wrap_u);
  const Neighbours row = neighbours(v, mip.height, wrap_v);
  const auto value = [&](int x, int y) {
    const std::uint16_t code = mip.texels[(std::size_t(y) * mip.width + x) * 4 + channel];
    if (channel == 3) return code * (1.0f / 65535.0f);
    return level == 0 ? linearOfSrgb16()[code] : linearOfRoot16(code);
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

/// The maps of a square's pixels.
struct SquareMaps {
  Lanes<const MipLevel*> levels;  ///< the finest
  Lanes<float> coarsest;
  Lanes<Wrap> wrap_u, wrap_v;
};

/// A white texture, for pixels without a map.
const Texture& white() {
  static const Texture texture{"", {{1, 1, {65535, 65535, 65535, 65535}}}, false};
  return texture;
}

SquareMaps squareMaps(std::span<const Texture> textures, const Lanes<const TextureUse*>& uses) {
  SquareMaps maps;
  for (int i = 0; i < kSquarePixels; ++i) {
    const TextureUse use = uses[i] ? *uses[i] : TextureUse{};
    const Texture& texture = use.texture >= 0 ? textures[std::size_t(use.texture)] : white();
    maps.levels[i] = texture.levels.data();
    maps.coarsest[i] = float(texture.levels.size() - 1);
    maps.wrap_u[i] = use.wrap_u;
    maps.wrap_v[i] = use.wrap_v;
  }
  return maps;
}

/// The four texels around each of a square's points in one level, and the shares of the right and lower ones.
struct SquareTexels {
  Lanes<const std::uint16_t*> top;  ///< first texel of the row
  Lanes<const std::uint16_t*> bottom;
  Lanes<std::int32_t> left, right;  ///< offsets from there, in values
  Lanes<float> across, down;
  LaneMask finest;  ///< whether it is level 0
};

SquareTexels findTexels(const SquareMaps& maps, const Lanes<std::int32_t>& levels, const Lanes<double>& u,
                        const Lanes<double>& v) {
  Lanes<std::int32_t> width, height;
  Lanes<const std::uint16_t*> texels;
  for (int i = 0; i < kSquarePixels; ++i) {
    const MipLevel& level = maps.levels[i][levels[i]];
    width[i] = level.width;
    height[i] = level.height;
    texels[i] = level.texels.data();
  }
  SquareTexels result;
  Lanes<std::int32_t> top, bottom;
  for (int i = 0; i < kSquarePixels; ++i) {
    const Neighbours column = neighbours(u[i], width[i], maps.wrap_u[i]);
    result.left[i] = column.first * 4;
    result.right[i] = column.second * 4;
    result.across[i] = column.share;
  }
  for (int i = 0; i < kSquarePixels; ++i) {
    const Neighbours row = neighbours(v[i], height[i], maps.wrap_v[i]);
    top[i] = row.first;
    bottom[i] = row.second;
    result.down[i] = row.share;
  }
  for (int i = 0; i < kSquarePixels; ++i) {
    result.top[i] = texels[i] + std::int64_t(top[i]) * width[i] * 4;
    result.bottom[i] = texels[i] + std::int64_t(bottom[i]) * width[i] * 4;
    result.finest[i] = levels[i] == 0;
  }
  for (int i = 0; i < kSquarePixels; ++i) {
    __builtin_prefetch(result.top[i] + result.left[i]);
    __builtin_prefetch(result.bottom[i] + result.left[i]);
  }
  return result;
}

/// One texel for each pixel, its four 16-bit codes in one word.
using Texels = Lanes<std::uint64_t>;

inline std::uint64_t load(const std::uint16_t* texel) {
  std::uint64_t codes;
  std::memcpy(&codes, texel, sizeof codes);
  return codes;
}

Lanes<float> decode(const Texels& texels, int channel, const LaneMask& finest, bool any_finest) {
  const int place = 16 * (std::endian::native == std::endian::little ? channel : 3 - channel);
  Lanes<std::int32_t> codes;
  for (int i = 0; i < kSquarePixels; ++i) codes[i] = std::int32_t(texels[i] >> place & 0xffff);
  Lanes<float> result;
  for (int i = 0; i < kSquarePixels; ++i) result[i] = linearOfRoot16(codes[i]);
  if (!any_finest) return result;
  const float* linear_of_code = linearOfSrgb16().data();
  for (int i = 0; i < kSquarePixels; ++i)
    if (finest[i]) result[i] = linear_of_code[codes[i]];
  return result;
}

Lanes3<float> readTexels(const SquareTexels& at) {
  Texels top_left, top_right, bottom_left, bottom_right;
  for (int i = 0; i < kSquarePixels; ++i) {
    top_left[i] = load(at.top[i] + at.left[i]);
    top_right[i] = load(at.top[i] + at.right[i]);
    bottom_left[i] = load(at.bottom[i] + at.left[i]);
    bottom_right[i] = load(at.bottom[i] + at.right[i]);
  }
  const bool any_finest = std::any_of(at.finest.begin(), at.finest.end(), [](int finest) { return finest; });
  Lanes3<float> result;
  for (int c = 0; c < 3; ++c) {
    const Lanes<float> top_left_value = decode(top_left, c, at.finest, any_finest);
    const Lanes<float> top_right_value = decode(top_right, c, at.finest, any_finest);
    const Lanes<float> bottom_left_value = decode(bottom_left, c, at.finest, any_finest);
    const Lanes<float> bottom_right_value = decode(bottom_right, c, at.finest, any_finest);
    for (int i = 0; i < kSquarePixels; ++i)
      result[c][i] = mix(mix(top_left_value[i], top_right_value[i], at.across[i]),
                         mix(bottom_left_value[i], bottom_right_value[i], at.across[i]), at.down[i]);
  }
  return result;
}

}  // namespace

float sampleTexture(const Texture& texture, Wrap wrap_u, Wrap wrap_v, glm::vec2 uv, glm::vec2 duv_dx,
                    glm::vec2 duv_dy, int channel) {
  const double u = wrapCoordinate(uv.x, wrap_u);
  const double v = wrapCoordinate(uv.y, wrap_v);
  const MipLevel& finest = texture.levels.front();
  const float level =
      levelOf(footprintSize(finest.width, finest.height, duv_dx, duv_dy), float(texture.levels.size() - 1));
  const int finer = int(level);
  const float share = level - float(finer);
  const float fine = sampleLevel(texture, finer, wrap_u, wrap_v, u, v, channel);
  if (share == 0.0f) return fine;
  return mix(fine, sampleLevel(texture, finer + 1, wrap_u, wrap_v, u, v, channel), share);
}

Lanes3<float> sampleTextures(std::span<const Texture> textures, const Lanes<const TextureUse*>& uses,
                             const SquareFootprints& footprints) {
  const SquareMaps maps = squareMaps(textures, uses);
  Lanes<double> u, v, width, height;
  for (int i = 0; i < kSquarePixels; ++i) {
    width[i] = maps.levels[i]->width;
    height[i] = maps.levels[i]->height;
  }
  for (int i = 0; i < kSquarePixels; ++i) u[i] = wrapCoordinate(footprints.u[i], maps.wrap_u[i]);
  for (int i = 0; i < kSquarePixels; ++i) v[i] = wrapCoordinate(footprints.v[i], maps.wrap_v[i]);
  Lanes<std::int32_t> levels;
  Lanes<float> share;
  std::int32_t between = 0;
  for (int i = 0; i < kSquarePixels; ++i) {
    const float size = footprintSize(width[i], height[i], {footprints.du_dx[i], footprints.dv_dx[i]},
                                     {footprints.du_dy[i], footprints.dv_dy[i]});
    const float level = levelOf(size, maps.coarsest[i]);
    levels[i] = std::int32_t(level);
    share[i] = level - float(levels[i]);
    between |= share[i] != 0.0f;
  }
  const SquareTexels finer = findTexels(maps, levels, u, v);
  Lanes3<float> result = readTexels(finer);
  if (!between) return result;
  for (int i = 0; i < kSquarePixels; ++i) levels[i] += share[i] != 0.0f;
  const SquareTexels coarser = findTexels(maps, levels, u, v);
  const Lanes3<float> coarse = readTexels(coarser);
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < kSquarePixels; ++i) result[c][i] = mix(result[c][i], coarse[c][i], share[i]);
  return result;
}

}  // namespace luciole
