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
  std::array<std::vector<float>, 3> reflectance, light;  ///< light = color / reflectance
  std::vector<float> brightness;                         ///< the largest component of the colour
};

void readRow(const GBuffer& gbuffer, const Plane& color, int y, PixelRow& row) {
  const std::size_t stride = gbuffer.pixels(), tiles = std::size_t(gbuffer.tiles_x);
  std::array<std::size_t, kTileSize> places;
  for (int x = 0; x < kTileSize; ++x) places[x] = gbuffer.index(x, y);
  row.brightness.assign(tiles * kTileSize, 0.0f);
  for (int c = 0; c < 3; ++c) {
    for (auto* values : {&row.reflectance, &row.light}) (*values)[c].resize(tiles * kTileSize);
    const float* colors = color.data() + c * stride;
    const float* reflectances = gbuffer.diffuse.data() + c * stride;
    float *to_light = row.light[c].data(), *to_reflectance = row.reflectance[c].data();
    for (std::size_t tile = 0; tile < tiles; ++tile)
      for (int x = 0; x < kTileSize; ++x) {
        const std::size_t place = tile * kTilePixels + places[x];
        to_light[tile * kTileSize + x] = colors[place];
        to_reflectance[tile * kTileSize + x] = reflectances[place];
      }
    float* brightness = row.brightness.data();
    for (std::size_t x = 0; x < tiles * kTileSize; ++x) {
      brightness[x] = std::max(brightness[x], to_light[x]);
      to_light[x] /= to_reflectance[x];
    }
  }
}

/// Three neighbouring rows, or columns, of pixels.
struct NeighbourRows {
  const PixelRow &before, &here, &after;
};

/// The axes along which a pixel may be uneven, as bits.
enum SuspectAxis : std::uint8_t { kAcross = 1, kDown = 2 };

/// A quick test without surfaces: sets the bit `axis` of `suspect` for the pixels of a row, from x = first up
/// to end, that differ by more than allowed from their neighbours on both sides, or on either one, whichever
/// of these lie on the same surface; with 1 % to spare for rounding. The others are even. The neighbours of x
/// are at x − step and x + step of their rows. Where a reflectance is 0 the light is not a number, and the
/// pixel is suspect.
void findSuspects(const NeighbourRows& rows, int step, int first, int end, float most_uneven,
                  SuspectAxis axis, std::uint8_t* suspect) {
  const float allowed = 0.99f * most_uneven;
  const float* bright = rows.here.brightness.data();
  const float *bright_before = rows.before.brightness.data(), *bright_after = rows.after.brightness.data();
  for (int c = 0; c < 3; ++c) {
    const float *reflectance = rows.here.reflectance[c].data(), *light = rows.here.light[c].data();
    const float *before = rows.before.light[c].data(), *after = rows.after.light[c].data();
    for (int x = first; x < end; ++x) {
      const float half = 0.5f * reflectance[x];
      const float to_before = half * (before[x - step] - light[x]),
                  to_after = half * (after[x + step] - light[x]);
      const float of_before = std::max(bright[x], bright_before[x - step]),
                  of_after = std::max(bright[x], bright_after[x + step]);
      const bool differs = !(std::abs(to_before) <= allowed * of_before) |
                           !(std::abs(to_after) <= allowed * of_after) |
                           !(std::abs(to_before + to_after) <= allowed * std::max(of_before, of_after));
      suspect[x] |= std::uint8_t(differs ? axis : 0);
    }
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
      const PixelRow& here = rows[std::size_t(y % 3)];
      findSuspects({rows[std::size_t(above % 3)], here, rows[std::size_t(below % 3)]}, 0, first.x, end.x,
                   most_uneven, kDown, row);
      // At the picture's sides, where a neighbour is missing, all are suspect.
      const int left = std::max(first.x, 1), right = std::min(end.x, width - 1);
      if (first.x < left) row[first.x] |= kAcross;
      if (right < end.x) row[right] |= kAcross;
      findSuspects({here, here, here}, 1, left, right, most_uneven, kAcross, row);
      for (int x = first.x; x < end.x; ++x) {
        const glm::ivec2 pixel(x, y);
        row[x] = objectAt(pixel) != kNoObject && (((row[x] & kAcross) && is_uneven(pixel, {1, 0})) ||
                                                  ((row[x] & kDown) && is_uneven(pixel, {0, 1})));
      }
    }
  });
  return uneven;
}

}  // namespace luciole
