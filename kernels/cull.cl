// Light lists: for every tile the lights that may light a point it shows, ascending by index, and beside each light which of the
// tile's squares it may light. A list may be of any length, so the lists are counted before they are written:
//
//   count_lights → scan_lists → fill_lists
//
// In: position and normal planes of a G-buffer (view space, metres), lights, and a tree over them.
// Out: `list_starts`, a uint for each tile and one more, and `list`, 8 bytes an entry.
//
//   list_starts  0 3 3 7 …          a tile's entries in `list` are [list_starts[i], list_starts[i + 1])
//   list         4 9 12 | | 0 …     light, squares
//
// A work-item of count_lights and fill_lists takes a tile, scan_lists is one work-item. A tile costs reading its positions and
// normals twice (24 bytes a pixel), the rows of kTreeArity nodes on the way to the lights in reach, and a test of its squares for
// each such light. fill_lists pays that again only for lists of more than kFoundPerTile entries.
//
// Lights are found through their tree (light_tree.clh).
#include "lanes.clh"
#include "light_tree.clh"
#include "math.clh"
#include "shared.h"

// Bounds of the points that the squares of a tile show, in view space, a lane for each square. Background does not count.
// Squares may share their bounds, 1 << group_log2 pixels each time; then there are fewer, in the first lanes. Lanes without bounds,
// and those of squares that show only background, have low > high.
typedef struct {
  vec3L low, high;                // corners of the box around the points
  vec3L normal_low, normal_high;  // likewise of the normals
  floatL plane;                   // the least of normal · (point − middle of the box)
} Bounds;
#define BOUNDS (kSquaresPerTile / LANES)

// Sets lane i, counted through all of `bounds`, to the bounds of 1 << group_log2 pixels. position, normal: of the first of them.
INLINE void bound_pixels(__global const float *position, __global const float *normal, uint plane_stride, uint group_log2,
                         Bounds *bounds, uint i) {
  floatL inf = INFINITY;
  vec3L low = {inf, inf, inf}, high = {-inf, -inf, -inf}, normal_low = low, normal_high = high;
  for (uint pixel = 0; pixel < 1u << group_log2; pixel += LANES) {
    vec3L p = load_vec3(position + pixel, plane_stride), n = load_vec3(normal + pixel, plane_stride);
    intL covered = p.z > -INFINITY;
    grow_boxes(&low, &high, p, covered);
    grow_boxes(&normal_low, &normal_high, n, covered);
  }
  float4 l = {least_lane(low.x), least_lane(low.y), least_lane(low.z), 0.0f};
  float4 h = {greatest_lane(high.x), greatest_lane(high.y), greatest_lane(high.z), 0.0f};
  float4 middle = 0.5f * l + 0.5f * h;
  floatL plane = inf;
  for (uint pixel = 0; pixel < 1u << group_log2; pixel += LANES) {
    vec3L p = load_vec3(position + pixel, plane_stride), n = load_vec3(normal + pixel, plane_stride);
    floatL along = dot3(n, (vec3L){p.x - middle.x, p.y - middle.y, p.z - middle.z});
    plane = min_lanes(plane, p.z > -INFINITY ? along : inf);
  }
  float *out = (float *)(bounds + i / LANES) + i % LANES;
  out[0 * LANES] = l.x;
  out[1 * LANES] = l.y;
  out[2 * LANES] = l.z;
  out[3 * LANES] = h.x;
  out[4 * LANES] = h.y;
  out[5 * LANES] = h.z;
  out[6 * LANES] = least_lane(normal_low.x);
  out[7 * LANES] = least_lane(normal_low.y);
  out[8 * LANES] = least_lane(normal_low.z);
  out[9 * LANES] = greatest_lane(normal_high.x);
  out[10 * LANES] = greatest_lane(normal_high.y);
  out[11 * LANES] = greatest_lane(normal_high.z);
  out[12 * LANES] = least_lane(plane);
}

// A way through the tree to all lights that reach a box, in the order of light indices.
typedef struct {
  LightTree tree;
  float4 low, high;  // the box
  uint rows[8];      // which row of its level is looked at,
  uint bits[8];      // and which of its nodes are still to do
  uint level;
} Walk;

