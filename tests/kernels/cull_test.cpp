#include "render/cull.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <random>

#include "kernels/probe.hpp"

namespace luciole::test {
namespace {

constexpr int kSinglePixel = 77;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Reach {
  std::vector<std::array<float, 4>> lights;  // x, y, z, 1 / range²

  /// Planes as ShadeLights::reach has them, padded with lights that reach nothing.
  Plane planes(std::size_t& stride) const {
    stride = (lights.size() + 15) / 16 * 16;
    Plane result(4 * stride, 0.0f);
    for (std::size_t i = 0; i < stride; ++i)
      for (int c = 0; c < 4; ++c)
        result[i + c * stride] = i < lights.size() ? lights[i][c] : c == 3 ? 1.0f : c == 0 ? 1e18f : 0.0f;
    return result;
  }
};

/// The lists on the host.
struct Lists {
  std::vector<cl_uint> starts, list;
};

Lists runCull(int lanes, const Plane& position, const Reach& reach) {
  Device& device = deviceWithLanes(lanes);
  std::size_t reach_stride = 0;
  const Plane reach_planes = reach.planes(reach_stride);
  const cl::Buffer position_buffer = inputBuffer(device, position),
                   reach_buffer = inputBuffer(device, reach_planes);
  const LightLists lists = cull(device, {.position = position_buffer,
                                         .plane_stride = position.size() / 3,
                                         .reach = reach_buffer,
                                         .reach_stride = reach_stride});
  Lists result;
  result.starts.resize(position.size() / 3 / kTilePixels + 1);
  result.list.resize(lists.entries);
  readBuffer(device, lists.starts, result.starts.data(), result.starts.size() * sizeof(cl_uint));
  readBuffer(device, lists.list, result.list.data(), result.list.size() * sizeof(cl_uint));
  return result;
}

/// Tiles with points around centres of their own; tile 1 and the last are background, tile 2 has a single
/// point, and a third of all other points is background.
Plane tilesOfPoints(int tiles, std::mt19937& random) {
  std::uniform_real_distribution<float> spread(-1, 1);
  const std::size_t n = std::size_t(tiles) * kTilePixels;
  Plane position(3 * n, 0.0f);
  for (int tile = 0; tile < tiles; ++tile) {
    const float center[3] = {10 * spread(random), 10 * spread(random), -12 + 10 * spread(random)};
    for (int pixel = 0; pixel < kTilePixels; ++pixel) {
      const std::size_t place = std::size_t(tile) * kTilePixels + pixel;
      const bool background =
          tile == 1 || tile == tiles - 1 || (tile == 2 ? pixel != kSinglePixel : random() % 3 == 0);
      for (int c = 0; c < 3; ++c) position[place + c * n] = background ? 0.0f : center[c] + spread(random);
      if (background) position[place + 2 * n] = -kInfinity;
    }
  }
  return position;
}

/// Lights all around, and as many again that just reach the one point of tile 2, or just don't.
Reach randomReach(int count, const Plane& position, std::mt19937& random) {
  std::uniform_real_distribution<float> spread(-1, 1);
  Reach reach;
  for (int i = 0; i < count; ++i) {
    const float range = 0.05f + 4 * std::abs(spread(random));
    reach.lights.push_back({12 * spread(random), 12 * spread(random), -12 + 12 * spread(random),
                            i % 100 == 17 ? 0.0f : 1 / (range * range)});
  }
  const std::size_t place = 2 * kTilePixels + kSinglePixel, n = position.size() / 3;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 way = glm::normalize(glm::dvec3(spread(random), spread(random), spread(random) + 1e-3f));
    const double range = 0.05 + 4 * std::abs(spread(random)), share = 1 + 1e-4 * spread(random);
    std::array<float, 4> light{0, 0, 0, float(1 / (range * range))};
    for (int c = 0; c < 3; ++c) light[c] = float(position[place + c * n] + way[c] * range * share);
    reach.lights.push_back(light);
  }
  return reach;
}

// Squared distances have 2 roundings of a difference and 3 of the sum, the product with 1/range² one more:
// any light whose ratio is farther than this from 1 is told apart.
constexpr double kMargin = 8 * 0x1p-24;

TEST(CullKernels, ListsHoldWhatReachesATileAndNothingThatCannot) {
  std::mt19937 random(4);
  constexpr int kTiles = 24;
  const Plane position = tilesOfPoints(kTiles, random);
  const std::size_t n = position.size() / 3;
  const Reach reach = randomReach(1000, position, random);
  for (const int lanes : kAllLanes) {
    const Lists lists = runCull(lanes, position, reach);
    ASSERT_EQ(lists.starts[0], 0u);
    std::size_t listed = 0, needed = 0;
    for (int tile = 0; tile < kTiles; ++tile) {
      ASSERT_LE(lists.starts[tile], lists.starts[tile + 1]);
      const auto first = lists.list.begin() + lists.starts[tile],
                 last = lists.list.begin() + lists.starts[tile + 1];
      ASSERT_EQ(std::adjacent_find(first, last, std::greater_equal<>()), last)
          << "indices ascend, none twice";
      if (tile == 1 || tile == kTiles - 1) {
        ASSERT_EQ(first, last) << "a tile of background";
      }
      double low[3] = {1e30, 1e30, 1e30}, high[3] = {-1e30, -1e30, -1e30};
      std::vector<std::array<double, 3>> points;
      for (int pixel = 0; pixel < kTilePixels; ++pixel) {
        const std::size_t place = std::size_t(tile) * kTilePixels + pixel;
        if (position[place + 2 * n] == -kInfinity) continue;
        points.push_back({position[place], position[place + n], position[place + 2 * n]});
        for (int c = 0; c < 3; ++c) {
          low[c] = std::min(low[c], points.back()[c]);
          high[c] = std::max(high[c], points.back()[c]);
        }
      }
      for (std::size_t i = 0; i < reach.lights.size(); ++i) {
        const auto& light = reach.lights[i];
        const auto ratio = [&](const auto& difference) {
          double sum = 0;
          for (int c = 0; c < 3; ++c) sum += difference(c) * difference(c);
          return sum * light[3];
        };
        double nearest = 1e30;
        for (const auto& p : points)
          nearest = std::min(nearest, ratio([&](int c) { return light[c] - p[c]; }));
        const double to_box = ratio([&](int c) {
          return std::max({low[c] - light[c], light[c] - high[c], 0.0});
        });
        const bool is_listed = std::binary_search(first, last, cl_uint(i));
        listed += is_listed;
        needed += nearest < 1;
        ASSERT_TRUE(is_listed || nearest >= 1 - kMargin) << "light " << i << ", tile " << tile;
        ASSERT_FALSE(is_listed && (points.empty() || to_box > 1 + kMargin))
            << "light " << i << ", tile " << tile;
      }
    }
    ASSERT_EQ(listed, lists.list.size());
    ASSERT_GT(needed, 100u) << "the case tests something";
  }
}

TEST(CullKernels, ListsGrowAsLongAsTheyMust) {
  std::mt19937 random(9);
  const Plane position = tilesOfPoints(6, random);
  Reach reach;
  reach.lights.assign(20001, {0, 0, 0, 0});  // all reach everywhere
  for (const int lanes : kAllLanes) {
    const Lists lists = runCull(lanes, position, reach);
    ASSERT_EQ(lists.starts, (std::vector<cl_uint>{0, 20001, 20001, 40002, 60003, 80004, 80004}))
        << lanes << " lanes";
    for (std::size_t entry = 0; entry < lists.list.size(); ++entry)
      ASSERT_EQ(lists.list[entry], entry % 20001);
  }
}

TEST(CullKernels, NoLightsAndNoPixelsMakeEmptyLists) {
  std::mt19937 random(9);
  Plane background = tilesOfPoints(3, random);
  std::fill(background.begin() + 2 * background.size() / 3, background.end(), -kInfinity);
  for (const int lanes : kAllLanes) {
    const Lists none = runCull(lanes, tilesOfPoints(3, random), {});
    EXPECT_EQ(none.starts, std::vector<cl_uint>(4, 0)) << lanes << " lanes";
    const Lists unlit = runCull(lanes, background, randomReach(33, background, random));
    EXPECT_EQ(unlit.starts, std::vector<cl_uint>(4, 0)) << lanes << " lanes";
  }
}

TEST(CullKernels, PaddingIsNeverListed) {
  // One light: the 15 that fill its row up lie 10^18 m away.
  std::mt19937 random(9);
  Reach reach;
  reach.lights.assign(1, {0, 0, 0, 0});
  for (const int lanes : kAllLanes)
    EXPECT_EQ(runCull(lanes, tilesOfPoints(4, random), reach).list, (std::vector<cl_uint>{0, 0}))
        << lanes << " lanes";
}

}  // namespace
}  // namespace luciole::test
