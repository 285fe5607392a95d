// Culling and shading in one, for pictures of which nobody else reads the light lists. The same bits as cull.cl and shade.cl give.
//
// In: the planes of a G-buffer, lights, and the tree over them. Out: 3 planes of linear colour, and two counts for each tile.
//
// A work-item takes a block of tiles, 64×64 pixels of a picture:
//
//   boxes around what groups of 8×8 pixels show, a lane each
//   └─ one walk through the tree for all groups: up to kCandidates lights, with a bit for each group in reach
//      └─ for each tile, group and row of LANES pixels: the lights of the group that add anything to the row, by an exact test
//         └─ the row, its sums in registers, lit by these
//
// A node of the tree is dropped where it reaches no group, also if it lies between some of them: in front of a far surface and behind
// a near one. Blocks in which more than kCandidates lights reach something are taken tile by tile, with groups of 4×4 pixels, and as
// many walks' rests as it takes. The sums of a tile's rows are kept meanwhile. So there is no cap.
// Cost: reading positions twice and all else once, some 20 instructions for a row and a light in reach of its group, and 130 for those
// that light the row.
#include "lanes.clh"
#include "light_tree.clh"
#include "shading.clh"
#include "shared.h"

// How many lights are found before rows are lit by them.
enum { kCandidates = 256 };

// Read LANES elements at a time.
#define ALIGNED __attribute__((aligned(64)))

// Groups of pixels, as bits of a mask: those of the first tile come first.
#define GROUPS 64
#define BOXES (GROUPS / LANES)

// Boxes around what groups show, in view space, one a lane. low > high: nothing.
typedef struct {
  vec3L low, high;
} Boxes;

// A way through the tree to all lights that reach some groups, in the order of light indices.
typedef struct {
  LightTree tree;
  Boxes boxes[BOXES];
  uint box_count;    // of `boxes` that are in use
  float4 low, high;  // the box around all
  uint rows[8];      // which row of its level is looked at,
  uint bits[8];      // which of its nodes are still to do,
  ulong groups[8];   // and which groups the node above the row reaches
  uint level;
} Walk;

INLINE void enter_row(Walk *walk, uint level, uint row, ulong groups) {
  walk->level = level;
  walk->rows[level] = row;
  walk->groups[level] = groups;
  walk->bits[level] = nodes_in_reach(&walk->tree, level, row, walk->low, walk->high);
}

// Sets the box of a group, 1 << group_log2 pixels. position: of the first of them.
INLINE void bound_group(__global const float *position, uint plane_stride, uint group_log2, Boxes *boxes, uint group) {
  floatL inf = INFINITY;
  vec3L low = {inf, inf, inf}, high = {-inf, -inf, -inf};
  for (uint pixel = 0; pixel < 1u << group_log2; pixel += LANES) {
    vec3L p = load_vec3(position + pixel, plane_stride);
    grow_boxes(&low, &high, p, p.z > -INFINITY);
  }
  float *out = (float *)(boxes + group / LANES) + group % LANES;
  out[0 * LANES] = least_lane(low.x);
  out[1 * LANES] = least_lane(low.y);
  out[2 * LANES] = least_lane(low.z);
  out[3 * LANES] = greatest_lane(high.x);
  out[4 * LANES] = greatest_lane(high.y);
  out[5 * LANES] = greatest_lane(high.z);
}

