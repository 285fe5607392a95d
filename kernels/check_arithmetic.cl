// Every operation of check_arithmetic.clh on LANES cases. in: columns a, b and c; out: a column of bits for
// each operation, in their order there. Columns are `stride` elements apart.
#include "check_arithmetic.clh"

KERNEL void check_arithmetic(__global const float* in, __global int* out, uint stride) {
  uint first = work_item() * LANES, at = first;
  floatL a = load_lanes(in + first), b = load_lanes(in + first + stride),
         c = load_lanes(in + first + 2 * stride);
  intL i = as_intL(a), j = as_intL(b);
#define STORE_FLOAT(name, expression)                \
  *(__global intL*)(out + at) = as_intL(expression); \
  at += stride;
#define STORE_INTEGER(name, expression)       \
  *(__global intL*)(out + at) = (expression); \
  at += stride;
  EACH_FLOAT_OPERATION(STORE_FLOAT)
  EACH_INTEGER_OPERATION(STORE_INTEGER)
}
