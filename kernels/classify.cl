// Classifies pairs of a pixel and a light by conservative shadow maps (BoundTexel): lit for certain, dark for certain, or unsure,
// which rays decide. One work-item goes through a tile's lights.
#include "features.clh"
#include "lanes.clh"
#include "math.clh"
#include "shadow.clh"
#include "shared.h"

// A row of texels: of the plane of what covers all of the texel, and of what else may be in it.
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

// Masks: neither is unsure.
typedef struct {
  intL lit, dark;
} Verdict;

// The farthest that a lookup may be off, for the texel's margin (see rasterizeBounds) to hold all it may mean.
#define MOST_DRIFT 0x1p-8f

// p: view space.
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
  // What the receiver's depth, its place on the plane and the plane's own floats have lost.
  floatL steep = abs_lanes(texel.step_x) + abs_lanes(texel.step_y);
  floatL lost = point.rounding + steep * point.drift + 0x1p-22f * (abs_lanes(depth) + steep);
  floatL above = point.depth - plane;
  intL before_others = on_map & (point.depth > texel.others + lost);

  // The receiver's distance from the plane, metres. With the plane n·q = D in the face's axes, 1/w is (n·(u, v, 1))/D on it, and
  // the distance w·|D|/|n|·|1/w_plane − 1/w|; under a parallel map the height above it times the cosine of its tilt.
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
  // A ray lets the triangle through in whose plane it starts, as far as that can be told of a point.
  floatL from_eye2 = dot3(p, p);
  floatL tolerance = POINT_ERROR * from_eye2 * rsqrt_lanes(from_eye2);
  intL on_plane = (abs_lanes(above) + lost) * metres < tolerance * 0.999f;
  intL behind = (above < 0.0f) & ((-above - lost) * metres > tolerance * 1.001f);
  verdict.lit = before_others & ((!covered) | (above > lost) | on_plane);
  verdict.dark = on_map & covered & behind;
  return verdict;
}

// bits: kPairWords words for each entry of the lists: first the pixels of the tile that are lit, then those that are unsure.
__kernel void classify(uint plane_stride, __global const float *position, __global const float *normal,
                       __global const float *lift, __global const ShadeLight *lights, uint light_count, __global const uint *list_starts,
                       __global const ListEntry *list, __global const ShadowMap *shadow_maps,
                       __global const ShadowFace *shadow_faces, __global const BoundTexel *texels, uint texel_count,
                       __global uint *bits) {
  if (!SHADOWS) return;
  uint tile = get_global_id(0);
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
      // Off the map nothing is sure.
      MapPoint point = LIFT ? lifted_point(map, shadow_faces, p, n, n, load_lanes(lift + first)) : map_point(map, shadow_faces, p, n);
      Verdict verdict = classify_points(map, shadow_faces, texels, texel_count, point, p);
      lit[row / 32] |= lane_bits(receives & verdict.lit) << row % 32;
      unsure[row / 32] |= lane_bits(receives & !(verdict.lit | verdict.dark)) << row % 32;
    }
  }
}
