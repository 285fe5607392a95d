// in: colour, position; out: the colour through the fog.
#include "lanes.clh"
#include "shade/fog.clh"
#include "shared.h"

__kernel void probe_fog(__global const float* in, __global float* out, uint stride,
                        __global const ShadeFrame* frame) {
  uint first = work_item() * LANES;
  vec3L seen = apply_fog(*frame, load_vec3(in + first, stride), load_vec3(in + 3 * stride + first, stride));
  store_lanes(out + first, seen.x);
  store_lanes(out + first + stride, seen.y);
  store_lanes(out + first + 2 * stride, seen.z);
}
