// Culling and shading in one, for pictures of which nobody else reads the light lists. The same bits as
// cull.cl and shade.cl give.
//
// In: the planes of a G-buffer, lights, and the tree over them. Out: 3 planes of linear colour, and two
// counts for each tile.
//
// A work-item takes a block of up to 4 × 4 tiles:
//
//   one walk through the tree for all of them (light_tree.clh): up to kCandidates lights, with a bit for
//   each group of 8×8 pixels in reach
//   └─ for each row of LANES pixels: the lights of its group that add anything to the row, by an exact test
//      └─ the row, its sums in registers, lit by these
//
// Blocks in which more than kCandidates lights reach something are taken tile by tile, in as many pieces of a
// walk as it takes. The sums of a tile's rows are kept meanwhile. So there is no cap. Cost: reading positions
// twice, all else once, and normals and colours only of rows that a light may reach; some 20 instructions for
// a row and a light in reach of its group, and 100 for those that light the row.
#define GROUPS 64  // kBlockTiles · kTileGroups
#include "lanes.clh"
#include "lights/light_tree.clh"
#include "shade/shading.clh"
#include "shared.h"

// How many lights are found before rows are lit by them.
enum { kCandidates = 256 };

enum { kGroupPixels = 64, kTileGroups = kTilePixels / kGroupPixels };

// Lights that reach some group, in the order of their indices.
typedef struct {
  uint count;
  uint light[kCandidates];                        // its index
  uint groups[GROUPS / 32][kCandidates] ALIGNED;  // bit i of word j: the light reaches group 32·j + i
  TestedLight tested[kCandidates];
} Candidates;

// Without LIGHT_AMBIENT a light adds nothing where a surface faces away from it.
#define TESTS (LIGHT_AMBIENT ? kByCone : kByCone | kByFacing)

// Which of `groups` a spot's cone may touch.
INLINE GroupMask groups_in_cone(const Tiles* tiles, __global const ShadeLight* light, GroupMask groups) {
  GroupMask touched = 0;
  for (uint i = 0; i < tiles->box_count; ++i) {
    vec3L extent, to_light = from_boxes(tiles->boxes + i, light, &extent);
    touched |= (GroupMask)lane_bits(may_touch_cone(to_light, extent, light)) << i * LANES;
  }
  return touched & groups;
}

// Finds the next lights of a walk: kCandidates or, at its end, fewer.
INLINE void find_lights(Walk* walk, __global const ShadeLight* lights, Candidates* candidates) {
  uint count = 0;
  while (count < kCandidates) {
    GroupMask groups;
    uint light = next_light(walk, &groups);
    if (light == kNoLight) break;
    if (IS_SPOT(lights + light)) groups = groups_in_cone(&walk->tiles, lights + light, groups);
    candidates->light[count] = light;
    candidates->groups[0][count] = (uint)groups;
    candidates->groups[1][count] = (uint)(groups >> 32);
    candidates->tested[count] = tested_light(lights + light);
    count += groups ? 1 : 0;
  }
  candidates->count = count;
  // They are looked at LANES at a time.
  for (uint i = count; i % LANES > 0; ++i) candidates->groups[0][i] = candidates->groups[1][i] = 0;
}

// Bit i: whether candidate first + i reaches any of the groups in `wanted`, of one word of Candidates.groups.
INLINE uint candidates_in_reach(const uint* groups, uint first, uint wanted) {
  intL reached = *(const intL*)(groups + first);
  return lane_bits((reached & (intL)((int)wanted)) != 0);
}

// Writes the numbers of those candidates that reach a group, and returns how many they are.
INLINE uint find_candidates(const Candidates* candidates, uint group, uint* found) {
  uint count = 0;
  for (uint i = 0; i < candidates->count; i += LANES)
    for (uint bits = candidates_in_reach(candidates->groups[group / 32], i, 1u << group % 32); bits;
         bits &= bits - 1)
      found[count++] = i + lowest_bit(bits);
  return count;
}

// What all rows of a work-item share.
typedef struct {
  const ShadeFrame* frame;
  const Planes* planes;
  __global const ShadeLight* lights;
  __global const float* luminaires;
  __global float* image;
  bool begun;  // the rows' sums were kept from earlier candidates
  bool last;   // no candidates follow
} Task;

// Rows of a group whose lights are found before the first of them is lit, so that a light is loaded once for
// all of them, and a core that lights a row knows long before how many lights come.
#define ROWS ABREAST

// The lights that add anything to a row of pixels, of those that are near its group.
typedef struct {
  uint count;
  uint light[kCandidates];
} RowLights;

