// Light lists: for every square of pixels that shares a list (see LIST_OF_PIXEL) the lights that may light a point it shows, in
// the order of light indices, as long as they come. Two passes: count, scan, fill.
//
//   count_lights → scan_lists → fill_lists
//
//   list_starts  0 3 3 7 …          a list's entries in `list` are [list_starts[i], list_starts[i + 1])
//   list         4 9 12 | | 0 …     an entry indexes the lights
//
// Lights are found through a tree. They lie sorted in space, so that kTreeArity in a row are near each other and make a node,
// and as many nodes in a row a node of the level above, up to a level of kTreeArity nodes or fewer:
//
//   level 2   ┌────────────── 0 ──────────────┬────── 1 ── …        `tree`, 7 planes: the box around a node's lights (x y z of
//   level 1   ┌──── 0 ────┬──── 1 ────┬─ … ───┤                     its low corner, then of its high one) and their least
//   lights    0 1 2 … 15  16 17 … 31  32 …                          1 / range². Each level is padded to a multiple of
//                                                                   kTreeArity; level 0, the lights themselves, comes first.
#include "falloff.clh"
#include "lanes.clh"
#include "math.clh"
#include "shared.h"

// What the pixels of a list show, in view space, kListsPerTile floats each for the lists of a tile. Background does not count; a list
// that shows nothing has low > high.
enum {
  kLow = 0,         // corner of the box around the points
  kHigh = 3,        // the other
  kNormalLow = 6,   // likewise of the normals
  kNormalHigh = 9,
  kPlane = 12       // the least of normal · (point − middle of the box); kBoundPlanes in all
};

INLINE float least_lane(floatL v) {
#if LANES == 1
  return v;
#else
#if LANES == 16
  float8 half8 = v.lo < v.hi ? v.lo : v.hi;
#elif LANES == 8
  float8 half8 = v;
#endif
#if LANES >= 8
  float4 half4 = half8.lo < half8.hi ? half8.lo : half8.hi;
#else
  float4 half4 = v;
#endif
  float2 half2 = half4.lo < half4.hi ? half4.lo : half4.hi;
  return half2.x < half2.y ? half2.x : half2.y;
#endif
}
INLINE float most_lane(floatL v) { return -least_lane(-v); }

// Makes the boxes from low to high, one a lane, hold the points in the mask.
INLINE void grow_boxes(vec3L *low, vec3L *high, vec3L p, intL mask) {
  floatL inf = INFINITY;
  low->x = min_lanes(low->x, mask ? p.x : inf);
  low->y = min_lanes(low->y, mask ? p.y : inf);
  low->z = min_lanes(low->z, mask ? p.z : inf);
  high->x = max_lanes(high->x, mask ? p.x : -inf);
  high->y = max_lanes(high->y, mask ? p.y : -inf);
  high->z = max_lanes(high->z, mask ? p.z : -inf);
}

// Writes the bounds of a tile's list. position, normal: the tile's.
INLINE void bound_list(__global const float *position, __global const float *normal, uint plane_stride, uint list,
                       uint list_shift, __global float *bounds) {
  floatL inf = INFINITY;
  vec3L low = {inf, inf, inf}, high = {-inf, -inf, -inf}, normal_low = low, normal_high = high;
  uint first = list << list_shift;
  uint end = first < kTilePixels ? first + (1u << list_shift) : first;  // larger lists leave no pixels for the last ones
  for (uint pixel = first; pixel < end; pixel += LANES) {
    vec3L p = load_vec3(position + pixel, plane_stride), n = load_vec3(normal + pixel, plane_stride);
    intL covered = p.z > -INFINITY;
    grow_boxes(&low, &high, p, covered);
    grow_boxes(&normal_low, &normal_high, n, covered);
  }
  __global float *out = bounds + list;
  float4 l = {least_lane(low.x), least_lane(low.y), least_lane(low.z), 0.0f};
  float4 h = {most_lane(high.x), most_lane(high.y), most_lane(high.z), 0.0f};
  float4 middle = 0.5f * l + 0.5f * h;
  floatL plane = inf;
  for (uint pixel = first; pixel < end; pixel += LANES) {
    vec3L p = load_vec3(position + pixel, plane_stride), n = load_vec3(normal + pixel, plane_stride);
    floatL along = n.x * (p.x - middle.x) + n.y * (p.y - middle.y) + n.z * (p.z - middle.z);
    plane = min_lanes(plane, p.z > -INFINITY ? along : inf);
  }
  out[(kLow + 0) * kListsPerTile] = l.x;
  out[(kLow + 1) * kListsPerTile] = l.y;
  out[(kLow + 2) * kListsPerTile] = l.z;
  out[(kHigh + 0) * kListsPerTile] = h.x;
  out[(kHigh + 1) * kListsPerTile] = h.y;
  out[(kHigh + 2) * kListsPerTile] = h.z;
  out[(kNormalLow + 0) * kListsPerTile] = least_lane(normal_low.x);
  out[(kNormalLow + 1) * kListsPerTile] = least_lane(normal_low.y);
  out[(kNormalLow + 2) * kListsPerTile] = least_lane(normal_low.z);
  out[(kNormalHigh + 0) * kListsPerTile] = most_lane(normal_high.x);
  out[(kNormalHigh + 1) * kListsPerTile] = most_lane(normal_high.y);
  out[(kNormalHigh + 2) * kListsPerTile] = most_lane(normal_high.z);
  out[kPlane * kListsPerTile] = least_lane(plane);
}

