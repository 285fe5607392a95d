// in: x, y and z of four points; out: orientation() of them, then orientation_along().
#include "exact/exact_sign.h"
#include "lanes.clh"

__kernel void probe_exact_sign(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  for (uint i = first; i < first + LANES; ++i) {
    float4 point[4];
    for (uint k = 0; k < 4; ++k)
      point[k] =
          (float4)(in[i + 3 * k * stride], in[i + (3 * k + 1) * stride], in[i + (3 * k + 2) * stride], 0.0f);
    out[i] = orientation(point[0], point[1], point[2], point[3]);
    out[i + stride] = orientation_along(point[0], point[1], point[2], point[3]);
  }
}
