#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace luciole {

/// Steps from the centre of a packed normal's square to its border.
constexpr int kPackedNormalSteps = 32767;

/// Packs a direction of any finite length but 0 as a point of a square (octahedral map): the octahedron |x| +
/// |y| + |z| = 1 seen from +z, its far half folded outwards over the corners (Q. Meyer, J. Süßmuth, G.
/// Sußner, M. Stamminger, G. Greiner, "On floating-point normal vectors", 2010). The square's x is in the
/// lower 16 bits, its y in the upper 16, both signed, in steps of h = 1/32767.
///
/// Error: rounding moves each coordinate by h/2 at most, and so the point on its side of the octahedron by
/// (h/2, h/2, h) at most, √6 · h/2; folded or not, since folding only swaps the two. The sides' planes lie
/// 1/√3 from the centre, so that is an angle of √3 · √6 · h/2 = √18 · h/2 < 6.5e-5 radians at most.
///
/// Idempotent: unpackNormal() returns the direction of exactly one step, and packing that direction gives the
/// same step as long as no coordinate has moved by half a step. A rotation in double and one rounding to
/// float move it by √3 · 2⁻²⁵, which is less than 3e-7 on the square, a fiftieth of half a step. Each
/// direction on the square's border has two points there. Of these, packing gives the one whose coordinate
/// along the border is not negative.
inline std::uint32_t packNormal(const glm::dvec3& normal) {
  const double scale = kPackedNormalSteps / (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
  double x = normal.x * scale, y = normal.y * scale;
  if (normal.z < 0.0) {
    const double folded_x = kPackedNormalSteps - std::abs(y), folded_y = kPackedNormalSteps - std::abs(x);
    x = std::copysign(folded_x, x);
    y = std::copysign(folded_y, y);
  }
  int column = int(std::lround(x)), row = int(std::lround(y));
  if (std::abs(column) == kPackedNormalSteps) row = std::abs(row);
  if (std::abs(row) == kPackedNormalSteps) column = std::abs(column);
  return std::uint32_t(column & 0xffff) | std::uint32_t(row) << 16;
}

/// The unit direction that packNormal() packed, computed as in kernels/math.clh.
inline glm::dvec3 unpackNormal(std::uint32_t packed) {
  double x = std::int16_t(packed & 0xffff), y = std::int16_t(packed >> 16);
  const double z = kPackedNormalSteps - std::abs(x) - std::abs(y);
  if (z < 0.0) {
    x += x < 0.0 ? -z : z;
    y += y < 0.0 ? -z : z;
  }
  return glm::normalize(glm::dvec3(x, y, z));
}

}  // namespace luciole
