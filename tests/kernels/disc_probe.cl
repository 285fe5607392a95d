// in: numbers of points; out: x and y of even_disc's point of that number, then of dense_disc's, which has
// fewer and starts anew.
#include "lanes.clh"
#include "maps/disc.clh"

__kernel void probe_disc(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  for (uint i = first; i < first + LANES; ++i) {
    float2 even = even_disc[(uint)in[i] % EVEN_POINTS], dense = dense_disc[(uint)in[i] % DENSE_POINTS];
    out[i] = even.x;
    out[i + stride] = even.y;
    out[i + 2 * stride] = dense.x;
    out[i + 3 * stride] = dense.y;
  }
}
