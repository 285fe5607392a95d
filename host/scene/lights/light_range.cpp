#include "scene/lights/light_range.hpp"

#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "luciole/error.hpp"
#include "scene/bounds.hpp"
#include "scene/z_curve.hpp"

namespace luciole {
namespace {

constexpr double kShortestRange = 1e-18;
constexpr double kLongestRange = 1e18;

/// Among the distances of all pairs of a point and a light, the search is for the one with rank `wanted`
/// (from 1). It is a radix selection over the bits of squared distances, which are ordered as the doubles
/// are: each pass counts pairs in buckets, and the next pass divides one bucket. Lights are put into blocks
/// of neighbours, so that for most pairs of a point and a block the block's box decides.
constexpr std::size_t kBlockLights = 64;
constexpr int kBucketBits = 14;
constexpr std::uint64_t kBuckets = std::uint64_t{1} << kBucketBits;

std::uint64_t keyOf(double squared) { return std::bit_cast<std::uint64_t>(squared); }

struct Blocks {
  std::vector<double> x, y, z;          ///< of the lights
  std::vector<glm::dvec3> lows, highs;  ///< of the blocks' boxes

  std::size_t count() const { return lows.size(); }
  std::size_t first(std::size_t block) const { return block * kBlockLights; }
  std::size_t size(std::size_t block) const { return std::min(kBlockLights, x.size() - first(block)); }
};

/// Blocks of lights along a Z curve through the lights' bounding box.
Blocks makeBlocks(std::span<const Light> lights) {
  glm::dvec3 low(1e300), high(-1e300);
  for (const Light& light : lights) {
    low = glm::min(low, light.position);
    high = glm::max(high, light.position);
  }
  struct Placed {
    std::uint64_t code;
    glm::dvec3 position;
  };
  std::vector<Placed> placed(lights.size());
  constexpr double kCells = (1 << 21) - 1;
  tbb::parallel_for(std::size_t{0}, lights.size(), [&](std::size_t i) {
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double side = high[axis] - low[axis];
      const double share = side > 0 ? (lights[i].position[axis] - low[axis]) / side : 0;
      code |= everyThirdBit(static_cast<std::uint64_t>(share * kCells)) << axis;
    }
    placed[i] = {code, lights[i].position};
  });
  tbb::parallel_sort(placed.begin(), placed.end(),
                     [](const Placed& a, const Placed& b) { return a.code < b.code; });
  Blocks blocks;
  for (const Placed& one : placed) {
    if (blocks.x.size() % kBlockLights == 0) {
      blocks.lows.push_back(one.position);
      blocks.highs.push_back(one.position);
    }
    blocks.x.push_back(one.position.x);
    blocks.y.push_back(one.position.y);
    blocks.z.push_back(one.position.z);
    blocks.lows.back() = glm::min(blocks.lows.back(), one.position);
    blocks.highs.back() = glm::max(blocks.highs.back(), one.position);
  }
  return blocks;
}

double squaredLength(const glm::dvec3& v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

/// Bounds of the squared distances from a point to a block's lights. They hold for the computed distances
/// too: rounding is monotonic, and the operations are the same.
struct Reach {
  double nearest, farthest;
};
Reach reachOf(const Blocks& blocks, std::size_t block, const glm::dvec3& point) {
  const glm::dvec3 to_low = blocks.lows[block] - point;
  const glm::dvec3 to_high = blocks.highs[block] - point;
  return {squaredLength(glm::max(glm::max(to_low, -to_high), glm::dvec3(0))),
          squaredLength(glm::max(-to_low, to_high))};
}

using Histogram = std::vector<std::uint64_t>;
struct Tally {
  std::uint64_t below = 0;
  Histogram first, second;
};

template <class Visit>
Tally tallyPairs(const Blocks& blocks, std::size_t points, std::size_t buckets, const Visit& visit) {
  tbb::combinable<Tally> tallies([&] { return Tally{0, Histogram(buckets), Histogram(buckets)}; });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.count()), [&](const auto& range) {
    Tally& tally = tallies.local();
    for (std::size_t block = range.begin(); block < range.end(); ++block)
      for (std::size_t point = 0; point < points; ++point) visit(block, point, tally);
  });
  Tally sum{0, Histogram(buckets), Histogram(buckets)};
  tallies.combine_each([&](const Tally& one) {
    sum.below += one.below;
    for (std::size_t i = 0; i < buckets; ++i) {
      sum.first[i] += one.first[i];
      sum.second[i] += one.second[i];
    }
  });
  return sum;
}

