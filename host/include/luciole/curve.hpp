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
  glm::dvec4 value{0.0};      ///< unused components are 0
  glm::dvec4 slope_in{0.0};   ///< kCubic: change per frame, before the key
  glm::dvec4 slope_out{0.0};  ///< and after it
};

/// A value that changes with the frame. Before the first key it has the first key's value, after the last key
/// the last one's.
struct Curve {
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<CurveKey> keys = {};  ///< in ascending order of frames; empty: the value isn't animated
};

/// A curve that is the same at every frame.
inline Curve constantCurve(const glm::dvec4& value) { return {Interpolation::kLinear, {{0.0, value}}}; }

/// The value at a frame, which may be fractional. At a key's frame it is the key's value to the bit. The
/// curve must have at least one key. O(log keys).
glm::dvec4 valueAt(const Curve& curve, double frame);

/// Makes a curve cubic, with continuous slopes that don't overshoot: between two keys every component stays
/// between their values, so a range stays positive and a field of view below 180°. Slopes by Steffen 1990, "A
/// simple method for monotonic interpolation in one dimension". Two keys give a straight line. The curve must
/// have at least one key.
void makeSmooth(Curve& curve);

}  // namespace luciole
