// Both lobes. in: normal, to_light (not unit), to_eye, exponent; out: Phong's and Blinn's factor.
#include "lanes.clh"
#include "shade/phong.clh"

__kernel void probe_lobes(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  vec3L normal = load_vec3(in + first, stride);
  vec3L to_light = load_vec3(in + 3 * stride + first, stride);
  vec3L to_eye = load_vec3(in + 6 * stride + first, stride);
  floatL exponent = load_lanes(in + 9 * stride + first);
  floatL inverse_d = rsqrt_lanes(dot3(to_light, to_light));
  floatL n_dot_l = dot3(normal, to_light) * inverse_d, n_dot_v = dot3(normal, to_eye);
  floatL blinn = blinn_lobe(to_light, inverse_d, to_eye, normal, n_dot_l, n_dot_v);
  store_lanes(out + first, pow_one_plus(phong_lobe(to_light, inverse_d, mirror(to_eye, normal)), exponent));
  store_lanes(out + first + stride, pow_one_plus(blinn, 0.5f * exponent));
}