/// The bucket that holds rank `wanted` (from 1). Subtracts from `wanted` the count of all buckets before it.
std::uint64_t bucketOf(const Histogram& histogram, std::uint64_t& wanted) {
  std::uint64_t bucket = 0;
  while (wanted > histogram[bucket]) wanted -= histogram[bucket++];
  return bucket;
}

/// Where the wanted pair's key lies: low ≤ key < high.
struct Bracket {
  std::uint64_t low, high;
};

/// A first bracket from the boxes alone. Below any distance there are at most as many pairs as pairs whose
/// block's nearest point is below it, and at least as many as pairs whose block's farthest point is.
Bracket bracketByBoxes(const Blocks& blocks, std::span<const glm::dvec3> points, std::uint64_t wanted) {
  constexpr int kShift = 48;
  const Tally tally = tallyPairs(blocks, points.size(), std::size_t{1} << (64 - kShift),
                                 [&](std::size_t block, std::size_t point, Tally& to) {
                                   const Reach reach = reachOf(blocks, block, points[point]);
                                   to.first[keyOf(reach.nearest) >> kShift] += blocks.size(block);
                                   to.second[keyOf(reach.farthest) >> kShift] += blocks.size(block);
                                 });
  std::uint64_t by_nearest = wanted, by_farthest = wanted;
  return {bucketOf(tally.first, by_nearest) << kShift, (bucketOf(tally.second, by_farthest) + 1) << kShift};
}

/// Counts the pairs below the bracket, and those in it by buckets of 2^shift keys.
Tally tallyBracket(const Blocks& blocks, std::span<const glm::dvec3> points, const Bracket& bracket,
                   int shift) {
  return tallyPairs(blocks, points.size(), kBuckets, [&](std::size_t block, std::size_t point, Tally& to) {
    const glm::dvec3 p = points[point];
    const Reach reach = reachOf(blocks, block, p);
    const std::size_t size = blocks.size(block), first = blocks.first(block);
    if (keyOf(reach.nearest) >= bracket.high) return;
    if (keyOf(reach.farthest) < bracket.low) {
      to.below += size;
      return;
    }
    double squared[kBlockLights];
    for (std::size_t i = 0; i < size; ++i) {
      const double dx = blocks.x[first + i] - p.x;
      const double dy = blocks.y[first + i] - p.y;
      const double dz = blocks.z[first + i] - p.z;
      squared[i] = dx * dx + dy * dy + dz * dz;
    }
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint64_t key = keyOf(squared[i]);
      if (key < bracket.low) {
        ++to.below;
      } else if (key < bracket.high) {
        ++to.first[(key - bracket.low) >> shift];
      }
    }
  });
}

/// The smallest range whose square is above `squared`; at least kShortestRange.
float rangeBeyond(double squared) {
  float range = static_cast<float>(std::sqrt(squared));
  while (double(range) * range > squared) range = std::nextafter(range, 0.0f);
  while (double(range) * range <= squared)
    range = std::nextafter(range, std::numeric_limits<float>::infinity());
  return std::max(range, static_cast<float>(kShortestRange));
}

/// What removeRanges() needs of a light.
struct Emitter {
  glm::dvec3 position;
  double brightness;  ///< sum of the diffuse channels
  glm::dvec3 attenuation;
  double inverse_range;    ///< 0 without a range
  double squared_nearest;  ///< squared metres; a nearer point counts as being as far
};

Emitter emitterOf(const Light& light) {
  const double brightness = double(light.diffuse.r) + light.diffuse.g + light.diffuse.b;
  const double nearest = std::isfinite(light.range) ? double(light.range) / 100 : kShortestRange;
  return {light.position, brightness, light.attenuation, 1.0 / light.range, nearest * nearest};
}