// Bit i: lane i of the mask.
INLINE uint lane_bits(intL mask) {
#if LANES == 1
  return mask ? 1u : 0u;
#else
#if LANES == 16
  int16 bits = mask & (int16)(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768);
  int8 half8 = bits.lo | bits.hi;
#elif LANES == 8
  int8 half8 = mask & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
#endif
#if LANES >= 8
  int4 half4 = half8.lo | half8.hi;
#else
  int4 half4 = mask & (int4)(1, 2, 4, 8);
#endif
  int2 half2 = half4.lo | half4.hi;
  return (uint)(half2.x | half2.y);
#endif
}

INLINE uint lowest_bit(uint bits) { return 31 - clz(bits & (0 - bits)); }

// Distance from an interval to an interval along an axis.
INLINE floatL gap(floatL low, floatL high, floatL other_low, floatL other_high) {
  return max_lanes(max_lanes(low - other_high, other_low - high), (floatL)(0.0f));
}

// Squared distance between boxes as a share of range². Computed with shading's own operations (falloff.clh), each of which
// rounds monotonically, so it never exceeds what shading computes for a light in one box and a point in the other.
INLINE floatL ratio_between(vec3L low, vec3L high, vec3L other_low, vec3L other_high, floatL inverse_range2) {
  floatL dx = gap(low.x, high.x, other_low.x, other_high.x);
  floatL dy = gap(low.y, high.y, other_low.y, other_high.y);
  floatL dz = gap(low.z, high.z, other_low.z, other_high.z);
  return SQUARED_LENGTH(dx, dy, dz) * inverse_range2;
}

// Which of a row of kTreeArity nodes reach a box, by bits.
INLINE uint nodes_in_reach(__global const float *tree, uint stride, float4 low, float4 high) {
  vec3L l = {(floatL)(low.x), (floatL)(low.y), (floatL)(low.z)}, h = {(floatL)(high.x), (floatL)(high.y), (floatL)(high.z)};
  uint bits = 0;
  for (uint node = 0; node < kTreeArity; node += LANES) {
    vec3L node_low = load_vec3(tree + node, stride), node_high = load_vec3(tree + node + 3 * stride, stride);
    // NaN (infinitely far × reaches everywhere) stays in.
    intL reached = !(ratio_between(node_low, node_high, l, h, load_lanes(tree + node + 6 * stride)) >= 1.0f);
    bits |= lane_bits(reached) << node;
  }
  return bits;
}

// A way through the tree to all lights that reach a box, in the order of light indices.
typedef struct {
  __global const float *tree;
  uint stride;
  float4 low, high;      // the box
  uint level_starts[8];  // 16⁸ lights are more than an index can tell apart
  uint level_nodes[8];
  uint rows[8];          // which row of its level is looked at,
  uint bits[8];          // and which of its nodes are still to do
  uint level, top;
} Walk;

INLINE void enter_row(Walk *walk, uint level, uint row) {
  walk->level = level;
  walk->rows[level] = row;
  uint bits = nodes_in_reach(walk->tree + walk->level_starts[level] + row * kTreeArity, walk->stride, walk->low, walk->high);
  // No padding, which a box without end reaches.
  uint nodes = walk->level_nodes[level] - row * kTreeArity;
  walk->bits[level] = nodes < kTreeArity ? bits & ((1u << nodes) - 1) : bits;
}

INLINE void start_walk(Walk *walk, uint light_count) {
  uint start = 0, nodes = light_count;
  for (walk->top = 0;; ++walk->top) {
    uint rows = (nodes + kTreeArity - 1) / kTreeArity;
    walk->level_starts[walk->top] = start;
    walk->level_nodes[walk->top] = nodes;
    if (rows <= 1) break;
    start += rows * kTreeArity;
    nodes = rows;
  }
  walk->level = walk->top;
  walk->bits[walk->top] = 0;
  if (light_count > 0 && walk->low.x <= walk->high.x) enter_row(walk, walk->top, 0);
}