INLINE void enter_row(Walk *walk, uint level, uint row) {
  walk->level = level;
  walk->rows[level] = row;
  walk->bits[level] = nodes_in_reach(&walk->tree, level, row, walk->low, walk->high);
}

// The next light, ascending by index, or kNoLight after the last.
#define kNoLight 0xffffffffu
INLINE uint next_light(Walk *walk) {
  for (;;) {
    uint level = walk->level;
    uint bits = walk->bits[level];
    if (bits == 0) {
      if (level == walk->tree.top) return kNoLight;
      walk->level = level + 1;
      continue;
    }
    walk->bits[level] = bits & (bits - 1);
    uint node = walk->rows[level] * kTreeArity + lowest_bit(bits);
    if (level == 0) return node;
    enter_row(walk, level - 1, node);
  }
}

// Bound of the rounding errors that the tests below allow for, relative to the lengths that they start from: about a dozen roundings
// of 2^-24 in the test, and as many in shading.
#define SLACK 4e-6f

// Mask: whether any point of a box may face the light. With m the box's middle, normal · (light − point) is at most
// the greatest normal · (light − m) less the least normal · (point − m), which is `plane`. to_light: from m, or towards a
// directional light.
INLINE intL may_face(vec3L to_light, vec3L extent, vec3L normal_low, vec3L normal_high, floatL plane) {
  floatL most = max_lanes(to_light.x * normal_low.x, to_light.x * normal_high.x) +
                max_lanes(to_light.y * normal_low.y, to_light.y * normal_high.y) +
                max_lanes(to_light.z * normal_low.z, to_light.z * normal_high.z);
  floatL sizes = max_lanes(to_light.x, -to_light.x) + max_lanes(to_light.y, -to_light.y) +
                 max_lanes(to_light.z, -to_light.z) + extent.x + extent.y + extent.z;
  return !(most - plane <= -SLACK * sizes);
}

// Mask: which of LANES squares a light may light. tests: kByRange …
INLINE intL squares_lit(const Bounds *bounds, __global const ShadeLight *light, uint tests) {
  vec3L low = bounds->low, high = bounds->high;
  intL lit = low.x <= high.x;
  vec3L to_light = {(floatL)(light->position.x), (floatL)(light->position.y), (floatL)(light->position.z)};
  vec3L extent = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
  if (light->kind != kDirectionalLight) {
    lit &= !(ratio_between(to_light, to_light, low, high, (floatL)(light->position.w)) >= 1.0f);
    vec3L middle;
    find_middle(low, high, &middle, &extent);
    to_light.x -= middle.x;
    to_light.y -= middle.y;
    to_light.z -= middle.z;
  }
  if ((tests & kByCone) && light->kind == kSpotLight) lit &= may_touch_cone(to_light, extent, light);
  if (tests & kByFacing) {
    floatL plane = light->kind == kDirectionalLight ? (floatL)(0.0f) : bounds->plane;
    lit &= may_face(to_light, extent, bounds->normal_low, bounds->normal_high, plane);
  }
  return lit;
}

// Starts a walk to the lights that reach what a tile shows.
INLINE void start_tile(Walk *walk, const Bounds *bounds, __global const float *tree, uint tree_stride, uint light_count) {
  vec3L low = bounds->low, high = bounds->high;
  for (uint i = 1; i < BOUNDS; ++i) {
    low.x = min_lanes(low.x, bounds[i].low.x);
    low.y = min_lanes(low.y, bounds[i].low.y);
    low.z = min_lanes(low.z, bounds[i].low.z);
    high.x = max_lanes(high.x, bounds[i].high.x);
    high.y = max_lanes(high.y, bounds[i].high.y);
    high.z = max_lanes(high.z, bounds[i].high.z);
  }
  walk->tree.nodes = tree;
  walk->tree.stride = tree_stride;
  find_levels(&walk->tree, light_count);
  walk->low = (float4)(least_lane(low.x), least_lane(low.y), least_lane(low.z), 0.0f);
  walk->high = (float4)(greatest_lane(high.x), greatest_lane(high.y), greatest_lane(high.z), 0.0f);
  walk->level = walk->tree.top;
  walk->bits[walk->level] = 0;
  if (light_count > 0 && walk->low.x <= walk->high.x) enter_row(walk, walk->level, 0);
}

// Squares in 1 << group_log2 pixels.
#define SQUARES_IN(group_log2) ((1u << (group_log2)) * kSquaresPerTile / kTilePixels)

