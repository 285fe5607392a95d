// in: position, normal, N·L; out: the share of the light that one map lets through.
#include "lanes.clh"
#include "shadow.clh"
#include "shared.h"

__kernel void probe_shadow(__global const float *in, __global float *out, uint stride, __global const ShadowMap *map,
                           __global const float *depths) {
  uint first = get_global_id(0) * LANES;
  vec3L position = load_vec3(in + first, stride);
  vec3L normal = load_vec3(in + 3 * stride + first, stride);
  store_lanes(out + first, light_visibility(map, depths, position, normal, load_lanes(in + 6 * stride + first)));
}
