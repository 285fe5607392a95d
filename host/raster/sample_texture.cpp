#include "raster/sample_texture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "image/srgb.hpp"

namespace luciole {
namespace {

/// Brings a coordinate into [0, 1]. The subtractions are exact for any finite float.
double wrapCoordinate(float coordinate, Wrap wrap) {
  const double t = std::abs(coordinate) <= std::numeric_limits<float>::max() ? coordinate : 0.0f;
  if (wrap == Wrap::kRepeat) return t - std::floor(t);
  if (wrap == Wrap::kClampToEdge) return std::clamp(t, 0.0, 1.0);
  const double in_pair = t - 2.0 * std::floor(0.5 * t);
  return in_pair > 1.0 ? 2.0 - in_pair : in_pair;
}

/// The two texels on either side of a point along one axis, and the second one's share.
struct Neighbours {
  int first;
  int second;
  float share;
};

Neighbours neighbours(double wrapped, int size, Wrap wrap) {
  const double place = wrapped * size - 0.5;
  const double below = std::floor(place);
  const int first = int(below);
  // At a mirror the texel beyond the edge is the edge texel again, as it is where coordinates are clamped.
  const bool repeat = wrap == Wrap::kRepeat;
  return {first < 0 ? (repeat ? size - 1 : 0) : std::min(first, size - 1),
          first + 1 < size ? first + 1 : (repeat ? 0 : size - 1), float(place - below)};
}

float sampleLevel(const MipLevel& level, Wrap wrap_u, Wrap wrap_v, double u, double v, int channel) {
  const Neighbours column = neighbours(u, level.width, wrap_u);
  const Neighbours row = neighbours(v, level.height, wrap_v);
  const float* decode = linearOfSrgb16().data();
  const auto value = [&](int x, int y) {
    const std::uint16_t code = level.texels[(std::size_t(y) * level.width + x) * 4 + channel];
    return channel == 3 ? code * (1.0f / 65535.0f) : decode[code];
  };
  return glm::mix(glm::mix(value(column.first, row.first), value(column.second, row.first), column.share),
                  glm::mix(value(column.first, row.second), value(column.second, row.second), column.share),
                  row.share);
}

/// The square of the longer side of a pixel's footprint, in texels of the finest level.
float footprintSize(const Texture& texture, const glm::vec2& duv_dx, const glm::vec2& duv_dy) {
  const glm::dvec2 size(texture.levels[0].width, texture.levels[0].height);
  const glm::dvec2 side_x = glm::dvec2(duv_dx) * size;
  const glm::dvec2 side_y = glm::dvec2(duv_dy) * size;
  return float(std::max(glm::dot(side_x, side_x), glm::dot(side_y, side_y)));
}

/// The finer of the two levels that a footprint lies between, and the share of the next.
struct LevelPlace {
  std::int32_t finer;
  float share;
};

/// OpenGL 4.6, equations 8.7 and 8.8: the level is the logarithm of the footprint's longer side in texels.
LevelPlace levelPlace(const Texture& texture, float size) {
  if (!(size > 1.0f)) return {0, 0.0f};
  const float level = std::min(0.5f * std::log2(size), float(texture.levels.size() - 1));
  return {std::int32_t(level), level - float(std::int32_t(level))};
}

/// A square's colours from one level each, which may differ from pixel to pixel.
Lanes3<float> sampleLevels(const Texture& texture, const Lanes<std::int32_t>& levels, Wrap wrap_u,
                           Wrap wrap_v, const Lanes<double>& u, const Lanes<double>& v,
                           const LaneMask& wanted) {
  Lanes<std::int32_t> width, height;
  Lanes<const std::uint16_t*> texels;
  for (int i = 0; i < kSquarePixels; ++i) {
    const MipLevel& level = texture.levels[std::size_t(levels[i])];
    width[i] = level.width;
    height[i] = level.height;
    texels[i] = level.texels.data();
  }
  Lanes<std::int64_t> top, bottom;
  Lanes<std::int32_t> left, right;
  Lanes<float> across, down;
  for (int i = 0; i < kSquarePixels; ++i) {
    const Neighbours column = neighbours(u[i], width[i], wrap_u);
    left[i] = column.first * 4;
    right[i] = column.second * 4;
    across[i] = column.share;
  }
  for (int i = 0; i < kSquarePixels; ++i) {
    const Neighbours row = neighbours(v[i], height[i], wrap_v);
    top[i] = std::int64_t(row.first) * width[i] * 4;
    bottom[i] = std::int64_t(row.second) * width[i] * 4;
    down[i] = row.share;
  }
  Lanes3<float> top_left, top_right, bottom_left, bottom_right;
  const float* decode = linearOfSrgb16().data();
  for (int i = 0; i < kSquarePixels; ++i) {
    if (!wanted[i]) continue;
    const std::uint16_t *top_row = texels[i] + top[i], *bottom_row = texels[i] + bottom[i];
    for (int c = 0; c < 3; ++c) {
      top_left[c][i] = decode[top_row[left[i] + c]];
      top_right[c][i] = decode[top_row[right[i] + c]];
      bottom_left[c][i] = decode[bottom_row[left[i] + c]];
      bottom_right[c][i] = decode[bottom_row[right[i] + c]];
    }
  }
  Lanes3<float> result;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < kSquarePixels; ++i)
      result[c][i] = glm::mix(glm::mix(top_left[c][i], top_right[c][i], across[i]),
                              glm::mix(bottom_left[c][i], bottom_right[c][i], across[i]), down[i]);
  return result;
}

}  // namespace

