#include "raster/uneven_pixels.hpp"
#include "kernels/shared.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace luciole {
namespace {

/// Three points in a row, as places in the planes; the outer two may be the same.
struct PointsInRow {
  std::size_t before, here, after;
};

/// The unevenness of one component, in units of the colour.
float unevenness(const PointsInRow& row, const float* color, const float* reflectance) {
  const float before = reflectance[row.before], here = reflectance[row.here], after = reflectance[row.after];
  const float lit = color[row.here];
  // Where a reflectance is 0 its light is not known.
  if (!(before > 0.0f && here > 0.0f && after > 0.0f))
    return std::abs(0.5f * (color[row.before] + color[row.after]) - lit);
  return std::abs(0.5f * (color[row.before] * (here / before) + color[row.after] * (here / after)) - lit);
}

/// Whether two neighbouring points, by their places in the planes, lie on a continuous surface: their normals
/// differ by less than 26°, and the line between them is within 30° of both tangent planes.
bool isContinuous(const GBuffer& gbuffer, std::size_t a, std::size_t b) {
  const std::size_t stride = gbuffer.pixels();
  const auto vectorAt = [&](const Plane& group, std::size_t i) {
    return glm::vec3(group[i], group[i + stride], group[i + 2 * stride]);
  };
  const glm::vec3 of_a = vectorAt(gbuffer.normal, a), of_b = vectorAt(gbuffer.normal, b);
  const glm::vec3 step = vectorAt(gbuffer.position, b) - vectorAt(gbuffer.position, a);
  const float most = 0.5f * glm::length(step);
  return glm::dot(of_a, of_b) > 0.9f && std::abs(glm::dot(of_a, step)) <= most &&
         std::abs(glm::dot(of_b, step)) <= most;
}

/// Rows of a picture's pixels from left to right.
struct PixelRow {
  std::array<std::vector<float>, 3> color, reflectance, light;  ///< light = color / reflectance
};

void readRow(const GBuffer& gbuffer, const Plane& color, int y, PixelRow& row) {
  const std::size_t stride = gbuffer.pixels(), tiles = std::size_t(gbuffer.tiles_x);
  std::array<std::size_t, kTileSize> places;
  for (int x = 0; x < kTileSize; ++x) places[x] = gbuffer.index(x, y);
  for (int c = 0; c < 3; ++c) {
    for (auto* values : {&row.color, &row.reflectance, &row.light}) (*values)[c].resize(tiles * kTileSize);
    const float* colors = color.data() + c * stride;
    const float* reflectances = gbuffer.diffuse.data() + c * stride;
    float *to_color = row.color[c].data(), *to_reflectance = row.reflectance[c].data();
    for (std::size_t tile = 0; tile < tiles; ++tile)
      for (int x = 0; x < kTileSize; ++x) {
        const std::size_t place = tile * kTilePixels + places[x];
        to_color[tile * kTileSize + x] = colors[place];
        to_reflectance[tile * kTileSize + x] = reflectances[place];
      }
    float* to_light = row.light[c].data();
    for (std::size_t x = 0; x < tiles * kTileSize; ++x) to_light[x] = to_color[x] / to_reflectance[x];
  }
}

/// A quick test without surfaces: sets `suspect` to 0 for the pixels of a row, from x = first up to end,
/// whose two neighbours along each axis differ from them by less than allowed, summed up, with 1 % to spare
/// for rounding. These are even. Where a reflectance is 0 the light is not a number, and the pixel is
/// suspect.
void findSuspects(const PixelRow& above, const PixelRow& row, const PixelRow& below, int first, int end,
                  float most_uneven, std::uint8_t* suspect) {
  std::fill(suspect + first, suspect + end, std::uint8_t(0));
  const float *red = row.color[0].data(), *green = row.color[1].data(), *blue = row.color[2].data();
  const int last = end - 1;
  for (int c = 0; c < 3; ++c) {
    const float *reflectance = row.reflectance[c].data(), *light = row.light[c].data();
    const float *up = above.light[c].data(), *down = below.light[c].data();
    const auto test = [&](int x, int left, int right) {
      const float allowed = 0.99f * most_uneven * std::max(std::max(red[x], green[x]), blue[x]);
      const float scale = 0.5f * reflectance[x];
      const float across = scale * (std::abs(light[left] - light[x]) + std::abs(light[right] - light[x]));
      const float along = scale * (std::abs(up[x] - light[x]) + std::abs(down[x] - light[x]));
      suspect[x] |= std::uint8_t(!(across <= allowed) | !(along <= allowed));
    };
    test(first, std::max(first - 1, 0), std::min(first + 1, int(row.light[c].size()) - 1));
    for (int x = first + 1; x < last; ++x) test(x, x - 1, x + 1);
    test(last, std::max(last - 1, 0), std::min(last + 1, int(row.light[c].size()) - 1));
  }
}

}  // namespace

