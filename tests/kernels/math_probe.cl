// Every function of math.clh, and of lanes.clh what computes, a kernel each.
#include "lanes.clh"
#include "math.clh"

#define PROBE_1(name, function)                                                    \
  __kernel void name(__global const float* in, __global float* out, uint stride) { \
    uint first = work_item() * LANES;                                              \
    store_lanes(out + first, function(load_lanes(in + first)));                    \
  }
#define PROBE_2(name, function)                                                                  \
  __kernel void name(__global const float* in, __global float* out, uint stride) {               \
    uint first = work_item() * LANES;                                                            \
    store_lanes(out + first, function(load_lanes(in + first), load_lanes(in + first + stride))); \
  }

// √x as fog and shadows take it.
INLINE floatL root(floatL x) { return x * rsqrt_lanes(x); }

PROBE_1(probe_rsqrt, rsqrt_lanes)
PROBE_1(probe_sqrt, root)
PROBE_1(probe_exp, exp_lanes)
PROBE_1(probe_log2_one_plus, log2_one_plus)
PROBE_1(probe_finite_color, finite_color)
PROBE_1(probe_clamp01, clamp01)
PROBE_2(probe_exp2_product, exp2_product)
PROBE_2(probe_pow_one_plus, pow_one_plus)
PROBE_2(probe_max, max_lanes)
PROBE_2(probe_min, min_lanes)

#define PROBE_3(name, expression)                                                  \
  __kernel void name(__global const float* in, __global float* out, uint stride) { \
    uint first = work_item() * LANES;                                              \
    floatL a = load_lanes(in + first), b = load_lanes(in + first + stride),        \
           c = load_lanes(in + first + 2 * stride);                                \
    store_lanes(out + first, expression);                                          \
  }
PROBE_3(probe_fma, fma_lanes(a, b, c))
PROBE_3(probe_product_and_sum, a* b + c)

__kernel void probe_normalize(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  vec3L unit = normalize_lanes(load_vec3(in + first, stride));
  store_lanes(out + first, unit.x);
  store_lanes(out + first + stride, unit.y);
  store_lanes(out + first + 2 * stride, unit.z);
}

// 1 in every lane of a row where any lane is above 0, else 0.
__kernel void probe_any_lane(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  store_lanes(out + first, (floatL)(any_lane(load_lanes(in + first) > 0.0f) ? 1.0f : 0.0f));
}

#define PROBE_ROW(name, expression)                                                \
  __kernel void name(__global const float* in, __global float* out, uint stride) { \
    uint first = work_item() * LANES;                                              \
    floatL row = load_lanes(in + first);                                           \
    store_lanes(out + first, (floatL)((float)(expression)));                       \
  }
PROBE_ROW(probe_least_lane, least_lane(row))
PROBE_ROW(probe_greatest_lane, greatest_lane(row))
PROBE_ROW(probe_smallest_lane, smallest_lane(convert_intL(row)))
PROBE_ROW(probe_largest_lane, largest_lane(convert_intL(row)))
PROBE_ROW(probe_lane_bits, lane_bits(row < 0.0f))

// packed: by packNormal().
__kernel void probe_unpack_normal(__global const float* in, __global float* out, uint stride,
                                  __global const uint* packed) {
  uint first = work_item() * LANES;
  vec3L unit = unpack_normal(*(__global const intL*)(packed + first));
  store_lanes(out + first, unit.x);
  store_lanes(out + first + stride, unit.y);
  store_lanes(out + first + 2 * stride, unit.z);
}
