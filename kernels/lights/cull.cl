// Light lists: for every tile the lights that may light a point it shows, ascending by index, and beside each
// light which of the tile's squares it may light. A list may be of any length, so the lists are counted
// before they are written:
//
//   find_lights → scan_lists → find_lights
//
// In: position and normal planes of a G-buffer (view space, metres), lights, and a tree over them.
// Out: `starts`, a uint for each tile and one more, and `list`, 8 bytes an entry.
//
//   starts  0 3 3 7 …          a tile's entries in `list` are [starts[i], starts[i + 1])
//   list    4 9 12 | | 0 …     light, squares
//
// A work-item of find_lights takes a tile, scan_lists is one work-item. A tile costs reading its positions
// and normals twice (24 bytes a pixel), the nodes on the way to the lights in reach (light_tree.clh), a test
// of its squares for each such light, and where a square is wide for the light one of its very points. The
// second run pays that again only for lists of more than kFoundPerTile entries.
#include "lanes.clh"
#include "lights/light_tree.clh"
#include "shared.h"

// Where the surfaces of a tile's groups face: one group a lane, in the order of Tiles.boxes.
typedef struct {
  vec3L low, high;  // corners of the box around the normals
  floatL plane;     // the least of normal · (point − middle of the group's box)
} Facing;

INLINE void bound_normals(const Tiles* tiles, Facing* facing) {
  for (uint group = 0; group < tiles->group_count; ++group) {
    const float* corners = (const float*)(tiles->boxes + group / LANES) + group % LANES;
    vec3L middle =
        all_lanes(0.5f * (float4)(corners[0 * LANES], corners[1 * LANES], corners[2 * LANES], 0.0f) +
                  0.5f * (float4)(corners[3 * LANES], corners[4 * LANES], corners[5 * LANES], 0.0f));
    Boxes normals = no_boxes();
    floatL plane = INFINITY;
    uint first = first_of_group(tiles, group);
    for (uint pixel = first; pixel < first + tiles->group_pixels; pixel += LANES) {
      vec3L p = load_vec3(tiles->position + pixel, tiles->plane_stride),
            n = load_vec3(tiles->normal + pixel, tiles->plane_stride);
      intL covered = p.z > -INFINITY;
      grow_boxes(&normals, n, covered);
      floatL along = dot3(n, (vec3L){p.x - middle.x, p.y - middle.y, p.z - middle.z});
      plane = min_lanes(plane, covered ? along : (floatL)(INFINITY));
    }
    float* out = (float*)(facing + group / LANES) + group % LANES;
    store_box(out, box_around(&normals));
    out[6 * LANES] = least_lane(plane);
  }
}

// Bound of the rounding errors that the tests below allow for, relative to the lengths that they start from:
// about a dozen roundings of 2^-24 in the test, and as many in shading.
#define SLACK 4e-6f

// Mask: whether any point of a box may face the light. With m the box's middle, normal · (light − point) is
// at most the greatest normal · (light − m) less the least normal · (point − m), which is `plane`. to_light:
// from m, or towards a directional light.
INLINE intL may_face(vec3L to_light, vec3L extent, const Facing* facing, floatL plane) {
  floatL most = max_lanes(to_light.x * facing->low.x, to_light.x * facing->high.x) +
                max_lanes(to_light.y * facing->low.y, to_light.y * facing->high.y) +
                max_lanes(to_light.z * facing->low.z, to_light.z * facing->high.z);
  floatL sizes = max_lanes(to_light.x, -to_light.x) + max_lanes(to_light.y, -to_light.y) +
                 max_lanes(to_light.z, -to_light.z) + extent.x + extent.y + extent.z;
  return !(most - plane <= -SLACK * sizes);
}

// Those of the groups of LANES boxes that a light which reaches the boxes may light. tests: kByRange …
INLINE uint groups_lit(const Boxes* boxes, const Facing* facing, __global const ShadeLight* light,
                       uint tests) {
  vec3L to_light = all_lanes(light->position), extent = all_lanes((float4)(0.0f));
  floatL plane = 0.0f;
  if (light->kind != kDirectionalLight) {
    to_light = from_boxes(boxes, light, &extent);
    plane = facing->plane;
  }
  intL lit = (intL)(1) != (intL)(0);
  if ((tests & kByCone) && light->kind == kSpotLight) lit &= may_touch_cone(to_light, extent, light);
  if (tests & kByFacing) lit &= may_face(to_light, extent, facing, plane);
  return lane_bits(lit);
}