// Starts a walk to the lights that reach any group of some tiles. first_pixel: of each tile.
INLINE void start_walk(Walk *walk, __global const float *position, uint plane_stride, const uint *first_pixel, uint tiles,
                       uint group_log2, uint light_count) {
  floatL inf = INFINITY;
  vec3L low = {inf, inf, inf}, high = {-inf, -inf, -inf};
  Boxes nothing = {low, high};
  uint groups_per_tile = kTilePixels >> group_log2;
  walk->box_count = (tiles * groups_per_tile + LANES - 1) / LANES;
  walk->boxes[walk->box_count - 1] = nothing;
  for (uint tile = 0; tile < tiles; ++tile)
    for (uint i = 0; i < groups_per_tile; ++i)
      bound_group(position + first_pixel[tile] + (i << group_log2), plane_stride, group_log2, walk->boxes,
                  tile * groups_per_tile + i);
  ulong showing = 0;  // groups that show anything
  for (uint i = 0; i < walk->box_count; ++i) {
    const Boxes *boxes = walk->boxes + i;
    intL covered = boxes->low.x <= boxes->high.x;
    showing |= (ulong)lane_bits(covered) << i * LANES;
    grow_boxes(&low, &high, boxes->low, covered);
    grow_boxes(&low, &high, boxes->high, covered);
  }
  walk->low = (float4)(least_lane(low.x), least_lane(low.y), least_lane(low.z), 0.0f);
  walk->high = (float4)(greatest_lane(high.x), greatest_lane(high.y), greatest_lane(high.z), 0.0f);
  walk->level = walk->tree.top;
  walk->bits[walk->level] = 0;
  if (light_count > 0 && showing) enter_row(walk, walk->level, 0, showing);
}

// Those of some groups that a node of the tree reaches. node: its place in the planes.
INLINE ulong groups_in_reach(const Walk *walk, uint node, ulong groups) {
  __global const float *values = walk->tree.nodes + node;
  uint stride = walk->tree.stride;
  vec3L low = {(floatL)(values[0]), (floatL)(values[stride]), (floatL)(values[2 * stride])};
  vec3L high = {(floatL)(values[3 * stride]), (floatL)(values[4 * stride]), (floatL)(values[5 * stride])};
  floatL inverse_range2 = values[6 * stride];
  ulong reached = 0;
  for (uint i = 0; i < walk->box_count; ++i) {
    const Boxes *boxes = walk->boxes + i;
    // As in nodes_in_reach(), what isn't a number counts as reached.
    intL in_reach = !(ratio_between(low, high, boxes->low, boxes->high, inverse_range2) >= 1.0f);
    reached |= (ulong)lane_bits(in_reach) << i * LANES;
  }
  return reached & groups;
}

// Those of some groups that a spot's cone may touch.
INLINE ulong groups_in_cone(const Walk *walk, __global const ShadeLight *light, ulong groups) {
  ulong touched = 0;
  for (uint i = 0; i < walk->box_count; ++i) {
    vec3L middle, extent;
    find_middle(walk->boxes[i].low, walk->boxes[i].high, &middle, &extent);
    vec3L to_light = {light->position.x - middle.x, light->position.y - middle.y, light->position.z - middle.z};
    touched |= (ulong)lane_bits(may_touch_cone(to_light, extent, light)) << i * LANES;
  }
  return touched & groups;
}

// Lights that reach some group, in the order of their indices, with what rows are tested by: a value for each light in each array.
typedef struct {
  uint count;
  uint light[kCandidates];      // its index
  uint groups[GROUPS / 32][kCandidates] ALIGNED;  // bit i of word j: the light reaches group 32·j + i
  float x[kCandidates], y[kCandidates], z[kCandidates], inverse_range2[kCandidates];  // ShadeLight.position
  float placed[kCandidates];                                                          // 0 for directional lights, else 1
  // Of spots whose cutoff is below 90°: the axis, and the squared cosine of the cutoff. −1 for other lights.
  float axis_x[kCandidates], axis_y[kCandidates], axis_z[kCandidates], cosine2[kCandidates];
} Candidates;

// Whether a light is of a kind, and whether programs have to ask.
#define IS_DIRECTIONAL(light) IS(DIRECTIONAL_LIGHTS, PLACED_LIGHTS, (light)->kind == kDirectionalLight)
#define IS_SPOT(light) IS(SPOT_LIGHTS, POINT_LIGHTS || DIRECTIONAL_LIGHTS, (light)->kind == kSpotLight)

