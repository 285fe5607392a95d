// in: a cosine, or a lobe; out: the tone of the one and the highlight of the other.
#include "lanes.clh"
#include "shade/toon.clh"

__kernel void probe_toon(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  floatL x = load_lanes(in + first);
  store_lanes(out + first, toon(x));
  store_lanes(out + first + stride, toon_highlight(x));
}
