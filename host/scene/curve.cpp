#include "luciole/animation.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace luciole {
namespace {

glm::dquat quaternionOf(const glm::dvec4& v) { return {v.w, v.x, v.y, v.z}; }

glm::dvec4 slerp(const glm::dvec4& a, const glm::dvec4& b, double t) {
  const glm::dquat q = glm::slerp(quaternionOf(a), quaternionOf(b), t);
  return {q.x, q.y, q.z, q.w};
}

glm::dvec4 hermite(const CurveKey& a, const CurveKey& b, double t) {
  const double h = b.frame - a.frame, s = 1 - t;
  return s * s * ((1 + 2 * t) * a.value + h * t * a.slope_out) +
         t * t * ((1 + 2 * s) * b.value - h * s * b.slope_in);
}

/// Steffen's slope at an inner key. h and s are length and slope of the interval before it (0) and after it
/// (1).
double innerSlope(double h0, double s0, double h1, double s1) {
  if (!(s0 * s1 > 0)) return 0;
  const double parabola = (s0 * h1 + s1 * h0) / (h0 + h1);
  return std::copysign(std::min({2 * std::abs(s0), 2 * std::abs(s1), std::abs(parabola)}), s0);
}

/// Steffen's slope at an end key: 0 is the interval there, 1 the next one.
double endSlope(double h0, double s0, double h1, double s1) {
  const double parabola = s0 + (s0 - s1) * h0 / (h0 + h1);
  if (!(parabola * s0 > 0)) return 0;
  return std::copysign(std::min(std::abs(parabola), 2 * std::abs(s0)), s0);
}

}  // namespace

glm::dvec4 valueAt(const Curve& curve, double frame) {
  const std::vector<CurveKey>& keys = curve.keys;
  const auto next = std::upper_bound(keys.begin(), keys.end(), frame,
                                     [](double f, const CurveKey& key) { return f < key.frame; });
  if (next == keys.begin()) return keys.front().value;
  const CurveKey& a = *(next - 1);
  if (next == keys.end() || frame == a.frame || curve.interpolation == Interpolation::kStep) return a.value;
  const CurveKey& b = *next;
  const double t = (frame - a.frame) / (b.frame - a.frame);
  if (curve.interpolation == Interpolation::kSlerp) return slerp(a.value, b.value, t);
  const glm::dvec4 low = glm::min(a.value, b.value), high = glm::max(a.value, b.value);
  // Clamped, so that rounding can't leave the interval either.
  if (curve.interpolation == Interpolation::kLinear)
    return glm::clamp((1 - t) * a.value + t * b.value, low, high);
  return hermite(a, b, t);
}

void makeSmooth(Curve& curve) {
  std::vector<CurveKey>& keys = curve.keys;
  curve.interpolation = Interpolation::kCubic;
  const auto length = [&](std::size_t i) { return keys[i + 1].frame - keys[i].frame; };
  const std::size_t last = keys.size() - 1;
  for (int c = 0; c < 4; ++c) {
    const auto slope = [&](std::size_t i) { return (keys[i + 1].value[c] - keys[i].value[c]) / length(i); };
    for (std::size_t i = 0; i < keys.size() && last > 0; ++i) {
      keys[i].slope_in[c] = last == 1   ? slope(0)
                            : i == 0    ? endSlope(length(0), slope(0), length(1), slope(1))
                            : i == last ? endSlope(length(i - 1), slope(i - 1), length(i - 2), slope(i - 2))
                                        : innerSlope(length(i - 1), slope(i - 1), length(i), slope(i));
    }
  }
  for (CurveKey& key : keys) key.slope_out = key.slope_in;
}

}  // namespace luciole
