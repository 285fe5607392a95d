// Falloff of one light. in: to_light (not unit) for probe_falloff; out: distance_falloff and spot_falloff.
#include "lanes.clh"
#include "math.clh"
#include "shade/falloff.clh"
#include "shared.h"

__kernel void probe_falloff(__global const float* in, __global float* out, uint stride,
                            __global const ShadeLight* light) {
  uint first = work_item() * LANES;
  vec3L to_light = load_vec3(in + first, stride);
  floatL d2 = SQUARED_LENGTH(to_light.x, to_light.y, to_light.z);
  floatL inverse_d = rsqrt_lanes(d2);
  store_lanes(out + first, distance_falloff(light, range_window(light, d2), d2, inverse_d));
  store_lanes(out + first + stride, spot_falloff(light, to_light, inverse_d));
}
