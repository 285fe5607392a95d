// Tangents of packed directions. in: a packed direction's bits, normal; out: tangent and bitangent.
#include "lanes.clh"
#include "shade/tangents.clh"

__kernel void probe_tangents(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  vec3L tangent, bitangent;
  load_tangents((__global const uint*)in + first, load_vec3(in + stride + first, stride), &tangent,
                &bitangent);
  store_lanes(out + first, tangent.x);
  store_lanes(out + first + stride, tangent.y);
  store_lanes(out + first + 2 * stride, tangent.z);
  store_lanes(out + first + 3 * stride, bitangent.x);
  store_lanes(out + first + 4 * stride, bitangent.y);
  store_lanes(out + first + 5 * stride, bitangent.z);
}
