// in: unit normal, to_light, to_eye, then the shininess; out: what is reflected of diffuse light.
#include "lanes.clh"
#include "shade/oren_nayar.clh"

__kernel void probe_oren_nayar(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  vec3L normal = load_vec3(in + first, stride);
  vec3L to_light = load_vec3(in + 3 * stride + first, stride);
  vec3L to_eye = load_vec3(in + 6 * stride + first, stride);
  Roughness roughness = oren_nayar_roughness(load_lanes(in + 9 * stride + first));
  floatL n_dot_l = max_lanes(dot3(normal, to_light), (floatL)(0.0f));
  store_lanes(out + first, oren_nayar(roughness, to_light, to_eye, n_dot_l, dot3(normal, to_eye)));
}
