#include "quotient.clh"

__kernel void probe_quotient(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  store_lanes(out + first, quotient_lanes(load_lanes(in + first), load_lanes(in + first + stride)));
  for (uint i = 0; i < LANES; ++i) {
    out[first + i + stride] = quotient(in[first + i], in[first + i + stride]);
    out[first + i + 2 * stride] = square_root(in[first + i]);
  }
}