std::vector<std::uint8_t> unevenPixels(const SampledView& sampled, const SharedSamples& shared,
                                       const Plane& color) {
  const GBuffer& gbuffer = shared.gbuffer;
  const std::size_t stride = gbuffer.pixels();
  const int width = gbuffer.width;
  const float most_uneven = mostUneven(sampled.pattern.count);
  const auto objectAt = [&](const glm::ivec2& pixel) {
    const bool inside = pixel.x >= 0 && pixel.y >= 0 && pixel.x < width && pixel.y < gbuffer.height;
    return inside ? shared.objects[std::size_t(pixel.y) * width + pixel.x] : kNoObject;
  };
  const auto is_uneven = [&](const glm::ivec2& pixel, const glm::ivec2& step) {
    const std::size_t here = gbuffer.index(pixel.x, pixel.y);
    const auto same_surface = [&](const glm::ivec2& other) {
      return objectAt(other) == objectAt(pixel) &&
             isContinuous(gbuffer, here, gbuffer.index(other.x, other.y));
    };
    const bool before = same_surface(pixel - step), after = same_surface(pixel + step);
    if (!before && !after) return false;
    const glm::ivec2 first = before ? pixel - step : pixel + step, last = after ? pixel + step : first;
    const PointsInRow row{gbuffer.index(first.x, first.y), here, gbuffer.index(last.x, last.y)};
    const float share = before && after ? 1.0f : 0.5f;
    float most = 0, brightest = 0;
    for (int c = 0; c < 3; ++c) {
      const float* of_color = color.data() + c * stride;
      most = std::max(most, share * unevenness(row, of_color, gbuffer.diffuse.data() + c * stride));
      brightest = std::max({brightest, of_color[row.before], of_color[row.here], of_color[row.after]});
    }
    return most > most_uneven * brightest;
  };
  std::vector<std::uint8_t> uneven(shared.objects.size());
  const glm::ivec2 crop = sampled.view.crop_origin;
  const glm::ivec2 first = sampled.inner.first - crop, end = sampled.inner.end - crop;
  constexpr int kRows = 2 * kTileSize;  // a task
  tbb::parallel_for(0, (end.y - first.y + kRows - 1) / kRows, [&](int task) {
    const int from = first.y + task * kRows, to = std::min(from + kRows, end.y);
    std::array<PixelRow, 3> rows;  // of y at y % 3
    const auto read = [&](int y) { readRow(gbuffer, color, y, rows[std::size_t(y % 3)]); };
    for (int y = std::max(from - 1, 0); y <= from; ++y) read(y);
    for (int y = from; y < to; ++y) {
      const int above = std::max(y - 1, 0), below = std::min(y + 1, gbuffer.height - 1);
      if (below > y) read(below);
      std::uint8_t* row = uneven.data() + std::size_t(y) * width;
      findSuspects(rows[std::size_t(above % 3)], rows[std::size_t(y % 3)], rows[std::size_t(below % 3)],
                   first.x, end.x, most_uneven, row);
      for (int x = first.x; x < end.x; ++x) {
        const glm::ivec2 pixel(x, y);
        row[x] =
            row[x] && objectAt(pixel) != kNoObject && (is_uneven(pixel, {1, 0}) || is_uneven(pixel, {0, 1}));
      }
    }
  });
  return uneven;
}

}  // namespace luciole