// Whether a light adds anything to any point of a group.
INLINE bool lights_group(const Tiles* tiles, uint group, const TestedLight* light, uint tests) {
  uint first = first_of_group(tiles, group);
  for (uint pixel = first; pixel < first + tiles->group_pixels; pixel += LANES)
    if (any_lane(adds_light(load_vec3(tiles->position + pixel, tiles->plane_stride),
                            load_vec3(tiles->normal + pixel, tiles->plane_stride), light, tests)))
      return true;
  return false;
}

// Writes the list of a tile, or its first `room` entries, and returns how long the list is.
WORK uint list_lights(Tiles tile, const CullFrame* frame, __global const float* tree,
                      __global const ShadeLight* lights, __global ListEntry* list, uint room) {
  uint tests = frame->tests, squares_per_group = (kSquaresPerTile << frame->group_log2) / kTilePixels;
  Walk walk;
  walk.tiles = tile;
  start_walk(&walk, tree, frame->tree_stride, frame->light_count);
  Facing facing[BOXES];
  bound_normals(&walk.tiles, facing);
  uint first_squares = (1u << squares_per_group) - 1;  // those of the first group
  uint count = 0;
  GroupMask near;
  for (uint light; (light = next_light(&walk, &near)) != kNoLight;) {
    uint lit = 0;
    for (uint i = 0; i < BOXES; ++i)
      lit |= groups_lit(walk.tiles.boxes + i, facing + i, lights + light, tests) << i * LANES;
    lit &= near;
    TestedLight tested = tested_light(lights + light);
    for (uint rest = wide_groups(&walk.tiles, (floatL)(0.0f), tested.place.w, lit); rest; rest &= rest - 1) {
      uint group = lowest_bit(rest);
      if (!lights_group(&walk.tiles, group, &tested, tests)) lit &= ~(1u << group);
    }
    // Written even if it lights no square: the next light then overwrites it. That saves a branch that no
    // processor can predict.
    if (count < room) {
      uint squares = lit;
      if (squares_per_group > 1) {
        squares = 0;
        for (uint rest = lit; rest; rest &= rest - 1)
          squares |= first_squares << lowest_bit(rest) * squares_per_group;
      }
      list[count].light = light;
      list[count].squares = squares;
    }
    count += lit ? 1 : 0;
  }
  return count;
}

// The lists, in two runs:
// - frame.fill 0: sets starts[tile] to how many lights the list of each tile holds, and writes the first of
//   them to `found`, which has kFoundPerTile entries for each tile.
// - frame.fill 1: writes the lists to the places that `starts` tells: copied from `found` where that holds
//   all of a list, otherwise found again.
KERNEL void find_lights(CullFrame frame, __global const float* position, __global const float* normal,
                        __global const float* tree, __global const ShadeLight* lights,
                        __global ListEntry* found, __global uint* starts, __global ListEntry* all_lists) {
  uint tile = work_item(), room = kFoundPerTile;
  __global ListEntry* list = found + tile * kFoundPerTile;
  if (frame.fill) {
    __global const ListEntry* first_found = list;
    list = all_lists + starts[tile];
    room = starts[tile + 1] - starts[tile];
    if (room <= kFoundPerTile) {
      for (uint i = 0; i < room; ++i) list[i] = first_found[i];
      return;
    }
  }
  uint first = tile * kTilePixels;
  Tiles own;
  own.position = position;
  own.normal = normal;
  own.plane_stride = frame.plane_stride;
  own.first_pixel = &first;
  own.group_pixels = 1u << frame.group_log2;
  own.group_count = kTilePixels >> frame.group_log2;
  uint count = list_lights(own, &frame, tree, lights, list, room);
  if (!frame.fill) starts[tile] = count;
  // Both runs find the same lights. Should a compiler ever round them differently, the rest are entries
  // without squares.
  for (ListEntry none = {0, 0}; frame.fill && count < room; ++count) list[count] = none;
}

// Exclusive prefix sum in place, by one work-item. starts: tiles + 1; in: the counts; out: where each list
// starts, then the total. Sums saturate at 2³² − 1, a total that the host refuses.
KERNEL void scan_lists(uint tiles, __global uint* starts) {
  ulong sum = 0;
  for (uint tile = 0; tile < tiles; ++tile) {
    uint count = starts[tile];
    starts[tile] = (uint)min(sum, (ulong)0xffffffffu);
    sum += count;
  }
  starts[tiles] = (uint)min(sum, (ulong)0xffffffffu);
}
