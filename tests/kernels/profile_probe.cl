// The share of its peak's light that a luminaire gives. in: to_light (not unit); out: profile_share, and
// angle_of(x, y).
#include "lanes.clh"
#include "math.clh"
#include "shade/profile.clh"

__kernel void probe_profile(__global const float* in, __global float* out, uint stride,
                            __global const float* luminaires) {
  uint first = work_item() * LANES;
  vec3L to_light = load_vec3(in + first, stride);
  floatL inverse_d = rsqrt_lanes(dot3(to_light, to_light));
  store_lanes(out + first, profile_share(luminaires, 1, to_light, inverse_d));
  store_lanes(out + first + stride, angle_of(to_light.x, to_light.y));
}
