// Integers of many words, for host and devices: what exact signs need where numbers of the machine are too
// short.
//
// An integer is `words` words of 32 bits, the lowest first, in two's complement: sums and products are those
// of the integers modulo 2^(32·words), whatever their signs, and right where the result fits.
#ifndef LUCIOLE_WIDE_INTEGER_H
#define LUCIOLE_WIDE_INTEGER_H

#include "shared.h"
#ifdef __cplusplus
#include <bit>
#define SHARED_WORK static inline
#define INLINE static inline
namespace luciole {
typedef unsigned long long ulong;
INLINE uint float_bits(float value) { return std::bit_cast<uint>(value); }
#else
#include "lanes.clh"
INLINE uint float_bits(float value) { return as_uint(value); }
#endif

// A finite float, by its bits, is an integer times 2^(float_exponent(bits) − 150). Arithmetic of floats would
// not do: it may take denormals for 0.
INLINE uint float_exponent(uint bits) {
  uint exponent = bits >> 23 & 0xff;
  return exponent != 0 ? exponent : 1;
}

// sum += the float of these bits, in units of 2^(unit − 150); unit: float_exponent(bits) or less, unless the
// float is 0.
SHARED_WORK void add_float(uint* sum, uint words, uint bits, uint unit) {
  ulong digits = (bits & 0x7fffff) | ((bits & 0x7f800000) != 0 ? 0x800000 : 0);
  if (digits == 0) return;
  uint shift = float_exponent(bits) - unit;
  digits <<= shift % 32;
  // −x is ~x + 1.
  uint flip = bits >> 31 != 0 ? 0xffffffff : 0;
  ulong carry = flip & 1;
  for (uint i = shift / 32; i < words; ++i) {
    carry += (ulong)sum[i] + ((uint)digits ^ flip);
    sum[i] = (uint)carry;
    carry >>= 32;
    digits >>= 32;
  }
}

// sum += a·b
SHARED_WORK void add_product(uint* sum, uint words, const uint* a, const uint* b) {
  for (uint i = 0; i < words; ++i) {
    ulong carry = 0;
    for (uint j = 0; i + j < words; ++j) {
      carry += sum[i + j] + (ulong)a[i] * b[j];
      sum[i + j] = (uint)carry;
      carry >>= 32;
    }
  }
}

INLINE void clear_words(uint* integer, uint words) {
  for (uint i = 0; i < words; ++i) integer[i] = 0;
}

// −1, 0 or 1
INLINE int integer_sign(const uint* integer, uint words) {
  if (integer[words - 1] >> 31 != 0) return -1;
  uint any = 0;
  for (uint i = 0; i < words; ++i) any |= integer[i];
  return any != 0;
}

#ifdef __cplusplus
}  // namespace luciole
#undef SHARED_WORK
#undef INLINE
#endif
#endif
