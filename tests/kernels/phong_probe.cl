// Both lobes. in: normal, to_light, to_eye, exponent; out: Phong's and Blinn's factor.
#include "lanes.clh"
#include "phong.clh"

__kernel void probe_lobes(__global const float *in, __global float *out, uint stride) {
  uint first = get_global_id(0) * LANES;
  vec3L normal = load_vec3(in + first, stride);
  vec3L to_light = load_vec3(in + 3 * stride + first, stride);
  vec3L to_eye = load_vec3(in + 6 * stride + first, stride);
  floatL exponent = load_lanes(in + 9 * stride + first);
  store_lanes(out + first, phong_lobe(normal, to_light, dot3(normal, to_light), to_eye, exponent));
  store_lanes(out + first + stride, blinn_lobe(normal, to_light, to_eye, exponent));
}
