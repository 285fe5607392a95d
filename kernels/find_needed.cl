// Finds which bins of each shadow map face the lookups of a G-buffer may read, so that only those are drawn, and how far away the
// farthest is that looks there: what lies beyond it casts no shadow. One work-item goes through a tile's lights.
#include "features.clh"
#include "lanes.clh"
#include "math.clh"
#include "shadow.clh"
#include "shared.h"

// The bin that was noted last: the rows of a tile mostly fall into the same one.
typedef struct {
  uint bin, depth;
} LastNoted;

// Notes a row of lookups, those in the mask, which are on this face.
INLINE void add_needed(__global const ShadowFace *face, int reach, __global uint *needed, const MapPoint *point, intL mask,
                       LastNoted *last_noted) {
  // Lookups on faces lie within them, so these are small whole numbers.
  intL x = convert_intL(point->x), y = convert_intL(point->y), none = 0x7fffffff;
  int low_x = smallest_lane(mask ? x : none) - reach, high_x = largest_lane(mask ? x : -none) + reach;
  int low_y = smallest_lane(mask ? y : none) - reach, high_y = largest_lane(mask ? y : -none) + reach;
  // Floats that aren't negative are in order as integers too.
  uint depth = (uint)smallest_lane(mask ? as_intL(max_lanes(point->depth, (floatL)(0.0f))) : none);
  int last = (int)face->bins - 1;
  for (int y = max(low_y, 0) / kShadowBin; y <= min(max(high_y, 0) / kShadowBin, last); ++y) {
    for (int x = max(low_x, 0) / kShadowBin; x <= min(max(high_x, 0) / kShadowBin, last); ++x) {
      uint bin = face->first_bin + y * (last + 1) + x;
      if (bin == last_noted->bin && depth >= last_noted->depth) continue;
      last_noted->bin = bin;
      last_noted->depth = depth;
      atomic_min(needed + bin, depth);
    }
  }
}

// needed: one a bin, by ShadowFace::first_bin; kNotNeeded before the first tile.
__kernel void find_needed(uint plane_stride, __global const float *position, __global const float *normal,
                          __global const float *lift, __global const ShadeLight *lights, uint light_count, __global const uint *list_starts,
                          __global const ListEntry *list, __global const ShadowMap *shadow_maps,
                          __global const ShadowFace *shadow_faces, __global uint *needed) {
  if (!SHADOWS) return;
  uint tile = get_global_id(0);
  uint entry = LIGHT_LISTS ? list_starts[tile] : 0;
  uint end = LIGHT_LISTS ? list_starts[tile + 1] : light_count;
  for (; entry < end; ++entry) {
    uint index = LIGHT_LISTS ? list[entry].light : entry;
    uint squares = LIGHT_LISTS ? list[entry].squares : 0xffffffff;
    __global const ShadeLight *light = lights + index;
    if (light->shadow == kNoShadow) continue;
    __global const ShadowMap *map = shadow_maps + light->shadow;
    LastNoted last_noted = {kNotNeeded, 0};
    for (uint row = 0; row < kTilePixels; row += LANES) {
      uint first = tile * kTilePixels + row;
      if (!(squares & 1u << SQUARE_OF_PIXEL(first))) continue;
      vec3L p = load_vec3(position + first, plane_stride), n = load_vec3(normal + first, plane_stride);
      intL receives = may_light(light, &p, n);
      if (!any_lane(receives)) continue;
      // The place does not depend on the facet.
      MapPoint point = receiver_point(map, shadow_faces, p, n, n, LIFT ? load_lanes(lift + first) : (floatL)(0.0f));
      receives &= point.inside;
      point.face -= (int)map->first_face;
      for (uint face = 0; face < map->face_count; ++face) {
        intL here = receives & (point.face == (int)face);
        if (any_lane(here)) add_needed(shadow_faces + map->first_face + face, (int)map->filter_radius, needed, &point, here, &last_noted);
      }
    }
  }
}
