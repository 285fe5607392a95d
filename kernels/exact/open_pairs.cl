// The pairs about which only textures can tell: the host gets a list of them, and its verdicts come back.
//
// In: the words of beam_shadows.cl, and verdicts. Out: the list, tile by tile, or the words. A work-item
// takes a tile.
#include "exact/light_rays.h"
#include "features.clh"
#include "lanes.clh"
#include "shared.h"

// list_starts, list, unsure, lit: see beam_shadows(). first_open: of each tile, the index of its first pair
// in `open` and `visible`.
// - settle 0: writes the pairs to `open`.
// - settle 1: sets the bits of `lit` where `visible` is 1 and not 0.
KERNEL void open_pairs(uint settle, uint light_count, __global const uint* list_starts,
                       __global const ListEntry* list, __global const uint* unsure,
                       __global const uint* first_open, __global LightRay* open,
                       __global const uchar* visible, __global uint* lit) {
  uint tile = get_global_id(0), at = first_open[tile];
  uint entry = LIGHT_LISTS ? list_starts[tile] : tile * light_count;
  uint end = LIGHT_LISTS ? list_starts[tile + 1] : entry + light_count;
  for (; entry < end; ++entry) {
    uint light = LIGHT_LISTS ? list[entry].light : entry - tile * light_count;
    for (uint word = 0; word < kPairWords; ++word) {
      uint place = entry * kPairWords + word, seen = 0;
      for (uint left = unsure[place]; left; left &= left - 1, ++at) {
        uint bit = lowest_bit(left);
        if (settle) {
          seen |= (uint)visible[at] << bit;
          continue;
        }
        open[at].point = tile * kTilePixels + word * 32 + bit;
        open[at].light = light;
      }
      if (seen) lit[place] |= seen;
    }
  }
}