/// Light that arrives at points: with the ranges and attenuations that lights have, and with 1/d² alone.
struct Arriving {
  double with_ranges = 0, without = 0;
};

void addArriving(const Emitter& light, const glm::dvec3& point, Arriving& sum) {
  const double squared = std::max(squaredLength(light.position - point), light.squared_nearest);
  sum.without += light.brightness / squared;
  const double distance = std::sqrt(squared), share = distance * light.inverse_range;
  if (share >= 1) return;
  const double window = 1 - share * share * share * share;
  const glm::dvec3& a = light.attenuation;
  sum.with_ranges += light.brightness * window * window / (a.x + a.y * distance + a.z * squared);
}

}  // namespace

float rangeForDensity(std::span<const Light> lights, std::span<const glm::dvec3> points, double density) {
  if (lights.empty() || points.empty()) return std::numeric_limits<float>::infinity();
  const std::uint64_t pairs = std::uint64_t(lights.size()) * points.size();
  const double least = std::ceil(density * static_cast<double>(points.size()));
  const std::uint64_t wanted =
      least < static_cast<double>(pairs) ? std::max<std::uint64_t>(std::uint64_t(least), 1) : pairs;
  const Blocks blocks = makeBlocks(lights);
  Bracket bracket = bracketByBoxes(blocks, points, wanted);
  for (;;) {
    const float range = rangeBeyond(std::bit_cast<double>(bracket.low));
    if (range == rangeBeyond(std::bit_cast<double>(bracket.high - 1))) return range;
    const int shift = std::max(int(std::bit_width(bracket.high - bracket.low - 1)) - kBucketBits, 0);
    const Tally tally = tallyBracket(blocks, points, bracket, shift);
    std::uint64_t left = wanted - tally.below;
    bracket.low += bucketOf(tally.first, left) << shift;
    bracket.high = std::min(bracket.high, bracket.low + (std::uint64_t{1} << shift));
  }
}

float rangeForCutoff(const Light& light, double cutoff) {
  const double brightest = std::max({light.diffuse.r, light.diffuse.g, light.diffuse.b});
  return static_cast<float>(std::clamp(std::sqrt(brightest / cutoff), kShortestRange, kLongestRange));
}

void removeRanges(std::span<Light> lights, std::span<const glm::dvec3> points) {
  std::vector<Emitter> emitters;
  emitters.reserve(lights.size());
  for (const Light& light : lights) emitters.push_back(emitterOf(light));
  // Lights go through the cache once for a few points. Each point's sum keeps the lights' order.
  constexpr std::size_t kPointsAtOnce = 8;
  std::vector<Arriving> arriving(points.size());
  tbb::parallel_for(std::size_t{0}, (points.size() + kPointsAtOnce - 1) / kPointsAtOnce, [&](std::size_t i) {
    const std::size_t first = i * kPointsAtOnce, end = std::min(first + kPointsAtOnce, points.size());
    for (const Emitter& emitter : emitters)
      for (std::size_t point = first; point < end; ++point)
        addArriving(emitter, points[point], arriving[point]);
  });
  Arriving sum;
  for (const Arriving& one : arriving) {
    sum.with_ranges += one.with_ranges;
    sum.without += one.without;
  }
  const bool gives_light = sum.without > 0;
  if (gives_light && sum.with_ranges == 0)
    throw InputError("lights without range: with their ranges they reach nothing that would say how bright");
  const auto factor = gives_light ? static_cast<float>(sum.with_ranges / sum.without) : 1.0f;
  for (Light& light : lights) {
    light.ambient *= factor;
    light.diffuse *= factor;
    light.specular *= factor;
    light.attenuation = {0, 0, 1};
    light.range = std::numeric_limits<float>::infinity();
  }
}

void spreadEverywhere(std::span<Light> lights, std::span<const glm::dvec3> points) {
  const float range = rangeForDensity(lights, points, kUsualDensity);
  for (Light& light : lights) light.range = range;
  removeRanges(lights, points);
}

}  // namespace luciole