INLINE void set_candidate(Candidates *candidates, uint i, uint index, ulong groups, __global const ShadeLight *light) {
  candidates->light[i] = index;
  candidates->groups[0][i] = (uint)groups;
  candidates->groups[1][i] = (uint)(groups >> 32);
  candidates->x[i] = light->position.x;
  candidates->y[i] = light->position.y;
  candidates->z[i] = light->position.z;
  candidates->inverse_range2[i] = light->position.w;
  if (DIRECTIONAL_LIGHTS) candidates->placed[i] = IS_DIRECTIONAL(light) ? 0.0f : 1.0f;
  if (!SPOT_LIGHTS) return;
  float cosine = IS_SPOT(light) ? light->direction.w : -1.0f;
  candidates->axis_x[i] = light->direction.x;
  candidates->axis_y[i] = light->direction.y;
  candidates->axis_z[i] = light->direction.z;
  candidates->cosine2[i] = cosine > 0.0f ? cosine * cosine : -1.0f;
}

// Finds the next lights of a walk: kCandidates or, at its end, fewer.
INLINE void find_lights(Walk *walk, __global const ShadeLight *lights, Candidates *candidates) {
  uint count = 0;
  while (count < kCandidates) {
    uint level = walk->level, bits = walk->bits[level];
    if (bits == 0) {
      if (level == walk->tree.top) break;
      walk->level = level + 1;
      continue;
    }
    walk->bits[level] = bits & (bits - 1);
    uint node = walk->rows[level] * kTreeArity + lowest_bit(bits);
    ulong groups = groups_in_reach(walk, walk->tree.level_starts[level] + node, walk->groups[level]);
    if (groups && level > 0) enter_row(walk, level - 1, node, groups);
    if (groups == 0 || level > 0) continue;
    if (IS_SPOT(lights + node)) groups = groups_in_cone(walk, lights + node, groups);
    set_candidate(candidates, count, node, groups, lights + node);
    count += groups ? 1 : 0;
  }
  candidates->count = count;
  // They are looked at LANES at a time.
  for (uint i = count; i % LANES > 0; ++i) candidates->groups[0][i] = candidates->groups[1][i] = 0;
}

// Bit i: whether candidate first + i reaches any of the groups in `wanted`, of one word of Candidates.groups.
INLINE uint candidates_in_reach(const uint *groups, uint first, uint wanted) {
  intL reached = *(const intL *)(groups + first);
  return lane_bits((reached & (intL)((int)wanted)) != 0);
}

// Writes the numbers of those candidates that reach a group, and returns how many they are.
INLINE uint find_candidates(const Candidates *candidates, uint group, uint *found) {
  uint count = 0;
  for (uint i = 0; i < candidates->count; i += LANES)
    for (uint bits = candidates_in_reach(candidates->groups[group / 32], i, 1u << group % 32); bits; bits &= bits - 1)
      found[count++] = i + lowest_bit(bits);
  return count;
}

// Mask: whether shading adds anything for candidate i, or may: 0 only where the light's attenuation is 0, or without LIGHT_AMBIENT its
// strength. Distances and cosines are computed with shading's own operations, though from the light instead of to it, which changes
// only signs. Background is at z = −∞.
INLINE intL adds_light(vec3L position, vec3L normal, const Candidates *candidates, uint i) {
  vec3L way;
  if (DIRECTIONAL_LIGHTS) {
    floatL placed = candidates->placed[i];
    way.x = fma_lanes(placed, position.x, (floatL)(-candidates->x[i]));
    way.y = fma_lanes(placed, position.y, (floatL)(-candidates->y[i]));
    way.z = fma_lanes(placed, position.z, (floatL)(-candidates->z[i]));
  } else {
    way.x = position.x - candidates->x[i];
    way.y = position.y - candidates->y[i];
    way.z = position.z - candidates->z[i];
  }
  floatL d2 = SQUARED_LENGTH(way.x, way.y, way.z);
  // The window is above 0 just where this is below 1. A light that reaches everywhere has 0, or NaN from infinitely far.
  intL adds = !(d2 * candidates->inverse_range2[i] >= 1.0f);
  if (!LIGHT_AMBIENT) adds &= dot3(normal, way) < 0.0f;
  if (SPOT_LIGHTS) {
    // Inside a cutoff below 90° along / d is its cosine or more, but for 4 roundings of shading's. Squared and with those of this
    // test that is less than 16·2^-24. What underflows counts as inside.
    float4 axis = {candidates->axis_x[i], candidates->axis_y[i], candidates->axis_z[i], 0.0f};
    floatL along = max_lanes(dot3s(way, axis), (floatL)(0.0f));
    adds &= fma_lanes(along * (1.0f + 0x1p-20f), along, (floatL)(1e-37f)) >= d2 * candidates->cosine2[i];
  }
  return adds;
}

