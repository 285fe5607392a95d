#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared.h"

// A cluster of lights by brute force, in double precision and without solid harmonics.
namespace luciole::test {

/// A light of a cluster: its place from the cluster's centre, and its colour over quadratic attenuation.
struct ClusterLight {
  glm::dvec3 offset, color;
};

/// A cluster's fields as kernels/shared.h defines them, a double each, and what the bounds from
/// kClusterHarmonic on are at most before they cancel: of the harmonic ones Σ q·|δ|ʲ.
struct ClusterMoments {
  std::array<double, kClusterFields> field{};
  std::array<double, kClusterMoments - kClusterHarmonic> most{};
};

/// P. Legendre's polynomials.
inline double legendre(int degree, double x) {
  double before = 1, value = x;
  for (int j = 1; j < degree; ++j) {
    const double next = ((2 * j + 1) * x * value - j * before) / (j + 1);
    before = value;
    value = next;
  }
  return degree == 0 ? 1 : value;
}

/// The largest eigenvalue of a symmetric matrix ≥ 0: that of its powers' largest column.
inline double largestEigenvalue(const glm::dmat3& matrix) {
  glm::dmat3 power = matrix;
  for (int i = 0; i < 40; ++i) {
    const double trace = power[0][0] + power[1][1] + power[2][2];
    if (!(trace > 0)) return 0;
    power = power / trace * (power / trace);
  }
  glm::dvec3 longest = power[0];
  for (int i = 1; i < 3; ++i)
    if (glm::length(power[i]) > glm::length(longest)) longest = power[i];
  longest = glm::normalize(longest);
  return glm::dot(longest, matrix * longest);
}

/// The square of |Σ q·Yⱼ(δ)| is Σₐ Σᵦ qₐqᵦ|δₐ|ʲ|δᵦ|ʲPⱼ(cos), by the addition theorem.
inline ClusterMoments clusterMoments(const glm::dvec3& centre, const std::vector<ClusterLight>& lights) {
  ClusterMoments moments;
  auto& field = moments.field;
  for (int axis = 0; axis < 3; ++axis) field[kClusterCentre + std::size_t(axis)] = centre[axis];
  for (const ClusterLight& light : lights) {
    for (int axis = 0; axis < 3; ++axis) {
      double& extent = field[kClusterExtent + std::size_t(axis)];
      extent = std::max(extent, std::abs(light.offset[axis]));
    }
    field[kClusterRadius] = std::max(field[kClusterRadius], glm::length(light.offset));
  }
  for (int c = 0; c < 3; ++c) {
    const std::size_t first = kClusterMoments + std::size_t(c) * kMoments;
    std::array<double, 5> absolute{}, square{};
    glm::dvec3 cubic(0.0);
    glm::dmat3 second(0.0);
    for (const ClusterLight& a : lights) {
      const glm::dvec3& d = a.offset;
      const double q = a.color[c], length = glm::length(d);
      const double terms[kMoments] = {1,         d.x,       d.y,       d.z,       d.x * d.x,
                                      d.x * d.y, d.x * d.z, d.y * d.y, d.y * d.z, d.z * d.z};
      for (std::size_t m = 0; m < kMoments; ++m) field[first + m] += q * terms[m];
      cubic += q * length * length * d;
      second += q * glm::outerProduct(d, d);
      for (int j = 0; j <= 4; ++j) absolute[std::size_t(j)] += q * std::pow(length, j);
      if (length == 0) continue;
      for (const ClusterLight& b : lights) {
        const double other = glm::length(b.offset);
        if (other == 0) continue;
        const double cosine = std::clamp(glm::dot(d, b.offset) / (length * other), -1.0, 1.0);
        for (int j = 1; j <= 4; ++j)
          square[std::size_t(j)] += q * b.color[c] * std::pow(length * other, j) * legendre(j, cosine);
      }
    }
    for (std::size_t j = 0; j < 4; ++j) {
      double &all = field[kClusterAbsolute + j], &harmonic = field[kClusterHarmonic + j];
      all = std::max(all, absolute[j]);
      harmonic = std::max(harmonic, std::sqrt(std::max(square[j + 1], 0.0)));
      moments.most[j] = std::max(moments.most[j], absolute[j + 1]);
    }
    if (absolute[0] == 0) continue;
    const double inverse = 1 / absolute[0], largest = largestEigenvalue(second);
    const double means[5] = {std::sqrt(largest * inverse), 6 * std::sqrt(std::max(square[1], 0.0)) * inverse,
                             (24 * largest - 3 * absolute[2]) * inverse,
                             (32 * std::sqrt(std::max(square[3], 0.0)) + 24 * glm::length(cubic)) * inverse,
                             std::sqrt(absolute[4] * inverse)};
    const double most[5] = {means[0], 6 * absolute[1] * inverse, 24 * absolute[2] * inverse,
                            56 * absolute[3] * inverse, means[4]};
    for (std::size_t i = 0; i < 5; ++i) {
      double &field_of = field[kClusterDeviation + i], &most_of = moments.most[4 + i];
      field_of = std::max(field_of, means[i]);
      most_of = std::max(most_of, most[i]);
    }
  }
  return moments;
}

/// Rows of kClusterSlots clusters each, filled up with the last one. Bounds are rounded up.
inline std::vector<float> clusterRows(const std::vector<ClusterMoments>& clusters) {
  const std::size_t rows = (clusters.size() + kClusterSlots - 1) / kClusterSlots;
  std::vector<float> out(rows * kClusterFields * kClusterSlots);
  for (std::size_t i = 0; i < rows * kClusterSlots; ++i) {
    const auto& field = clusters[std::min(i, clusters.size() - 1)].field;
    for (std::size_t f = 0; f < kClusterFields; ++f) {
      const bool bound = f >= kClusterExtent && f < kClusterMoments;
      const float value = float(field[f]);
      out[(i / kClusterSlots * kClusterFields + f) * kClusterSlots + i % kClusterSlots] =
          bound ? std::nextafter(value, INFINITY) : value;
    }
  }
  return out;
}

/// Rows of kClusterSlots lights each, at their offsets from the origin, filled up with the last one.
inline std::vector<float> lightRows(const std::vector<ClusterLight>& lights) {
  const std::size_t rows = (lights.size() + kClusterSlots - 1) / kClusterSlots;
  std::vector<float> out(rows * kLightFields * kClusterSlots);
  for (std::size_t i = 0; i < rows * kClusterSlots; ++i) {
    const auto& [place, color] = lights[std::min(i, lights.size() - 1)];
    const auto set = [&](std::size_t field, double value) {
      out[(i / kClusterSlots * kLightFields + field) * kClusterSlots + i % kClusterSlots] = float(value);
    };
    for (int c = 0; c < 3; ++c) {
      set(kLightPlace + std::size_t(c), place[c]);
      set(kLightRest + std::size_t(c), place[c] - double(float(place[c])));
      set(kLightColor + std::size_t(c), color[c]);
    }
    set(kLightFalloff, 0x1p100);
    set(kLightMost, std::max({color.x, color.y, color.z}));
  }
  return out;
}

}  // namespace luciole::test
