#include "lights/light_clusters.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <limits>
#include <utility>

namespace luciole {
namespace {

constexpr std::size_t kRowFloats = std::size_t(kClusterFields) * kClusterSlots;
constexpr std::size_t kLightRowFloats = std::size_t(kLightFields) * kClusterSlots;
/// Nodes with fewer lights are split by one thread.
constexpr std::size_t kParallelLights = 1 << 14;
/// Moments in bounds are at least this, so that none underflows.
constexpr double kLeastMoment = 1e-30;

/// A number's upper 24 bits, which a float holds: G. Veltkamp's splitting. Not by way of a float, because GCC
/// 12 takes x − double(float(x)) for 0 where it makes vectors of it.
glm::dvec3 upperHalf(const glm::dvec3& x) {
  const glm::dvec3 scaled = (0x1p29 + 1) * x;
  return scaled - (scaled - x);
}

/// Sets a light's fields, which lie kClusterSlots floats apart from `out` on.
void setLight(const UnboundedLight& light, float* out) {
  const auto field = [out](std::size_t number) -> float& { return out[number * kClusterSlots]; };
  const glm::dvec3 upper = upperHalf(light.position);
  const glm::vec3 place(upper), rest(light.position - upper), color(light.color / light.quadratic);
  for (int axis = 0; axis < 3; ++axis) {
    field(kLightPlace + std::size_t(axis)) = place[axis];
    field(kLightRest + std::size_t(axis)) = rest[axis];
    field(kLightColor + std::size_t(axis)) = color[axis];
  }
  field(kLightFalloff) = float(0x1p100 * light.quadratic);
  field(kLightMost) = std::max({color.x, color.y, color.z});
}

/// Calls `visit(level, levels, first)` for each level of the tree whose nodes have rows: with the levels that
/// these have, and the number of the first of the 2^level rows. Returns how many rows there are.
template <class Visit>
std::size_t forEachRowLevel(unsigned tree_levels, Visit&& visit) {
  std::size_t first = 0;
  for (unsigned level = 0, levels = CLUSTER_TOP_LEVELS(tree_levels); level < tree_levels;
       level += levels, levels = 3) {
    visit(level, levels, first);
    first += std::size_t(1) << level;
  }
  return first;
}

/// A light to be ordered. Positions lie beside each other, since looking them up takes most of the time.
struct Placed {
  glm::dvec3 position;
  std::uint32_t light;
};

/// Orders the lights so that each node of the tree below (level, index) holds its part.
void split(std::vector<Placed>& lights, unsigned levels, unsigned level, std::size_t index) {
  const auto at = [&](unsigned l, std::size_t i) {
    return lights.begin() + std::ptrdiff_t(clusterBegin(lights.size(), l, i));
  };
  const auto begin = at(level, index), end = at(level, index + 1);
  if (level == levels) {
    // std::nth_element leaves the order within a leaf unspecified.
    std::sort(begin, end, [](const Placed& a, const Placed& b) { return a.light < b.light; });
    return;
  }
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (auto i = begin; i != end; ++i) {
    low = glm::min(low, i->position);
    high = glm::max(high, i->position);
  }
  const glm::dvec3 side = high - low;
  const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
  std::nth_element(begin, at(level + 1, 2 * index + 1), end, [axis](const Placed& a, const Placed& b) {
    const double x = a.position[axis], y = b.position[axis];
    return x != y ? x < y : a.light < b.light;
  });
  const auto half = [&](std::size_t child) { split(lights, levels, level + 1, 2 * index + child); };
  if (std::size_t(end - begin) < kParallelLights) {
    half(0);
    half(1);
  } else {
    tbb::parallel_invoke([&] { half(0); }, [&] { half(1); });
  }
}

/// The lights in the order of the tree's nodes.
std::vector<std::uint32_t> orderOf(std::span<const UnboundedLight> lights, unsigned levels) {
  std::vector<Placed> placed(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) placed[i] = {lights[i].position, std::uint32_t(i)};
  if (!lights.empty()) split(placed, levels, 0, 0);
  std::vector<std::uint32_t> order(lights.size());
  std::transform(placed.begin(), placed.end(), order.begin(), [](const Placed& one) { return one.light; });
  return order;
}

/// Partial sums: as many as a vector has doubles, since compilers may not reorder sums. GCC and Clang make
/// vector instructions of this type on any machine.
constexpr std::size_t kSumLanes = 8;
using Doubles = double __attribute__((vector_size(kSumLanes * sizeof(double))));
using Floats = float __attribute__((vector_size(kSumLanes * sizeof(float))));
using LaneNumbers = std::int64_t __attribute__((vector_size(kSumLanes * sizeof(std::int64_t))));
constexpr LaneNumbers kLaneNumbers{0, 1, 2, 3, 4, 5, 6, 7};

double total(const Doubles& parts) {
  double sum = 0;
  for (std::size_t i = 0; i < kSumLanes; ++i) sum += parts[i];
  return sum;
}

/// Planes of the lights' positions, and of their colours as the device's floats, with kSumLanes elements more
/// than lights.
struct LightPlanes {
  std::array<std::vector<double>, 3> position;
  std::array<std::vector<float>, 3> color;
};

/// A bound as a float, rounded up.
float atLeast(double bound) { return std::nextafter(float(std::max(bound, kLeastMoment)), INFINITY); }

/// Sums over lights of intensity q at δ from the cluster's centre: of q, qδ, qδδ, q|δ|, q|δ|³, q|δ|⁴ and
/// q|δ|²δ, and of q times the solid harmonics of degrees 2 to 4 in Racah's normalization, in which the
/// squares of degree j add up to |δ|²ʲ.
enum {
  kAbsolute1 = kMoments,
  kAbsolute3,
  kAbsolute4,
  kCubic,
  kDegree2 = kCubic + 3,
  kDegree3 = kDegree2 + 5,
  kDegree4 = kDegree3 + 7,
  kSums = kDegree4 + 9
};

/// The terms of the sums for lights of q = 1.
inline std::array<Doubles, kSums> summands(const Doubles& x, const Doubles& y, const Doubles& z) {
  const Doubles one = Doubles{} + 1, xx = x * x, yy = y * y, zz = z * z, across = xx + yy, d2 = across + zz;
  Doubles d;
  for (std::size_t i = 0; i < kSumLanes; ++i) d[i] = std::sqrt(d2[i]);
  const double s3 = 1.7320508075688772, s5 = 2.23606797749979, s6 = 2.449489742783178,
               s10 = 3.1622776601683795, s15 = 3.872983346207417, s35 = 5.916079783099616,
               s70 = 8.366600265340756;
  return {one, x, y, z, xx, x * y, x * z, yy, y * z, zz, d, d2 * d, d2 * d2, d2 * x, d2 * y, d2 * z,
          // degree 2
          0.5 * (2 * zz - across), s3 * x * z, s3 * y * z, s3 * x * y, 0.5 * s3 * (xx - yy),
          // degree 3
          0.5 * z * (2 * zz - 3 * across), 0.25 * s6 * x * (4 * zz - across),
          0.25 * s6 * y * (4 * zz - across), 0.5 * s15 * z * (xx - yy), s15 * x * y * z,
          0.25 * s10 * x * (xx - 3 * yy), 0.25 * s10 * y * (3 * xx - yy),
          // degree 4
          0.125 * (8 * zz * zz - 24 * zz * across + 3 * across * across),
          0.25 * s10 * x * z * (4 * zz - 3 * across), 0.25 * s10 * y * z * (4 * zz - 3 * across),
          0.25 * s5 * (xx - yy) * (6 * zz - across), 0.5 * s5 * x * y * (6 * zz - across),
          0.25 * s70 * x * z * (xx - 3 * yy), 0.25 * s70 * y * z * (3 * xx - yy),
          0.125 * s35 * (xx * xx - 6 * xx * yy + yy * yy), 0.5 * s35 * x * y * (xx - yy)};
}

/// The mean position of the lights from `begin` to `end`, weighted by their light and rounded to float.
glm::dvec3 centreOf(const LightPlanes& lights, std::size_t begin, std::size_t end) {
  std::array<Doubles, 4> sums{};
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t part = (i - begin) % kSumLanes;
    const double weight = double(lights.color[0][i]) + lights.color[1][i] + lights.color[2][i];
    for (std::size_t axis = 0; axis < 3; ++axis) sums[axis][part] += weight * lights.position[axis][i];
    sums[3][part] += weight;
  }
  glm::dvec3 centre;
  for (int axis = 0; axis < 3; ++axis) {
    const double mean = total(sums[std::size_t(axis)]) / total(sums[3]);
    centre[axis] = float(std::isfinite(mean) ? mean : double(lights.position[std::size_t(axis)][begin]));
  }
  return centre;
}

/// At least the largest eigenvalue of the second moments xx xy xz yy yz zz, and at most 4e-7 of their trace
/// more. The matrix is mean·I + scale·B, and the eigenvalues of B, from −2 to 2, are the roots of β³ − 3β −
/// det B: O. Smith, "Eigenvalues of a Symmetric 3 × 3 Matrix" (1961). From 2 on Newton's method comes down to
/// the largest and never below it. No cosine is asked for, since machines may round it apart.
double largestEigenvalue(const double* m) {
  const double mean = (m[0] + m[3] + m[5]) / 3, xx = m[0] - mean, yy = m[3] - mean, zz = m[5] - mean;
  const double square = (xx * xx + yy * yy + zz * zz + 2 * (m[1] * m[1] + m[2] * m[2] + m[4] * m[4])) / 6;
  if (!(square > 0)) return mean;
  const double scale = std::sqrt(square);
  const double determinant =
      (xx * (yy * zz - m[4] * m[4]) - m[1] * (m[1] * zz - m[4] * m[2]) + m[2] * (m[1] * m[4] - yy * m[2])) /
      (square * scale);
  double root = 2;
  for (int i = 0; i < 40; ++i) {
    const double next = root - (root * (root * root - 3) - determinant) / (3 * (root * root - 1));
    if (!(next < root - 1e-9)) break;
    root = next;
  }
  return mean + scale * root + 3e-7 * mean;  // more than rounding
}

/// Sets a cluster's fields, which lie kClusterSlots floats apart from `out` on, to the lights from `begin` to
/// `end`. If a field overflows a float, a bound is set to infinity, so that the cluster is never used.
void setCluster(const LightPlanes& lights, std::size_t begin, std::size_t end, float* out) {
  const auto field = [out](std::size_t number) -> float& { return out[number * kClusterSlots]; };
  const glm::dvec3 centre = centreOf(lights, begin, end);
  std::array<std::array<Doubles, kSums>, 3> sums{};
  std::array<Doubles, 4> farthest{};  // |xyz| and the square of the distance
  for (std::size_t first = begin; first < end; first += kSumLanes) {
    // Lanes beyond the end are black lights at the centre.
    const LaneNumbers inside = kLaneNumbers < std::int64_t(end - first);
    std::array<Doubles, 3> offset, color;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Doubles position;
      Floats intensity;
      std::memcpy(&position, &lights.position[axis][first], sizeof position);
      std::memcpy(&intensity, &lights.color[axis][first], sizeof intensity);
      offset[axis] = inside ? position - centre[int(axis)] : Doubles{};
      color[axis] = inside ? __builtin_convertvector(intensity, Doubles) : Doubles{};
    }
    const auto& [x, y, z] = offset;
    const std::array<Doubles, kSums> each = summands(x, y, z);
    const std::array<Doubles, 4> distances{x < 0 ? -x : x, y < 0 ? -y : y, z < 0 ? -z : z,
                                           x * x + y * y + z * z};
    for (std::size_t k = 0; k < farthest.size(); ++k)
      farthest[k] = distances[k] > farthest[k] ? distances[k] : farthest[k];
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t m = 0; m < kSums; ++m) sums[c][m] += color[c] * each[m];
  }
  const auto most = [](const Doubles& values) {
    double largest = values[0];
    for (std::size_t i = 1; i < kSumLanes; ++i) largest = std::max(largest, values[i]);
    return largest;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    field(kClusterCentre + axis) = float(centre[int(axis)]);
    field(kClusterExtent + axis) = atLeast(most(farthest[axis]));
  }
  field(kClusterRadius) = atLeast(std::sqrt(most(farthest[3])));
  std::array<double, kClusterMoments - kClusterAbsolute> bounds{};  // as in shared.h
  bool finite = true;
  for (std::size_t c = 0; c < 3; ++c) {
    std::array<double, kSums> moments;
    for (std::size_t m = 0; m < kSums; ++m) moments[m] = total(sums[c][m]);
    const auto norm = [&](int first, int count) {
      double square = 0;
      for (int m = first; m < first + count; ++m) square += moments[std::size_t(m)] * moments[std::size_t(m)];
      return std::sqrt(square);
    };
    const double second = moments[kMoment2] + moments[kMoment2 + 3] + moments[kMoment2 + 5];
    const double largest = largestEigenvalue(&moments[kMoment2]);
    // Of the mean light. Of a black channel nothing is wrong.
    const double inverse = moments[0] > 0 ? 1 / moments[0] : 0;
    const std::array<double, bounds.size()> of_channel{
        moments[0],
        moments[kAbsolute1],
        second,
        moments[kAbsolute3],
        norm(kMoment1, 3),
        norm(kDegree2, 5),
        norm(kDegree3, 7),
        norm(kDegree4, 9),
        std::sqrt(largest * inverse),
        6 * norm(kMoment1, 3) * inverse,
        (24 * largest - 3 * second) * inverse,
        (32 * norm(kDegree3, 7) + 24 * norm(kCubic, 3)) * inverse,
        std::sqrt(moments[kAbsolute4] * inverse)};
    for (std::size_t b = 0; b < bounds.size(); ++b) bounds[b] = std::max(bounds[b], of_channel[b]);
    for (std::size_t m = 0; m < kMoments; ++m) {
      float& moment = field(kClusterMoments + c * kMoments + m);
      moment = float(moments[m]);
      finite = finite && std::isfinite(moment);
      if (!std::isfinite(moment)) moment = 0;
    }
  }
  for (std::size_t b = 0; b < bounds.size(); ++b) field(kClusterAbsolute + b) = atLeast(bounds[b]);
  if (!finite) field(kClusterAbsolute) = INFINITY;
}

}  // namespace

