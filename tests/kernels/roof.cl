// How many pixel-light pairs a second the vector units could do: the instructions that shade.cl's machine
// code has for a pair (point light, range window, Phong's lobe; AVX-512), with nothing to load and nothing to
// wait for. Those of two pairs go round sixteen values, so that none is needed again before it is ready.
//
//   a pair in shade.cl      39 fused multiply-adds, 18 products, 7 sums, 8 integer,
//                           5 compared and chosen, 2 extremes, 1 converted
//   half of a round here    40 fused multiply-adds, 16 products, 8 sums, 8 integer,
//                           5 compared and chosen, 2 extremes, 1 converted
//   1
#include "lanes.clh"
#include "shared.h"

#define CHAINS 16
#define EACH_CHAIN(c) _Pragma("unroll") for (uint c = 0; c < CHAINS; ++c)
#define SOME_CHAINS(c, count) _Pragma("unroll") for (uint c = 0; c < (count); ++c)

// lights[0]: where the factors come from, so that the compiler cannot know them. image: r, of
// frame.plane_stride floats.
__kernel void roof(ShadeFrame frame, __global const ShadeLight* lights, uint light_count,
                   __global float* image) {
  uint first = work_item() * LANES;
  floatL factor = lights[0].attenuation.x, term = lights[0].position.w, limit = lights[0].diffuse.x;
  intL mask = (intL)((int)lights[0].kind - 1), step = (intL)((int)lights[0].khr_window + 1);
  floatL x[CHAINS];
  intL n[CHAINS / 2];
  EACH_CHAIN(c) x[c] = (floatL)((float)(first + c) * 1e-9f);
  SOME_CHAINS(c, CHAINS / 2) n[c] = (intL)((int)(first + c));
  for (uint pair = 0; pair < light_count; pair += 2) {
    _Pragma("unroll") for (int turn = 0; turn < 5; ++turn) EACH_CHAIN(c) x[c] = x[c] * factor + term;
    EACH_CHAIN(c) x[c] = x[c] * factor;
    SOME_CHAINS(c, CHAINS / 2) n[c] = (n[c] & mask) + step;
    EACH_CHAIN(c) x[c] = x[c] + term;
    SOME_CHAINS(c, 10) x[c] = x[c] < limit ? x[c] : term;
    EACH_CHAIN(c) x[c] = x[c] * factor;
    SOME_CHAINS(c, 4) x[c + 10] = max_lanes(x[c + 10], term);
    SOME_CHAINS(c, 2) x[c + 14] = convert_floatL(n[c]);
  }
  floatL sum = 0.0f;
  EACH_CHAIN(c) sum += x[c];
  SOME_CHAINS(c, CHAINS / 2) sum += convert_floatL(n[c]);
  store_lanes(image + first, sum);
}
