// The first step of exact shadows: decides by conservative shadow maps (BoundTexel) which pixels a light certainly reaches (lit),
// which it certainly doesn't reach (dark), and which are unsure. Rays decide those on the host (host/render/exact_shadows.cpp).
//
// In: G-buffer planes (view space, metres), lights, light lists (cull.cl), shadow maps with their faces and BoundTexels.
// Out: `bits`, 64 bytes for each entry of the lists. Without LIGHT_LISTS every tile has an entry for every light.
// A work-item takes a tile. It costs one lookup, a texel of 16 bytes, for each pixel and each light with a shadow that may light it.
#include "features.clh"
#include "lanes.clh"
#include "math.clh"
#include "shadow.clh"
#include "shared.h"

// The BoundTexels of a row of lookups.
typedef struct {
  floatL depth, step_x, step_y, others;
} BoundRow;

INLINE BoundRow gather_bounds(__global const BoundTexel *texels, intL index) {
  BoundRow row;
  const int *from = (const int *)&index;
  float *depth = (float *)&row.depth, *step_x = (float *)&row.step_x, *step_y = (float *)&row.step_y, *others = (float *)&row.others;
  for (int lane = 0; lane < LANES; ++lane) {
    BoundTexel texel = texels[from[lane]];
    depth[lane] = texel.depth;
    step_x[lane] = texel.step_x;
    step_y[lane] = texel.step_y;
    others[lane] = texel.others;
  }
  return row;
}

// Masks. A lane in neither is unsure.
typedef struct {
  intL lit, dark;
} Verdict;

// By how much the place of a lookup may be wrong, texels: the part of a BoundTexel's margin, kBoundGrowth, that is left for it
// (host/raster/bound_depth.hpp).
#define MOST_DRIFT 0x1p-8f

// Which of the points are lit, and which are dark. point: where they are looked up; p: view space.
INLINE Verdict classify_points(__global const ShadowMap *map, __global const ShadowFace *faces, __global const BoundTexel *texels,
                               uint texel_count, MapPoint point, vec3L p) {
  Verdict verdict;
  intL on_map = point.inside & (abs_lanes(point.x) < 65536.0f) & (abs_lanes(point.y) < 65536.0f) & (point.drift < MOST_DRIFT);
  floatL x = on_map ? point.x : (floatL)(0.0f), y = on_map ? point.y : (floatL)(0.0f);
  intL column = convert_intL(x), row = convert_intL(y);
  Texels here = texels_of(faces, 0, texel_count, point);
  uintL index = as_uintL(here.first + row * here.width + column);
  index = index < here.last ? index : (uintL)(here.last);
  BoundRow texel = gather_bounds(texels, as_intL(index));
  intL covered = texel.depth > -INFINITY;
  floatL depth = covered ? texel.depth : (floatL)(0.0f);
  floatL plane = depth + texel.step_x * (x - convert_floatL(column) - 0.5f) + texel.step_y * (y - convert_floatL(row) - 0.5f);
  // Bound of the rounding errors of `above`: of the receiver's depth, of its place in the texel, and of the plane.
  floatL steep = abs_lanes(texel.step_x) + abs_lanes(texel.step_y);
  floatL lost = point.rounding + steep * point.drift + 0x1p-22f * (abs_lanes(depth) + steep);
  floatL above = point.depth - plane;
  intL before_others = on_map & (point.depth > texel.others + lost);

  // Metres between the receiver and the plane for a unit of depth between them. In the face's axes let the plane be n·q = D.
  // On it 1/w = n·(u, v, 1)/D, and the receiver's distance from it is w·|D|/|n|·|1/w_plane − 1/w|. (a, b, c) is n/D.
  // In a parallel map the distance is the height above the plane times the cosine of its tilt.
  floatL scale = point.scale;
  floatL per_depth = 1.0f / map->depth_scale;
  floatL metres;
  if (map->kind == kParallelMap) {
    floatL a = texel.step_x * scale, b = texel.step_y * scale;
    metres = rsqrt_lanes(map->depth_scale + a * a + b * b);
  } else {
    floatL a = texel.step_x * scale * per_depth, b = texel.step_y * scale * per_depth;
    floatL c = (plane - map->depth_offset) * per_depth - a * point.u + b * point.v;
    metres = point.w * per_depth * rsqrt_lanes(a * a + b * b + c * c);
  }
  // A shadow ray ignores a triangle in whose plane it starts, up to this distance in metres (host/rays/shadow_rays.cpp). The verdict
  // has to agree with it, and leaves the distances within 0.1 % of the tolerance to the ray.
  floatL from_eye2 = dot3(p, p);
  floatL tolerance = POINT_ERROR * from_eye2 * rsqrt_lanes(from_eye2);
  intL on_plane = (abs_lanes(above) + lost) * metres < tolerance * 0.999f;
  intL behind = (above < 0.0f) & ((-above - lost) * metres > tolerance * 1.001f);
  verdict.lit = before_others & ((!covered) | (above > lost) | on_plane);
  verdict.dark = on_map & covered & behind;
  return verdict;
}