// How many lights a tile's list holds. The first `room` of them are written to `list`. group_log2: 4, 6 or 8, for bounds of 1, 4 or
// 16 squares. tests: kByRange …
INLINE uint find_lights(__global const float *position, __global const float *normal, uint plane_stride, uint group_log2,
                        __global const float *tree, uint tree_stride, __global const ShadeLight *lights, uint light_count,
                        uint tests, uint tile, __global ListEntry *list, uint room) {
  floatL inf = INFINITY;
  Bounds nothing = {{inf, inf, inf}, {-inf, -inf, -inf}, {inf, inf, inf}, {-inf, -inf, -inf}, inf};
  Bounds bounds[BOUNDS];
  for (uint i = 0; i < BOUNDS; ++i) bounds[i] = nothing;
  for (uint i = 0; i < kTilePixels >> group_log2; ++i) {
    uint first = tile * kTilePixels + (i << group_log2);
    bound_pixels(position + first, normal + first, plane_stride, group_log2, bounds, i);
  }
  // Bits of the squares that share the first bounds.
  uint group = 0xffffu >> (kSquaresPerTile - SQUARES_IN(group_log2));
  Walk walk;
  start_tile(&walk, bounds, tree, tree_stride, light_count);
  uint count = 0;
  for (uint light = next_light(&walk); light != kNoLight; light = next_light(&walk)) {
    uint bits = 0;
    for (uint i = 0; i < BOUNDS; ++i) bits |= lane_bits(squares_lit(bounds + i, lights + light, tests)) << i * LANES;
    // Written even if it lights no square: the next light then overwrites it. That saves a branch that no processor can predict.
    if (count < room) {
      uint squares = bits;
      if (group_log2 != 4) {
        squares = 0;
        for (uint i = 0; i < kTilePixels >> group_log2; ++i) squares |= (bits >> i & 1) * group << i * SQUARES_IN(group_log2);
      }
      list[count].light = light;
      list[count].squares = squares;
    }
    count += bits ? 1 : 0;
  }
  return count;
}

// How many lights the list of each tile holds, and in `found`, kFoundPerTile entries for each tile, the first of them.
__kernel void count_lights(__global const float *position, __global const float *normal, uint plane_stride, uint group_log2,
                           __global const float *tree, uint tree_stride, __global const ShadeLight *lights, uint light_count,
                           uint tests, __global ListEntry *found, __global uint *counts) {
  uint tile = get_global_id(0);
  counts[tile] = find_lights(position, normal, plane_stride, group_log2, tree, tree_stride, lights, light_count, tests, tile,
                             found + tile * kFoundPerTile, kFoundPerTile);
}

// Exclusive prefix sum in place, by one work-item. starts: tiles + 1; in: the counts; out: where each list starts, then the total.
// Sums saturate at 2³² − 1, a total that the host refuses.
__kernel void scan_lists(uint tiles, __global uint *starts) {
  ulong sum = 0;
  for (uint tile = 0; tile < tiles; ++tile) {
    uint count = starts[tile];
    starts[tile] = (uint)min(sum, (ulong)0xffffffffu);
    sum += count;
  }
  starts[tiles] = (uint)min(sum, (ulong)0xffffffffu);
}

// Writes the lists: copied from `found` where that holds all of a list, otherwise found again.
__kernel void fill_lists(__global const float *position, __global const float *normal, uint plane_stride, uint group_log2,
                         __global const float *tree, uint tree_stride, __global const ShadeLight *lights, uint light_count,
                         uint tests, __global const ListEntry *found, __global const uint *list_starts,
                         __global ListEntry *all_lists) {
  uint tile = get_global_id(0);
  __global ListEntry *list = all_lists + list_starts[tile];
  uint count = list_starts[tile + 1] - list_starts[tile];
  if (count <= kFoundPerTile) {
    for (uint i = 0; i < count; ++i) list[i] = found[tile * kFoundPerTile + i];
    return;
  }
  uint again =
      find_lights(position, normal, plane_stride, group_log2, tree, tree_stride, lights, light_count, tests, tile, list, count);
  // Both passes find the same lights. Should a compiler ever round them differently, the rest are entries without squares.
  for (ListEntry none = {0, 0}; again < count; ++again) list[again] = none;
}
