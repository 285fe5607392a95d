// Finds which bins of each shadow map the lookups of a G-buffer may read, so that only those are drawn, and
// for each bin the reversed depth of the point farthest from the light that looks there: what lies beyond
// casts no shadow on any.
//
// In: G-buffer planes (view space, metres), lights, light lists (cull.cl), shadow maps and their faces. Out:
// `needed`, a uint for each bin of all faces. A work-item takes a tile. It costs the place of a lookup for
// each pixel and each light with a shadow that may light it.
#include "features.clh"
#include "lanes.clh"
#include "maps/shadow.clh"
#include "math.clh"
#include "shared.h"

// The bin that was noted last. The rows of a tile mostly fall into the same one, and then need no atomic
// operation.
typedef struct {
  uint bin, depth;
} LastNoted;

// Notes the bins around a row of lookups, those in the mask; all of them are on this face. reach: texels that
// a lookup may read around its place.
INLINE void add_needed(__global const ShadowFace* face, int reach, __global uint* needed,
                       const MapPoint* point, intL mask, LastNoted* last_noted) {
  // A lookup that is on a face lies within it, so its texel fits into an int.
  intL x = convert_intL(point->x), y = convert_intL(point->y), none = 0x7fffffff;
  int low_x = smallest_lane(mask ? x : none) - reach, high_x = largest_lane(mask ? x : -none) + reach;
  int low_y = smallest_lane(mask ? y : none) - reach, high_y = largest_lane(mask ? y : -none) + reach;
  // The bits of floats ≥ 0, as integers, are in the same order.
  uint depth = (uint)smallest_lane(mask ? as_intL(max_lanes(point->depth, (floatL)(0.0f))) : none);
  int last = (int)face->bins - 1;
  for (int row = max(low_y, 0) / kShadowBin; row <= min(max(high_y, 0) / kShadowBin, last); ++row) {
    for (int column = max(low_x, 0) / kShadowBin; column <= min(max(high_x, 0) / kShadowBin, last);
         ++column) {
      uint bin = face->first_bin + row * (last + 1) + column;
      if (bin == last_noted->bin && depth >= last_noted->depth) continue;
      last_noted->bin = bin;
      last_noted->depth = depth;
      atomic_min(needed + bin, depth);
    }
  }
}

// Notes what a tile's lookups read. All but `tile`: see find_needed().
WORK void note_tile(uint tile, uint plane_stride, __global const float* position,
                    __global const float* normal, __global const float* lift,
                    __global const ShadeLight* lights, uint light_count, __global const uint* list_starts,
                    __global const ListEntry* list, __global const ShadowMap* shadow_maps,
                    __global const ShadowFace* shadow_faces, __global uint* needed) {
  uint entry = LIGHT_LISTS ? list_starts[tile] : 0;
  uint end = LIGHT_LISTS ? list_starts[tile + 1] : light_count;
  for (; entry < end; ++entry) {
    uint index = LIGHT_LISTS ? list[entry].light : entry;
    uint squares = LIGHT_LISTS ? list[entry].squares : 0xffffffff;
    __global const ShadeLight* light = lights + index;
    if (light->shadow >= kExactShadow) continue;
    __global const ShadowMap* map = shadow_maps + light->shadow;
    LastNoted last_noted = {kNotNeeded, 0};
    for (uint row = 0; row < kTilePixels; row += LANES) {
      uint first = tile * kTilePixels + row;
      if (!(squares & 1u << SQUARE_OF_PIXEL(first))) continue;
      vec3L p = load_vec3(position + first, plane_stride), n = load_vec3(normal + first, plane_stride);
      intL receives = may_light(light, &p, n);
      if (!any_lane(receives)) continue;
      // The place of a lookup doesn't depend on the surface normal, so n stands in for it.
      MapPoint point =
          receiver_point(map, shadow_faces, p, n, n, LIFT ? load_lanes(lift + first) : (floatL)(0.0f));
      receives &= point.inside;
      point.face -= (int)map->first_face;
      for (uint face = 0; face < map->face_count; ++face) {
        intL here = receives & (point.face == (int)face);
        if (any_lane(here))
          add_needed(shadow_faces + map->first_face + face, (int)map->filter_radius, needed, &point, here,
                     &last_noted);
      }
    }
  }
}

// position, normal: planes x y z, `plane_stride` floats each; lift: a plane, metres, read with LIFT only.
// needed: a bin's least depth ≥ 0 as a float's bits, at ShadowFace::first_bin and on. It has to start as
// kNotNeeded everywhere.
KERNEL void find_needed(uint plane_stride, __global const float* position, __global const float* normal,
                        __global const float* lift, __global const ShadeLight* lights, uint light_count,
                        __global const uint* list_starts, __global const ListEntry* list,
                        __global const ShadowMap* shadow_maps, __global const ShadowFace* shadow_faces,
                        __global uint* needed) {
  if (!SHADOW_MAPS) return;
  note_tile(work_item(), plane_stride, position, normal, lift, lights, light_count, list_starts, list,
            shadow_maps, shadow_faces, needed);
}