// What all rows of a work-item share.
typedef struct {
  const ShadeFrame *frame;
  const Planes *planes;
  __global const ShadeLight *lights;
  __global float *image;
  bool begun;  // the rows' sums were kept from earlier candidates
  bool last;   // no candidates follow
  uint rows;   // rows of the tile so far that met any candidate
  bool drops;  // the exact test left out an eighth of a row's candidates or more, where it was made last
} Task;

// Lights a row of pixels by those of `count` candidates that add anything to it, and returns their number. near: the candidates'
// numbers. kept: the row's sums between one set of candidates and the next.
INLINE uint shade_row(Task *task, uint first, const Candidates *candidates, const uint *near, uint count, LightSums *kept) {
  uint stride = task->frame->plane_stride;
  vec3L position = load_vec3(task->planes->position + first, stride);
  vec3L normal = load_vec3(task->planes->normal + first, stride);
  uint adding[kCandidates], lights = count;
  const uint *lit = near;
  // A light that is left in adds exactly zero. So the test is made of every fourth row, and of the others where it pays.
  if (count > 0 && (task->drops || task->rows++ % 4 == 0)) {
    lights = 0;
    for (uint i = 0; i < count; ++i) {
      adding[lights] = near[i];
      lights += any_lane(adds_light(position, normal, candidates, near[i])) ? 1 : 0;
    }
    lit = adding;
    task->drops = 8 * lights <= 7 * count;
  }
  // With fewer lights than that, one block takes them all.
  bool long_sums = LONG_SUMS && (task->begun || !task->last || lights > kSumBlock);
  Pixels row;
  start_row(&row, task->frame, first, task->planes, long_sums);
  if (LIT && task->begun) row.sums = *kept;
  Shadows none = {0, 0, 0, 0, 0};
  Pixels *rows[ABREAST];
  __global const ShadeLight *light[ABREAST];
  uint entry[ABREAST];
  EACH_ABREAST(k, ABREAST) {
    rows[k] = &row;
    entry[k] = 0;
  }
  uint i = 0;
  for (; i + ABREAST <= lights; i += ABREAST) {
    EACH_ABREAST(k, ABREAST) light[k] = task->lights + candidates->light[lit[i + k]];
    add_lights(ABREAST, rows, light, ABREAST, entry, &none, task->frame->model, long_sums);
  }
  if (ABREAST > 2 && i + 2 <= lights) {
    EACH_ABREAST(k, 2) light[k] = task->lights + candidates->light[lit[i + k]];
    add_lights(2, rows, light, 2, entry, &none, task->frame->model, long_sums);
    i += 2;
  }
  if (ABREAST > 1 && i < lights) {
    light[0] = task->lights + candidates->light[lit[i]];
    add_lights(1, rows, light, 1, entry, &none, task->frame->model, long_sums);
  }
  if (task->last) {
    finish_row(&row, task->frame, first, task->planes, long_sums, any_lane(row.covered), task->image);
  } else if (LIT) {
    *kept = row.sums;
  }
  return lights;
}