// The next light, or kNoLight.
#define kNoLight 0xffffffffu
INLINE uint next_light(Walk *walk) {
  for (;;) {
    uint level = walk->level;
    uint bits = walk->bits[level];
    if (bits == 0) {
      if (level == walk->top) return kNoLight;
      walk->level = level + 1;
      continue;
    }
    walk->bits[level] = bits & (bits - 1);
    uint node = walk->rows[level] * kTreeArity + lowest_bit(bits);
    if (level == 0) return node;
    enter_row(walk, level - 1, node);
  }
}

// Roundings that the tests below allow for, in terms of lengths: they compute with 2^-24 of the coordinates that they start from,
// a dozen times, and so does shading.
#define SLACK 4e-6f

// Whether any of the points may face the light: an upper bound of normal · (light − point), with m the box's middle, is that of
// normal · (light − m) less the least of normal · (point − m).
INLINE intL may_face(vec3L to_light, vec3L extent, vec3L normal_low, vec3L normal_high, floatL plane) {
  floatL most = max_lanes(to_light.x * normal_low.x, to_light.x * normal_high.x) +
                max_lanes(to_light.y * normal_low.y, to_light.y * normal_high.y) +
                max_lanes(to_light.z * normal_low.z, to_light.z * normal_high.z);
  floatL sizes = max_lanes(to_light.x, -to_light.x) + max_lanes(to_light.y, -to_light.y) +
                 max_lanes(to_light.z, -to_light.z) + extent.x + extent.y + extent.z;
  return !(most - plane <= -SLACK * sizes);
}

// Whether a spot's cone may touch the ball around a box: the distance from the ball's middle to the cone's side is
// √(v² − (v·axis)²) cos − (v·axis) sin, with v from the light to the middle (B. Wronski, "Cull that cone!", 2017).
INLINE intL may_touch_cone(vec3L to_light, vec3L extent, __global const ShadeLight *light) {
  float cosine = light->direction.w;
  // Wider than a half space: no such side.
  if (cosine <= 0.0f) return (intL)(1) != (intL)(0);
  float sine = sqrt(1.0f - cosine * cosine);
  floatL v2 = dot3(to_light, to_light), extent2 = dot3(extent, extent);
  floatL along = -dot3s(to_light, light->direction);
  floatL across2 = max_lanes(v2 - along * along, (floatL)(0.0f));
  floatL away = across2 * rsqrt_lanes(across2) * cosine - along * sine;
  floatL radius = extent2 * rsqrt_lanes(extent2);
  // The root takes a rounding of v² of 2^-24 to one of |v| of 2^-12.
  return !(away > radius + 1e-3f * v2 * rsqrt_lanes(v2));
}

// Which of LANES lists of a tile, from `first` on, a light may light: a mask.
INLINE intL lists_lit(__global const float *bounds, uint first, __global const ShadeLight *light, uint tests) {
  __global const float *at = bounds + first;
  vec3L low = load_vec3(at + kLow * kListsPerTile, kListsPerTile), high = load_vec3(at + kHigh * kListsPerTile, kListsPerTile);
  intL lit = low.x <= high.x;
  vec3L to_light = {(floatL)(light->position.x), (floatL)(light->position.y), (floatL)(light->position.z)};
  vec3L extent = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
  if (light->kind != kDirectionalLight) {
    lit &= !(ratio_between(to_light, to_light, low, high, (floatL)(light->position.w)) >= 1.0f);
    vec3L middle = {0.5f * low.x + 0.5f * high.x, 0.5f * low.y + 0.5f * high.y, 0.5f * low.z + 0.5f * high.z};
    to_light.x -= middle.x;
    to_light.y -= middle.y;
    to_light.z -= middle.z;
    // The middle rounds, to an end where the box is that small: its farther side counts.
    extent.x = max_lanes(high.x - middle.x, middle.x - low.x);
    extent.y = max_lanes(high.y - middle.y, middle.y - low.y);
    extent.z = max_lanes(high.z - middle.z, middle.z - low.z);
  }
  if ((tests & kByCone) && light->kind == kSpotLight) lit &= may_touch_cone(to_light, extent, light);
  if (tests & kByFacing) {
    floatL plane = light->kind == kDirectionalLight ? (floatL)(0.0f) : load_lanes(at + kPlane * kListsPerTile);
    lit &= may_face(to_light, extent, load_vec3(at + kNormalLow * kListsPerTile, kListsPerTile),
                    load_vec3(at + kNormalHigh * kListsPerTile, kListsPerTile), plane);
  }
  return lit;
}

