#include "raster/sample_texture.hpp"

#include <algorithm>
#include <cmath>

#include "image/srgb.hpp"

namespace luciole {
namespace {

/// Brings a coordinate into [0, 1]. The subtractions are exact for any finite float.
double wrapCoordinate(float coordinate, Wrap wrap) {
  const double t = std::isfinite(coordinate) ? coordinate : 0.0f;
  switch (wrap) {
    case Wrap::kRepeat:
      return t - std::floor(t);
    case Wrap::kMirroredRepeat: {
      const double in_pair = t - 2.0 * std::floor(0.5 * t);
      return in_pair > 1.0 ? 2.0 - in_pair : in_pair;
    }
    case Wrap::kClampToEdge:
      break;
  }
  return std::clamp(t, 0.0, 1.0);
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

glm::vec4 texel(const std::uint16_t* codes, const float* decode) {
  return {decode[codes[0]], decode[codes[1]], decode[codes[2]], codes[3] * (1.0f / 65535.0f)};
}

glm::vec4 sampleLevel(const MipLevel& level, Wrap wrap_u, Wrap wrap_v, double u, double v) {
  const Neighbours column = neighbours(u, level.width, wrap_u);
  const Neighbours row = neighbours(v, level.height, wrap_v);
  const float* decode = linearOfSrgb16().data();
  const std::uint16_t* top = level.texels.data() + std::size_t(row.first) * level.width * 4;
  const std::uint16_t* bottom = level.texels.data() + std::size_t(row.second) * level.width * 4;
  const std::size_t left = std::size_t(column.first) * 4;
  const std::size_t right = std::size_t(column.second) * 4;
  return glm::mix(glm::mix(texel(top + left, decode), texel(top + right, decode), column.share),
                  glm::mix(texel(bottom + left, decode), texel(bottom + right, decode), column.share),
                  row.share);
}

}  // namespace

glm::vec4 sampleTexture(const Texture& texture, Wrap wrap_u, Wrap wrap_v, glm::vec2 uv, glm::vec2 duv_dx,
                        glm::vec2 duv_dy) {
  const double u = wrapCoordinate(uv.x, wrap_u);
  const double v = wrapCoordinate(uv.y, wrap_v);
  const glm::dvec2 size(texture.levels[0].width, texture.levels[0].height);
  const glm::dvec2 side_x = glm::dvec2(duv_dx) * size;
  const glm::dvec2 side_y = glm::dvec2(duv_dy) * size;
  const double longer = std::max(glm::dot(side_x, side_x), glm::dot(side_y, side_y));
  // OpenGL 4.6, equations 8.7 and 8.8: the level is the logarithm of the footprint's longer side in texels.
  if (!(longer > 1.0)) return sampleLevel(texture.levels[0], wrap_u, wrap_v, u, v);
  const float coarsest = float(texture.levels.size() - 1);
  const float level = std::min(0.5f * std::log2(float(longer)), coarsest);
  const std::size_t finer = std::size_t(level);
  const float share = level - float(finer);
  const glm::vec4 fine = sampleLevel(texture.levels[finer], wrap_u, wrap_v, u, v);
  if (share == 0.0f) return fine;
  return glm::mix(fine, sampleLevel(texture.levels[finer + 1], wrap_u, wrap_v, u, v), share);
}

}  // namespace luciole