// Lights a tile. first, next: the first pixel of this tile and of one that is lit after it. group: the tile's first. kept: for each
// row of the tile. Adds to counts[0] the candidates in reach of any group, and to counts[1] the pairs of a row and a light that it
// lights.
INLINE void shade_tile(Task *task, uint first, uint next, uint group_log2, uint group, const Candidates *candidates,
                       LightSums *kept, __global uint *counts) {
  uint groups = kTilePixels >> group_log2, wanted = ((1u << groups) - 1) << group % 32;
  uint in_reach = 0, pairs = 0;
  task->rows = 0;
  task->drops = false;
  for (uint i = 0; i < candidates->count; i += LANES)
    in_reach += popcount(candidates_in_reach(candidates->groups[group / 32], i, wanted));
  for (uint end = group + groups; group < end; ++group) {
    uint near[kCandidates];
    uint count = find_candidates(candidates, group, near);
    for (uint i = 0; i < 1u << group_log2; i += LANES) {
      if (next != first) prefetch_rows(next, 1, task->frame->plane_stride, task->planes);
      pairs += shade_row(task, first, candidates, near, count, kept);
      first += LANES;
      next += LANES;
      ++kept;
    }
  }
  counts[0] = in_reach + (task->begun ? counts[0] : 0);
  counts[1] = pairs + (task->begun ? counts[1] : 0);
}

// Planes and image: see shade(). tiles_x, tiles_y: of the G-buffer; width, height: of a block, in tiles, kBlockTiles together or fewer.
// There is a work-item for each block; stride, which has no factor in common with their number, spreads those that follow each other
// over the picture, because a device may share them out in long runs. counts: two for each tile, see shade_tile().
__kernel void shade_tiles(ShadeFrame frame, __global const float *position, __global const float *normal,
                          __global const float *diffuse, __global const float *specular, __global const float *ambient,
                          __global const float *emission, __global const float *tree, uint tree_stride,
                          __global const ShadeLight *lights, uint tiles_x, uint tiles_y, uint width, uint height,
                          uint stride, __global float *image, __global uint *counts) {
  Planes planes = {position, normal, diffuse, specular, ambient, emission, 0, 0};
  uint blocks_x = (tiles_x + width - 1) / width, blocks_y = (tiles_y + height - 1) / height;
  uint block = (uint)((ulong)get_global_id(0) * stride % (blocks_x * blocks_y));
  uint block_x = block % blocks_x * width, block_y = block / blocks_x * height;
  uint columns = min(width, tiles_x - block_x), tiles = columns * min(height, tiles_y - block_y);
  uint first_pixel[kBlockTiles];
  for (uint tile = 0; tile < tiles; ++tile)
    first_pixel[tile] = ((block_y + tile / columns) * tiles_x + block_x + tile % columns) * kTilePixels;

  Walk walk;
  walk.tree.nodes = tree;
  walk.tree.stride = tree_stride;
  find_levels(&walk.tree, frame.light_count);
  LightSums kept[kTilePixels / LANES];
  Candidates candidates;
  Task task = {&frame, &planes, lights, image, false, false, 0, false};
  uint step = tiles;  // tiles that share a walk
  for (uint from = 0; from < tiles;) {
    uint group_log2 = step > 1 ? 6 : 4;
    start_walk(&walk, position, frame.plane_stride, first_pixel + from, step, group_log2, LIT ? frame.light_count : 0);
    find_lights(&walk, lights, &candidates);
    if (step > 1 && candidates.count == kCandidates) {
      step = 1;
      continue;
    }
    for (task.begun = false;; task.begun = true) {
      task.last = candidates.count < kCandidates;
      for (uint tile = 0; tile < step; ++tile) {
        uint first = first_pixel[from + tile], next = first_pixel[min(from + tile + 1, tiles - 1)];
        shade_tile(&task, first, next, group_log2, tile * (kTilePixels >> group_log2), &candidates, kept,
                   counts + 2 * (first / kTilePixels));
      }
      if (task.last) break;
      find_lights(&walk, lights, &candidates);
    }
    from += step;
  }
}
