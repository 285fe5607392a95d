// What the functions of math.clh cost: each work-item sums one over a block of values that stays in the
// first-level cache. Arguments are (block of `stride` values for each argument, sums, stride).
#include "lanes.clh"
#include "math.clh"

#define TIMED(name, expression)                                                    \
  __kernel void name(__global const float* in, __global float* out, uint stride) { \
    floatL sum = 0.0f;                                                             \
    for (uint i = 0; i < stride; i += LANES) sum += expression;                    \
    store_lanes(out + work_item() * LANES, sum);                                   \
  }
#define X load_lanes(in + i)
#define Y load_lanes(in + stride + i)
#define VECTOR load_vec3(in + i, stride)

INLINE floatL component_sum(vec3L v) { return v.x + v.y + v.z; }

// What the loop itself costs.
TIMED(time_load, X)
TIMED(time_rsqrt, rsqrt_lanes(X))
TIMED(time_normalize, component_sum(normalize_lanes(VECTOR)))
TIMED(time_exp2_product, exp2_product(X, Y))
TIMED(time_exp, exp_lanes(X))
TIMED(time_log2_one_plus, log2_one_plus(X))
TIMED(time_pow_one_plus, pow_one_plus(X, Y))