// Finds the lights of ROWS rows, of `count` candidates. near: the candidates' numbers.
INLINE void find_row_lights(const Task* task, uint first, const Candidates* candidates, const uint* near,
                            uint count, RowLights* rows) {
  EACH_ABREAST(row, ROWS) rows[row].count = 0;
  if (count == 0) return;
  uint stride = task->frame->plane_stride;
  vec3L position[ROWS], normal[ROWS];
  EACH_ABREAST(row, ROWS) {
    position[row] = load_vec3(task->planes->position + first + row * LANES, stride);
    normal[row] = load_vec3(task->planes->normal + first + row * LANES, stride);
  }
  for (uint i = 0; i < count; ++i) {
    const TestedLight* tested = candidates->tested + near[i];
    uint light = candidates->light[near[i]];
    EACH_ABREAST(row, ROWS) {
      // Written even if it adds nothing: the next light then overwrites it. That saves a branch.
      rows[row].light[rows[row].count] = light;
      rows[row].count += any_lane(adds_light(position[row], normal[row], tested, TESTS)) ? 1 : 0;
    }
  }
}

// Adds `abreast` lights, a constant number, to a row of pixels.
INLINE void add_to_row(const uint abreast, const Task* task, Pixels* row, const uint* light, bool long_sums) {
  Shadows none = {0, 0, 0, 0, 0, 0, 0, 0};
  Pixels* rows[ABREAST];
  __global const ShadeLight* lights[ABREAST];
  uint entry[ABREAST];
  EACH_ABREAST(k, abreast) {
    rows[k] = row;
    lights[k] = task->lights + light[k];
    entry[k] = 0;
  }
  add_lights(abreast, rows, lights, abreast, entry, task->luminaires, &none, task->frame->model, long_sums);
}

// Lights a row of pixels. kept: the row's sums between one set of candidates and the next.
INLINE void shade_row(const Task* task, uint first, const RowLights* lights, LightSums* kept) {
  uint count = lights->count, i = 0;
  Pixels row;
  // What only lights need isn't read.
  if (count == 0 && task->last && !task->begun) {
    start_row(&row, task->frame, first, task->planes, false, false);
    finish_row(&row, task->frame, first, task->planes, false, false, any_lane(row.covered), task->image);
    return;
  }
  // With fewer lights than that, one block takes them all.
  bool long_sums = LONG_SUMS && (task->begun || !task->last || count > kSumBlock);
  start_row(&row, task->frame, first, task->planes, LIT, long_sums);
  if (LIT && task->begun) row.sums = *kept;
  for (; i + ABREAST <= count; i += ABREAST) add_to_row(ABREAST, task, &row, lights->light + i, long_sums);
  // One alone takes more than half of the time of ABREAST, so what is left goes at once.
  if (ABREAST > 3 && count - i == 3) add_to_row(3, task, &row, lights->light + i, long_sums);
  if (ABREAST > 2 && count - i == 2) add_to_row(2, task, &row, lights->light + i, long_sums);
  if (ABREAST > 1 && count - i == 1) add_to_row(1, task, &row, lights->light + i, long_sums);
  if (task->last) {
    finish_row(&row, task->frame, first, task->planes, LIT, long_sums, any_lane(row.covered), task->image);
  } else if (LIT) {
    if (long_sums) start_closed(&row.sums);
    *kept = row.sums;
  }
}

// Lights a tile. first, next: the first pixel of this tile and of one that is lit after it; later: of one
// whose positions are wanted when this block is done. group: the tile's first. kept: for each row of the
// tile. Adds to counts[0] the candidates in reach of any group, and to counts[1] the pairs of a row and a
// light that it lights.
INLINE void shade_tile(const Task* task, uint first, uint next, uint later, uint group,
                       const Candidates* candidates, LightSums* kept, __global uint* counts) {
  uint stride = task->frame->plane_stride;
  uint wanted = ((1u << kTileGroups) - 1) << group % 32;
  uint in_reach = 0, pairs = 0;
  for (uint i = 0; i < candidates->count; i += LANES)
    in_reach += popcount(candidates_in_reach(candidates->groups[group / 32], i, wanted));
  for (uint end = group + kTileGroups; group < end; ++group) {
    uint near[kCandidates];
    uint count = find_candidates(candidates, group, near);
    // Where this group has no lights, those beside it often have none either, and read little.
    bool reads_much = AMBIENT || EMISSION || count > 0;
    RowLights lights[ROWS];
    for (uint i = 0; i < kGroupPixels / LANES; i += ROWS) {
      find_row_lights(task, first, candidates, near, count, lights);
      for (uint row = 0; row < ROWS; ++row) {
        if (reads_much) prefetch_rows(next, 1, stride, task->planes);
        prefetch_lanes(task->planes->position + later, stride, 3, 1);
        shade_row(task, first, lights + row, kept);
        pairs += lights[row].count;
        first += LANES;
        next += LANES;
        later += LANES;
        ++kept;
      }
    }
  }
  counts[0] = in_reach + (task->begun ? counts[0] : 0);
  counts[1] = pairs + (task->begun ? counts[1] : 0);
}

