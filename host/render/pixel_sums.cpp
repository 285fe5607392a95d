#include "render/pixel_sums.hpp"
#include "kernels/shared.h"

#include <tbb/parallel_for.h>

#include <array>
#include <utility>
#include <vector>

namespace luciole {

PixelSums firstPoints(const GBuffer& layout, std::span<const std::uint16_t> samples, LitPlanes lit,
                      const PointCounts& counts) {
  const std::size_t n = layout.pixels(), width = std::size_t(layout.width);
  PixelSums sums{std::move(lit.color), Plane(counts.covered ? n : 0), Plane(counts.shadings ? n : 0),
                 std::move(lit.light_error), std::move(lit.half_width)};
  sums.color.resize(3 * n);
  const int tiles_x = layout.tiles_x;
  tbb::parallel_for(0, tiles_x * layout.tiles_y, [&](int tile) {
    const glm::ivec2 first = glm::ivec2(tile % tiles_x, tile / tiles_x) * int(kTileSize);
    const std::size_t at = std::size_t(tile) * kTilePixels, origin = layout.index(first.x, first.y);
    std::array<float, kTilePixels> factors{};
    const glm::ivec2 end = glm::min(glm::ivec2(kTileSize), glm::ivec2(layout.width, layout.height) - first);
    for (int y = 0; y < end.y; ++y)
      for (int x = 0; x < end.x; ++x)
        factors[layout.index(first.x + x, first.y + y) - origin] =
            float(samples[std::size_t(first.y + y) * width + std::size_t(first.x + x)]);
    for (Plane* plane : {&sums.color, &sums.light_error, &sums.half_width})
      for (int c = 0; c < 3 && !plane->empty(); ++c)
        for (std::size_t i = 0; i < kTilePixels; ++i) (*plane)[at + i + c * n] *= factors[i];
    for (std::size_t i = 0; i < kTilePixels && counts.covered; ++i) sums.covered[at + i] = factors[i];
    for (std::size_t i = 0; i < kTilePixels && counts.shadings; ++i)
      sums.shadings[at + i] = factors[i] > 0 ? 1.0f : 0.0f;
  });
  return sums;
}

void addPoints(const GBuffer& layout, const PointLists& points, std::size_t first_list, std::size_t end_list,
               const LitPlanes& lit, std::size_t stride, PixelSums& sums) {
  const std::size_t n = layout.pixels();
  std::vector<std::size_t> first_places;  // of each list in the planes
  for (std::size_t list = first_list, tiles = 0; list < end_list; tiles += tilesOf(points[list++]))
    first_places.push_back(tiles * kTilePixels);
  // All points of a pixel are in one list.
  tbb::parallel_for(first_list, end_list, [&](std::size_t list) {
    std::size_t place = first_places[list - first_list];
    for (const ShadingPoint& point : points[list]) {
      const std::uint32_t width = std::uint32_t(layout.width);
      const std::size_t i = layout.index(int(point.pixel % width), int(point.pixel / width));
      const float samples = float(point.samples);
      const auto add = [&](const Plane& from, Plane& sum) {
        for (int c = 0; c < 3 && !sum.empty(); ++c) sum[i + c * n] += samples * from[place + c * stride];
      };
      add(lit.color, sums.color);
      add(lit.light_error, sums.light_error);
      add(lit.half_width, sums.half_width);
      if (!sums.covered.empty()) sums.covered[i] += samples;
      if (!sums.shadings.empty()) sums.shadings[i] += 1.0f;
      ++place;
    }
  });
}

void addBackground(const glm::vec3& background, int samples, const Plane& covered, Plane& color) {
  const std::size_t n = covered.size();
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    const float bare = float(samples) - covered[i];
    for (int c = 0; c < 3; ++c) color[i + c * n] += bare * background[c];
  });
}

void addBackground(const Plane& background, int samples, const Plane& covered, Plane& color) {
  const std::size_t n = covered.size();
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    const float bare = float(samples) - covered[i];
    for (std::size_t c = 0; c < 3; ++c) color[i + c * n] += bare * background[i + c * n];
  });
}

}  // namespace luciole