// Decides the pairs of a tile. All but `tile`: see classify().
WORK void classify_tile(uint tile, uint plane_stride, __global const float *position, __global const float *normal,
                        __global const float *lift, __global const ShadeLight *lights, uint light_count,
                        __global const uint *list_starts, __global const ListEntry *list, __global const ShadowMap *shadow_maps,
                        __global const ShadowFace *shadow_faces, __global const BoundTexel *texels, uint texel_count,
                        __global uint *bits) {
  uint entry = LIGHT_LISTS ? list_starts[tile] : tile * light_count;
  uint end = LIGHT_LISTS ? list_starts[tile + 1] : entry + light_count;
  for (; entry < end; ++entry) {
    uint index = LIGHT_LISTS ? list[entry].light : entry - tile * light_count;
    uint squares = LIGHT_LISTS ? list[entry].squares : 0xffffffff;
    __global const ShadeLight *light = lights + index;
    __global uint *lit = bits + entry * kPairWords, *unsure = lit + kPairWords / 2;
    for (uint word = 0; word < kPairWords; ++word) lit[word] = 0;
    if (light->shadow == kNoShadow) continue;
    __global const ShadowMap *map = shadow_maps + light->shadow;
    for (uint row = 0; row < kTilePixels; row += LANES) {
      uint first = tile * kTilePixels + row;
      if (!(squares & 1u << SQUARE_OF_PIXEL(first))) continue;
      vec3L p = load_vec3(position + first, plane_stride), n = load_vec3(normal + first, plane_stride);
      intL receives = may_light(light, &p, n);
      if (!any_lane(receives)) continue;
      // Points off the map stay unsure, so a lift that leads off it needs no second lookup (see receiver_point).
      MapPoint point = LIFT ? lifted_point(map, shadow_faces, p, n, n, load_lanes(lift + first)) : map_point(map, shadow_faces, p, n);
      Verdict verdict = classify_points(map, shadow_faces, texels, texel_count, point, p);
      lit[row / 32] |= lane_bits(receives & verdict.lit) << row % 32;
      unsure[row / 32] |= lane_bits(receives & !(verdict.lit | verdict.dark)) << row % 32;
    }
  }
}

// position, normal: planes x y z, `plane_stride` floats each; lift: a plane, metres, read with LIFT only.
// texels: texel_count ≥ 1. bits: kPairWords words for each entry, a bit for each pixel of the tile. The first half holds the pixels
// that are lit, the second half those that are unsure. Words of lights without a shadow are 0.
__kernel void classify(uint plane_stride, __global const float *position, __global const float *normal,
                       __global const float *lift, __global const ShadeLight *lights, uint light_count, __global const uint *list_starts,
                       __global const ListEntry *list, __global const ShadowMap *shadow_maps,
                       __global const ShadowFace *shadow_faces, __global const BoundTexel *texels, uint texel_count,
                       __global uint *bits) {
  if (!SHADOWS) return;
  classify_tile(get_global_id(0), plane_stride, position, normal, lift, lights, light_count, list_starts, list, shadow_maps,
                shadow_faces, texels, texel_count, bits);
}
