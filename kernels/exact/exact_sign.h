// On which side of a plane a point lies: the signs of determinants of floats as of real numbers, without any
// rounding. Right for all finite floats, and so the same on the host and on every device, with or without
// doubles, and whether or not it takes denormals for 0.
#ifndef LUCIOLE_EXACT_SIGN_H
#define LUCIOLE_EXACT_SIGN_H

#include "exact/wide_integer.h"
#include "shared.h"
#ifdef __cplusplus
#define INLINE static inline
#define SHARED_WORK [[gnu::noinline]] static inline
namespace luciole {
#endif

// A test defines NO_DOUBLES to compile as for a device that has none.
#if (defined(__cplusplus) || defined(cl_khr_fp64)) && !defined(NO_DOUBLES)
#define DOUBLES
#endif

// Bits of the floats' magnitudes above their common unit: from 2⁻¹⁴⁹ to below 2¹²⁸. A difference has one
// more, a determinant is a sum of 6 < 2³ products of three, and two's complement takes one for the sign.
#define DETERMINANT_BITS(bits) (3 * ((bits) + 1) + 3 + 1)
#define WORDS_OF_BITS(bits) (((bits) + 31) / 32)
enum { kMostDeterminantWords = WORDS_OF_BITS(DETERMINANT_BITS(277)) };

// The sign of det(a − l, b − l, c − m), by integers.
SHARED_WORK int determinant_sign_by_integers(float4 a, float4 b, float4 l, float4 c, float4 m) {
  const uint minuends[3][3] = {{float_bits(a.x), float_bits(a.y), float_bits(a.z)},
                               {float_bits(b.x), float_bits(b.y), float_bits(b.z)},
                               {float_bits(c.x), float_bits(c.y), float_bits(c.z)}};
  const uint subtrahends[3][3] = {{float_bits(l.x), float_bits(l.y), float_bits(l.z)},
                                  {float_bits(l.x), float_bits(l.y), float_bits(l.z)},
                                  {float_bits(m.x), float_bits(m.y), float_bits(m.z)}};
  // All numbers are integers in units of 2^(least − 150).
  uint least = 254, greatest = 1;
  for (uint i = 0; i < 18; ++i) {
    uint bits = i < 9 ? minuends[i / 3][i % 3] : subtrahends[i / 3 - 3][i % 3];
    uint exponent = float_exponent(bits);
    if (bits << 1 != 0 && exponent < least) least = exponent;
    if (bits << 1 != 0 && exponent > greatest) greatest = exponent;
  }
  if (greatest < least) return 0;
  uint words = WORDS_OF_BITS(DETERMINANT_BITS(greatest - least + 24));
  uint determinant[kMostDeterminantWords], product[kMostDeterminantWords], factors[3][kMostDeterminantWords];
  clear_words(determinant, words);
  for (uint permutation = 0; permutation < 6; ++permutation) {
    uint odd = permutation / 3;
    for (uint row = 0; row < 3; ++row) {
      uint column = (permutation + (odd ? 3 - row : row)) % 3;
      // The sign of an odd permutation goes to the first factor.
      uint flip = odd && row == 0 ? 0x80000000 : 0;
      clear_words(factors[row], words);
      add_float(factors[row], words, minuends[row][column] ^ flip, least);
      add_float(factors[row], words, subtrahends[row][column] ^ flip ^ 0x80000000, least);
    }
    clear_words(product, words);
    add_product(product, words, factors[0], factors[1]);
    add_product(determinant, words, product, factors[2]);
  }
  return integer_sign(determinant, words);
}

#ifdef DOUBLES
INLINE double magnitude(double x) { return x > -x ? x : -x; }
#endif

// The sign of det(a − l, b − l, c − m).
INLINE int determinant_sign(float4 a, float4 b, float4 l, float4 c, float4 m) {
#ifdef DOUBLES
  // u = 2⁻⁵³. A difference d is rounded once, and a device that takes denormals for 0 is wrong by less than
  // 2⁻¹²⁶ in each of its floats: d is within u·|d| + 2⁻¹²⁵ = u·m of the real one, m = |d| + 2⁻⁷². Each of the
  // determinant's six products of three has 3 such errors and up to 5 roundings: those of two products, of
  // the difference of two of them, and of two sums. So the error is at most ((1 + u)⁸ − 1)·P < 8u·(1 + 4u)·P,
  // P being the sum of the six products of m. P and its product with the constant are rounded up to 9 times
  // themselves, and 1 + 2⁻¹⁶ makes up for that. Where a compiler contracts a product and a sum there is less
  // rounding. Nothing overflows, being below 6·2³⁸⁷; nothing underflows, being multiples of 2⁻⁴⁴⁷.
  double ax = (double)a.x - l.x, ay = (double)a.y - l.y, az = (double)a.z - l.z;
  double bx = (double)b.x - l.x, by = (double)b.y - l.y, bz = (double)b.z - l.z;
  double cx = (double)c.x - m.x, cy = (double)c.y - m.y, cz = (double)c.z - m.z;
  double determinant = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
  const double flushed = 0x1p-72;
  double Ax = magnitude(ax) + flushed, Ay = magnitude(ay) + flushed, Az = magnitude(az) + flushed;
  double Bx = magnitude(bx) + flushed, By = magnitude(by) + flushed, Bz = magnitude(bz) + flushed;
  double Cx = magnitude(cx) + flushed, Cy = magnitude(cy) + flushed, Cz = magnitude(cz) + flushed;
  double bound =
      0x1.0001p-50 * (Ax * (By * Cz + Bz * Cy) + Ay * (Bz * Cx + Bx * Cz) + Az * (Bx * Cy + By * Cx));
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
#endif
  return determinant_sign_by_integers(a, b, l, c, m);
}

// The sign (−1, 0, 1) of det(a − l, b − l, c − l). w is ignored.
INLINE int orientation(float4 a, float4 b, float4 c, float4 l) { return determinant_sign(a, b, l, c, l); }

// The same for a light at an infinite distance in the direction d, of any length: −sign det(p − r, q − r, d).
INLINE int orientation_along(float4 p, float4 q, float4 r, float4 d) {
  const float4 none = {0.0f, 0.0f, 0.0f, 0.0f};
  return -determinant_sign(p, q, r, d, none);
}

#undef DOUBLES
#ifdef __cplusplus
}  // namespace luciole
#undef SHARED_WORK
#undef INLINE
#endif
#endif
