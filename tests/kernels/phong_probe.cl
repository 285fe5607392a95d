// Both lobes. in: normal, to_light (not unit), to_eye, exponent; out: Phong's and Blinn's factor.
#include "lanes.clh"
#include "phong.clh"

__kernel void probe_lobes(__global const float *in, __global float *out, uint stride) {
  uint first = get_global_id(0) * LANES;
  vec3L normal = load_vec3(in + first, stride);
  vec3L to_light = load_vec3(in + 3 * stride + first, stride);
  vec3L to_eye = load_vec3(in + 6 * stride + first, stride);
  floatL exponent = load_lanes(in + 9 * stride + first);
  floatL inverse_d = rsqrt_lanes(dot3(to_light, to_light));
  store_lanes(out + first, pow_one_minus_half(phong_chord2(to_light, inverse_d, mirror(to_eye, normal)), exponent));
  store_lanes(out + first + stride, pow_one_minus_half(blinn_chord2(to_light, inverse_d, to_eye, normal), exponent));
}
