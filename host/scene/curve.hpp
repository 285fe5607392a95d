#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace luciole {

/// How a curve goes from one key to the next.
enum class Interpolation : std::uint8_t {
  kStep,    ///< it keeps a key's value until the next key
  kLinear,  ///< straight
  kSlerp,   ///< unit quaternions (x, y, z, w): the shorter arc between two, at a constant speed
  kCubic,   ///< Hermite's cubic through values and slopes
};

struct CurveKey {
  double frame = 0;
  glm::dvec4 value{0.0};      ///< as many components as the thing has, the others 0
  glm::dvec4 slope_in{0.0};   ///< kCubic: change a frame, before the key
  glm::dvec4 slope_out{0.0};  ///< and after it
};

/// A value that changes with the frame. Before the first key and after the last it holds.
struct Curve {
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<CurveKey> keys;  ///< by rising frame; none: nobody moves this
};

/// A curve that is the same at every frame.
inline Curve constantCurve(const glm::dvec4& value) { return {Interpolation::kLinear, {{0.0, value}}}; }

/// The value at a frame, which may lie between two. The curve has a key at least. At a key's frame it is the
/// key's value to the bit.
glm::dvec4 valueAt(const Curve& curve, double frame);

/// Makes a curve cubic that changes its speed smoothly and, between two keys, no component ever goes beyond
/// the two: a range stays positive, a lens below 180°. Slopes by Steffen 1990, "A simple method for monotonic
/// interpolation in one dimension". Of two keys it is the straight line.
void makeSmooth(Curve& curve);

}  // namespace luciole
