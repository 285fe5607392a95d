// Light lists: for every tile the lights that can reach a point it shows, in the order of light indices, as long as they
// come. Two passes: count, scan, fill.
//
//   tile_bounds → count_lights → scan_lists → fill_lists
//
//   list_starts  0 3 3 7 …          a tile's entries in `list` are [list_starts[tile], list_starts[tile + 1])
//   list         4 9 12 | | 0 …     an entry indexes the lights
#include "falloff.clh"
#include "lanes.clh"
#include "shared.h"

// The box around the points that a tile shows, in view space, its depth range included; background does not count.
// low, high: xyz per tile; an empty tile has low > high.
__kernel void tile_bounds(__global const float *position, uint plane_stride, __global float4 *low, __global float4 *high) {
  uint tile = get_global_id(0);
  vec3L least = {(floatL)(INFINITY), (floatL)(INFINITY), (floatL)(INFINITY)};
  vec3L most = {(floatL)(-INFINITY), (floatL)(-INFINITY), (floatL)(-INFINITY)};
  for (uint pixel = 0; pixel < kTilePixels; pixel += LANES) {
    vec3L p = load_vec3(position + tile * kTilePixels + pixel, plane_stride);
    intL covered = p.z > -INFINITY;
    least.x = min_lanes(least.x, covered ? p.x : (floatL)(INFINITY));
    least.y = min_lanes(least.y, covered ? p.y : (floatL)(INFINITY));
    least.z = min_lanes(least.z, covered ? p.z : (floatL)(INFINITY));
    most.x = max_lanes(most.x, covered ? p.x : (floatL)(-INFINITY));
    most.y = max_lanes(most.y, covered ? p.y : (floatL)(-INFINITY));
    most.z = max_lanes(most.z, covered ? p.z : (floatL)(-INFINITY));
  }
  const float *lx = (const float *)&least.x, *ly = (const float *)&least.y, *lz = (const float *)&least.z;
  const float *hx = (const float *)&most.x, *hy = (const float *)&most.y, *hz = (const float *)&most.z;
  float4 l = (float4)(INFINITY), h = (float4)(-INFINITY);
  for (int lane = 0; lane < LANES; ++lane) {
    l = min(l, (float4)(lx[lane], ly[lane], lz[lane], 0.0f));
    h = max(h, (float4)(hx[lane], hy[lane], hz[lane], 0.0f));
  }
  low[tile] = l;
  high[tile] = h;
}

// Which of the LANES lights from `first` on reach the box: a mask. reach: planes x, y, z of the lights' places and
// 1 / range², 0 for lights that reach everywhere. The distance to the box is computed with shading's own operations, each of
// which rounds monotonically, so it never exceeds the distance that shading computes for a point inside the box.
INLINE intL lights_in_reach(__global const float *reach, uint reach_stride, uint first, float4 low, float4 high) {
  floatL x = load_lanes(reach + first);
  floatL y = load_lanes(reach + reach_stride + first);
  floatL z = load_lanes(reach + 2 * reach_stride + first);
  floatL inverse_range2 = load_lanes(reach + 3 * reach_stride + first);
  floatL zero = 0.0f;
  floatL dx = max_lanes(max_lanes(low.x - x, x - high.x), zero);
  floatL dy = max_lanes(max_lanes(low.y - y, y - high.y), zero);
  floatL dz = max_lanes(max_lanes(low.z - z, z - high.z), zero);
  floatL ratio2 = SQUARED_LENGTH(dx, dy, dz) * inverse_range2;
  // NaN (infinitely far × reaches everywhere) stays in.
  return !(ratio2 >= 1.0f);
}

// How many lights each tile's list will hold.
__kernel void count_lights(__global const float4 *low, __global const float4 *high, __global const float *reach,
                           uint reach_stride, __global uint *counts) {
  uint tile = get_global_id(0);
  float4 l = low[tile], h = high[tile];
  intL found = 0;
  if (l.x <= h.x) {
    for (uint first = 0; first < reach_stride; first += LANES)
      found += lights_in_reach(reach, reach_stride, first, l, h) ? (intL)(1) : (intL)(0);
  }
  const int *lanes = (const int *)&found;
  uint sum = 0;
  for (int lane = 0; lane < LANES; ++lane) sum += (uint)lanes[lane];
  counts[tile] = sum;
}

// Exclusive prefix sum of the counts in place, by one work-item; starts[tiles] becomes the total.
// The total saturates at 2³² − 1, which the host refuses.
__kernel void scan_lists(uint tiles, __global uint *starts) {
  ulong sum = 0;
  for (uint tile = 0; tile < tiles; ++tile) {
    uint count = starts[tile];
    starts[tile] = (uint)min(sum, (ulong)0xffffffffu);
    sum += count;
  }
  starts[tiles] = (uint)min(sum, (ulong)0xffffffffu);
}

// Writes the lists.
__kernel void fill_lists(__global const float4 *low, __global const float4 *high, __global const float *reach,
                         uint reach_stride, __global const uint *list_starts, __global uint *list) {
  uint tile = get_global_id(0);
  float4 l = low[tile], h = high[tile];
  uint next = list_starts[tile];
  if (next == list_starts[tile + 1]) return;
  for (uint first = 0; first < reach_stride; first += LANES) {
    intL reached = lights_in_reach(reach, reach_stride, first, l, h);
    if (!any_lane(reached)) continue;
    const int *lanes = (const int *)&reached;
    for (int lane = 0; lane < LANES; ++lane)
      if (lanes[lane]) list[next++] = first + lane;
  }
}