LightClusters buildLightClusters(std::span<const UnboundedLight> lights) {
  LightClusters clusters;
  const std::size_t count = lights.size();
  while ((std::size_t(kLeafLights) << clusters.levels) < count) ++clusters.levels;
  std::vector<std::uint32_t> order = orderOf(lights, clusters.levels);

  LightPlanes planes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    planes.position[axis].resize(count + kSumLanes);
    planes.color[axis].resize(count + kSumLanes);
  }
  clusters.lights = count;
  const std::size_t leaves = std::size_t(1) << clusters.levels;
  clusters.light_rows.resize(std::max<std::size_t>(leaves / 2, 1) * kLightRowFloats);
  tbb::parallel_for(std::size_t(0), clusters.light_rows.size() / kLightRowFloats, [&](std::size_t row) {
    float* const out = &clusters.light_rows[row * kLightRowFloats];
    std::fill_n(out, kLightRowFloats, 0.0f);
    for (std::size_t leaf = 2 * row; leaf < std::min(2 * row + 2, leaves); ++leaf) {
      const std::size_t begin = clusterBegin(count, clusters.levels, leaf);
      for (std::size_t i = begin; i < clusterBegin(count, clusters.levels, leaf + 1); ++i) {
        const UnboundedLight& light = lights[order[i]];
        float* const slot = out + leaf % 2 * kLeafLights + (i - begin);
        setLight(light, slot);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          planes.position[axis][i] = light.position[int(axis)];
          planes.color[axis][i] = slot[(kLightColor + axis) * kClusterSlots];
        }
      }
    }
  });
  const auto uncounted = [](unsigned, unsigned, std::size_t) {};
  clusters.rows.resize(forEachRowLevel(clusters.levels, uncounted) * kRowFloats);
  forEachRowLevel(clusters.levels, [&](unsigned level, unsigned levels, std::size_t first_row) {
    tbb::parallel_for(std::size_t(0), std::size_t(1) << level, [&](std::size_t row) {
      float* out = &clusters.rows[(first_row + row) * kRowFloats];
      std::fill_n(out, kRowFloats, 0.0f);
      for (unsigned below = 1, slot = 0; below <= levels; ++below)
        for (std::size_t i = 0; i < std::size_t(1) << below; ++i, ++slot) {
          const unsigned at = level + below;
          const std::size_t node = (row << below) + i;
          setCluster(planes, clusterBegin(count, at, node), clusterBegin(count, at, node + 1), out + slot);
        }
    });
  });
  clusters.order = std::move(order);
  return clusters;
}

}  // namespace luciole
