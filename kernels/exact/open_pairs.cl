// The pairs about which only the host can tell, where textures decide: it gets a list of them, and its shares
// come back.
//
// In: the words of beam_shadows.cl, with SOFT_EXACT the shares of pair_rays.cl, and the host's. Out: the
// list, tile by tile, or words and shares that say what it says. A work-item takes a tile.
#include "exact/light_rays.h"
#include "features.clh"
#include "lanes.clh"
#include "shared.h"

// list_starts, list, unsure, lit: see beam_shadows(). first_share, shares: see pair_rays(), with SOFT_EXACT
// only. first_open: of each tile, the index of its first pair in `open` and `seen`.
// - settle 0: writes the pairs to `open`: all that are unsure, or those of OPEN_SHARE.
// - settle 1: brings their shares, `seen`, to `shares`, or to bits of `lit` where they are above 0.
KERNEL void open_pairs(uint settle, uint light_count, __global const uint* list_starts,
                       __global const ListEntry* list, __global const uint* unsure,
                       __global const uint* first_share, __global const uint* first_open,
                       __global LightRay* open, __global const float* seen, __global uint* lit,
                       __global float* shares) {
  uint tile = work_item(), at = first_open[tile];
  uint entry = LIGHT_LISTS ? list_starts[tile] : tile * light_count;
  uint end = LIGHT_LISTS ? list_starts[tile + 1] : entry + light_count;
  for (; entry < end; ++entry) {
    uint light = LIGHT_LISTS ? list[entry].light : entry - tile * light_count;
    for (uint word = 0; word < kPairWords; ++word) {
      uint place = entry * kPairWords + word, share = SOFT_EXACT ? first_share[place] : 0;
      for (uint left = unsure[place]; left; left &= left - 1, ++share) {
        if (SOFT_EXACT && shares[share] != OPEN_SHARE) continue;
        uint bit = lowest_bit(left);
        if (!settle) {
          open[at].point = tile * kTilePixels + word * 32 + bit;
          open[at].light = light;
        } else if (SOFT_EXACT) {
          shares[share] = seen[at];
        } else if (seen[at] > 0.0f) {
          lit[place] |= 1u << bit;
        }
        ++at;
      }
    }
  }
}