float sampleTexture(const Texture& texture, Wrap wrap_u, Wrap wrap_v, glm::vec2 uv, glm::vec2 duv_dx,
                    glm::vec2 duv_dy, int channel) {
  const double u = wrapCoordinate(uv.x, wrap_u);
  const double v = wrapCoordinate(uv.y, wrap_v);
  const LevelPlace place = levelPlace(texture, footprintSize(texture, duv_dx, duv_dy));
  const float fine = sampleLevel(texture.levels[place.finer], wrap_u, wrap_v, u, v, channel);
  if (place.share == 0.0f) return fine;
  const float coarse = sampleLevel(texture.levels[place.finer + 1], wrap_u, wrap_v, u, v, channel);
  return glm::mix(fine, coarse, place.share);
}

Lanes3<float> sampleTexture(const Texture& texture, Wrap wrap_u, Wrap wrap_v,
                            const SquareFootprints& footprints, const LaneMask& wanted) {
  Lanes<double> u, v;
  for (int i = 0; i < kSquarePixels; ++i) u[i] = wrapCoordinate(footprints.u[i], wrap_u);
  for (int i = 0; i < kSquarePixels; ++i) v[i] = wrapCoordinate(footprints.v[i], wrap_v);
  Lanes<float> size;
  for (int i = 0; i < kSquarePixels; ++i)
    size[i] = footprintSize(texture, {footprints.du_dx[i], footprints.dv_dx[i]},
                            {footprints.du_dy[i], footprints.dv_dy[i]});
  Lanes<std::int32_t> level{};
  Lanes<float> share{};
  bool between = false;
  for (int i = 0; i < kSquarePixels; ++i) {
    if (!wanted[i]) continue;
    const LevelPlace place = levelPlace(texture, size[i]);
    level[i] = place.finer;
    share[i] = place.share;
    between |= place.share != 0.0f;
  }
  Lanes3<float> result = sampleLevels(texture, level, wrap_u, wrap_v, u, v, wanted);
  if (!between) return result;
  for (int i = 0; i < kSquarePixels; ++i) level[i] += share[i] != 0.0f;
  const Lanes3<float> coarse = sampleLevels(texture, level, wrap_u, wrap_v, u, v, wanted);
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < kSquarePixels; ++i) result[c][i] = glm::mix(result[c][i], coarse[c][i], share[i]);
  return result;
}

}  // namespace luciole
