// in: unit normal, to_light, to_eye, then shininess and a channel of the specular colour; out: what is
// reflected.
#include "lanes.clh"
#include "shade/cook_torrance.clh"

__kernel void probe_cook_torrance(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  vec3L normal = load_vec3(in + first, stride);
  vec3L to_light = load_vec3(in + 3 * stride + first, stride);
  vec3L to_eye = load_vec3(in + 6 * stride + first, stride);
  Gloss gloss = cook_torrance_gloss(load_lanes(in + 9 * stride + first), dot3(normal, to_eye));
  floatL f0 = load_lanes(in + 10 * stride + first);
  Glint glint = cook_torrance(gloss, normal, to_light, to_eye, dot3(normal, to_light));
  store_lanes(out + first, glint.facing * f0 + glint.grazing * grazing_color(f0));
}
