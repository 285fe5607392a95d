// in: unit normal, to_light, to_eye, the shininess, the tangent, the bitangent, and the roughness along both;
// out: the highlight, and that of the brushed surface.
#include "lanes.clh"
#include "shade/ward.clh"

__kernel void probe_ward(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  vec3L normal = load_vec3(in + first, stride);
  vec3L to_light = load_vec3(in + 3 * stride + first, stride);
  vec3L to_eye = load_vec3(in + 6 * stride + first, stride);
  floatL sharpness = ward_sharpness(load_lanes(in + 9 * stride + first));
  floatL n_dot_l = dot3(normal, to_light), n_dot_v = dot3(normal, to_eye);
  store_lanes(out + first, ward_lobe(sharpness, normal, to_light, to_eye, n_dot_l, n_dot_v));
  vec3L tangent = load_vec3(in + 10 * stride + first, stride);
  vec3L bitangent = load_vec3(in + 13 * stride + first, stride);
  floatL alpha_x = load_lanes(in + 16 * stride + first), alpha_y = load_lanes(in + 17 * stride + first);
  store_lanes(out + first + stride, ward_anisotropic_lobe(alpha_x, alpha_y, tangent, bitangent, to_light,
                                                          to_eye, n_dot_l, n_dot_v));
}