// Lights a block of tiles. first_pixel: of each of them. The rest: see shade_tiles().
WORK void shade_block(ShadeTilesFrame frame, Planes planes, __global const float* tree,
                      __global const ShadeLight* lights, __global const float* luminaires,
                      const uint* first_pixel, uint tiles, __global float* image, __global uint* counts) {
  uint width = frame.block_width;
  Walk walk;
  walk.tiles.position = planes.position;
  walk.tiles.normal = planes.normal;
  walk.tiles.plane_stride = frame.shade.plane_stride;
  walk.tiles.group_pixels = kGroupPixels;
  LightSums kept[kTilePixels / LANES];
  Candidates candidates;
  Task task = {&frame.shade, &planes, lights, luminaires, image, false, false};
  uint step = tiles;                                   // tiles that share a walk
  uint last = frame.shade.plane_stride - kTilePixels;  // the picture's last tile
  for (uint from = 0; from < tiles;) {
    walk.tiles.first_pixel = first_pixel + from;
    walk.tiles.group_count = step * kTileGroups;
    start_walk(&walk, tree, frame.tree_stride, LIT ? frame.shade.light_count : 0);
    find_lights(&walk, lights, &candidates);
    if (step > 1 && candidates.count == kCandidates) {
      step = 1;
      continue;
    }
    for (task.begun = false;; task.begun = true) {
      task.last = candidates.count < kCandidates;
      for (uint tile = 0; tile < step; ++tile) {
        uint first = first_pixel[from + tile];
        // The block to the right follows within a run.
        uint later = min(first + width * kTilePixels, last),
             beside = min(first_pixel[0] + width * kTilePixels, last);
        uint next = from + tile + 1 < tiles ? first_pixel[from + tile + 1] : beside;
        shade_tile(&task, first, next, later, tile * kTileGroups, &candidates, kept,
                   counts + 2 * (first / kTilePixels));
      }
      if (task.last) break;
      find_lights(&walk, lights, &candidates);
    }
    from += step;
  }
}

// Planes and image: see shade(). There is a work-item for each block, up to a multiple of kBlockRun. Blocks
// side by side follow each other in runs, whose planes lie together. frame.run_stride, which has no factor in
// common with the number of runs, spreads these over the picture, because a device may share work-items out
// many at a time. counts: two for each tile, see shade_tile().
KERNEL void shade_tiles(ShadeTilesFrame frame, __global const float* position, __global const float* normal,
                        __global const float* diffuse, __global const float* specular,
                        __global const float* ambient, __global const float* emission,
                        __global const uint* surface_normal, __global const uint* model,
                        __global const uint* tangent, __global const float* tree,
                        __global const ShadeLight* lights, __global const float* luminaires,
                        __global float* image, __global uint* counts, __global uint* faulty_pixels) {
  Planes planes = {position,       normal, diffuse, specular,      ambient, emission,
                   surface_normal, 0,      model,   faulty_pixels, tangent};
  uint width = frame.block_width, height = frame.block_height;
  uint blocks_x = (frame.tiles_x + width - 1) / width, blocks_y = (frame.tiles_y + height - 1) / height;
  uint blocks = blocks_x * blocks_y, runs = (blocks + kBlockRun - 1) / kBlockRun, item = work_item();
  uint run = (uint)((ulong)(item / kBlockRun) * frame.run_stride % runs);
  uint block = run * kBlockRun + item % kBlockRun;
  if (block >= blocks) return;
  uint block_x = block % blocks_x * width, block_y = block / blocks_x * height;
  uint columns = min(width, frame.tiles_x - block_x), tiles = columns * min(height, frame.tiles_y - block_y);
  uint first_pixel[kBlockTiles];
  for (uint tile = 0; tile < tiles; ++tile)
    first_pixel[tile] = ((block_y + tile / columns) * frame.tiles_x + block_x + tile % columns) * kTilePixels;
  shade_block(frame, planes, tree, lights, luminaires, first_pixel, tiles, image, counts);
}