// Starts a walk to the lights that reach what a tile's lists show.
INLINE void start_tile(Walk *walk, __global const float *bounds, __global const float *tree, uint tree_stride,
                       uint light_count) {
  vec3L low = load_vec3(bounds, kListsPerTile), high = load_vec3(bounds + kHigh * kListsPerTile, kListsPerTile);
  for (uint list = LANES; list < kListsPerTile; list += LANES) {
    vec3L l = load_vec3(bounds + list, kListsPerTile), h = load_vec3(bounds + list + kHigh * kListsPerTile, kListsPerTile);
    low.x = min_lanes(low.x, l.x);
    low.y = min_lanes(low.y, l.y);
    low.z = min_lanes(low.z, l.z);
    high.x = max_lanes(high.x, h.x);
    high.y = max_lanes(high.y, h.y);
    high.z = max_lanes(high.z, h.z);
  }
  walk->tree = tree;
  walk->stride = tree_stride;
  walk->low = (float4)(least_lane(low.x), least_lane(low.y), least_lane(low.z), 0.0f);
  walk->high = (float4)(most_lane(high.x), most_lane(high.y), most_lane(high.z), 0.0f);
  start_walk(walk, light_count);
}

// How many lights each list of a tile will hold, and its bounds, kBoundPlanes · kListsPerTile floats. tests: kByRange …
__kernel void count_lights(__global const float *position, __global const float *normal, uint plane_stride, uint list_shift,
                           __global const float *tree, uint tree_stride, __global const ShadeLight *lights, uint light_count,
                           uint tests, __global float *all_bounds, __global uint *counts) {
  uint tile = get_global_id(0), place = tile * kTilePixels;
  __global float *bounds = all_bounds + tile * (kBoundPlanes * kListsPerTile);
  for (uint list = 0; list < kListsPerTile; ++list)
    bound_list(position + place, normal + place, plane_stride, list, list_shift, bounds);
  Walk walk;
  start_tile(&walk, bounds, tree, tree_stride, light_count);
  intL found[kListsPerTile / LANES];
  for (uint row = 0; row < kListsPerTile / LANES; ++row) found[row] = 0;
  for (uint light = next_light(&walk); light != kNoLight; light = next_light(&walk))
    for (uint row = 0; row < kListsPerTile / LANES; ++row)
      found[row] += lists_lit(bounds, row * LANES, lights + light, tests) ? (intL)(1) : (intL)(0);
  const int *lanes = (const int *)found;
  for (uint list = 0; list < kListsPerTile; ++list) counts[tile * kListsPerTile + list] = (uint)lanes[list];
}

// Exclusive prefix sum of the counts in place, by one work-item; starts[lists] becomes the total.
// The total saturates at 2³² − 1, which the host refuses.
__kernel void scan_lists(uint lists, __global uint *starts) {
  ulong sum = 0;
  for (uint list = 0; list < lists; ++list) {
    uint count = starts[list];
    starts[list] = (uint)min(sum, (ulong)0xffffffffu);
    sum += count;
  }
  starts[lists] = (uint)min(sum, (ulong)0xffffffffu);
}

// Lights that fill_lists takes on at once.
#define FILL_BATCH 128

// Writes the lists. For a batch of lights it first keeps which lists each belongs to, a bit a list, and then goes through the
// batch list by list: without a branch that nothing can predict.
__kernel void fill_lists(__global const float *all_bounds, __global const float *tree, uint tree_stride,
                         __global const ShadeLight *lights, uint light_count, uint tests,
                         __global const uint *list_starts, __global uint *list) {
  uint tile = get_global_id(0), first = tile * kListsPerTile;
  if (list_starts[first] == list_starts[first + kListsPerTile]) return;
  __global const float *bounds = all_bounds + tile * (kBoundPlanes * kListsPerTile);
  Walk walk;
  start_tile(&walk, bounds, tree, tree_stride, light_count);
  uint next[kListsPerTile];
  for (uint i = 0; i < kListsPerTile; ++i) next[i] = list_starts[first + i];
  uint batch[FILL_BATCH], members[FILL_BATCH], chosen[FILL_BATCH];
  for (uint light = 0; light != kNoLight;) {
    uint size = 0, all = 0;
    while (size < FILL_BATCH && (light = next_light(&walk)) != kNoLight) {
      uint bits = 0;
      for (uint row = 0; row < kListsPerTile; row += LANES)
        bits |= lane_bits(lists_lit(bounds, row, lights + light, tests)) << row;
      batch[size] = light;
      members[size++] = bits;
      all |= bits;
    }
    for (uint i = 0; i < kListsPerTile; ++i) {
      if (!(all >> i & 1)) continue;
      uint count = 0;
      for (uint b = 0; b < size; ++b) {
        chosen[count] = batch[b];
        count += members[b] >> i & 1;
      }
      // Both passes find the same lights; were a compiler ever to round them apart, this keeps the lists in their places.
      count = min(count, list_starts[first + i + 1] - next[i]);
      for (uint c = 0; c < count; ++c) list[next[i] + c] = chosen[c];
      next[i] += count;
    }
  }
}
