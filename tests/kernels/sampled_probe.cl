#include "clusters/light_clusters.clh"
#include "clusters/lobes.clh"
#include "lanes.clh"
#include "random.clh"
#include "sampled/cut.clh"
#include "sampled/sampled_group.clh"
#include "sampled/sampled_light.h"
#include "sampled/strata.clh"
#include "shared.h"

// Columns: middle, normal and axis, x y z each; radius, spread, thickness, turn, exponent, model; the largest
// diffuse and specular colours.
enum { kBoundColumns = 17 };

INLINE GroupBounds bounds_of(__global const float* in, uint stride, uint i) {
  GroupBounds bounds;
  PixelGroup* place = &bounds.shine.place;
  for (uint axis = 0; axis < 3; ++axis) {
    place->middle[axis] = in[i + axis * stride];
    place->normal[axis] = bounds.shine.normal[axis] = in[i + (3 + axis) * stride];
    bounds.shine.axis[axis] = in[i + (6 + axis) * stride];
  }
  place->radius = in[i + 9 * stride];
  place->spread = in[i + 10 * stride];
  place->thickness = in[i + 11 * stride];
  place->gain = 0.0f;
  bounds.shine.turn = in[i + 12 * stride];
  bounds.shine.exponent = in[i + 13 * stride];
  bounds.shine.model = (uint)in[i + 14 * stride];
  bounds.diffuse = in[i + 15 * stride];
  bounds.specular = in[i + 16 * stride];
  return bounds;
}

INLINE LightTrees trees_of(__global const float* rows, __global const float* light_rows,
                           __global const float* lobes, uint lights, uint levels) {
  ClusterTree tree = {rows, light_rows, lights, levels};
  LightTrees trees = {tree, tree, lobes, 0.0f};
  return trees;
}

// in: a group's bounds; a stratum's level and node, a seed, and the picks that are used as two numbers of 16
// bits, the low ones first. out: the light of each pick, -1 without one; the weight of each.
__kernel void probe_picks(__global const float* in, __global float* out, uint stride,
                          __global const float* rows, __global const float* light_rows,
                          __global const float* lobes, __global const uint* size) {
  uint first = work_item() * LANES;
  LightTrees trees = trees_of(rows, light_rows, lobes, size[0], size[1]);
  for (uint i = first; i < first + LANES; ++i) {
    GroupBounds bounds = bounds_of(in, stride, i);
    __global const float* of_case = in + kBoundColumns * stride + i;
    TreeNode node = {(uint)of_case[0], (uint)of_case[stride]};
    uint4 seed = (uint4)((uint)of_case[2 * stride], 3, 5, 0);
    uint used = (uint)of_case[3 * stride] | (uint)of_case[4 * stride] << 16;
    Picks picks;
    pick_lights(&trees, &bounds, node, seed, used, &picks);
    for (uint k = 0; k < 2 * kPicks; ++k) {
      bool is_picked = picks.light[k] != kNoPick;
      out[i + k * stride] = is_picked ? (float)picks.light[k] : -1.0f;
      out[i + (2 * kPicks + k) * stride] = is_picked ? picks.weight[k] : 0.0f;
    }
  }
}

// in: a group's bounds. As the first work-item finds them after halves[0] halvings, out holds: room for
// kMostStrata strata, for the heap, for the order of those that are new, and for free values; then the
// numbers of strata, of the heap and of the order, and the cost.
__kernel void probe_cut(__global const float* in, __global float* out, uint stride,
                        __global const float* rows, __global const float* light_rows,
                        __global const float* lobes, __global const uint* size, __global const uint* halves) {
  if (work_item() > 0) return;
  LightTrees trees = trees_of(rows, light_rows, lobes, size[0], size[1]);
  GroupBounds bounds = bounds_of(in, stride, 0);
  __global uint* places = (__global uint*)(out + kMostStrata * (sizeof(Stratum) / sizeof(float)));
  Cut cut = {(__global Stratum*)out,
             places,
             places + kMostStrata,
             places + 2 * kMostStrata,
             (__global float*)0,
             (__global ulong*)0,
             0,
             0,
             0,
             0,
             0};
  start_cut(&trees.diffuse, &cut);
  for (uint i = 0; i < halves[0] && halve_stratum(&trees, &bounds, &cut); ++i) {
  }
  uint count = list_new(&cut);
  __global uint* counts = places + 3 * kMostStrata;
  counts[0] = cut.strata_count;
  counts[1] = cut.heap_count;
  counts[2] = count;
  counts[3] = cut.cost;
}

// in: the weights of kClusterSlots slots, how many of them there are, the picks, and ξ. out: the first pick
// of each slot, and of the one after the last; the sum.
__kernel void probe_share_out(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  for (uint i = first; i < first + LANES; ++i) {
    float weight[kClusterSlots];
    for (uint slot = 0; slot < kClusterSlots; ++slot) weight[slot] = in[i + slot * stride];
    __global const float* of_case = in + kClusterSlots * stride + i;
    uint slots = (uint)of_case[0], taken[kClusterSlots + 1];
    float sum = share_out(weight, slots, (uint)of_case[stride], of_case[2 * stride], taken);
    for (uint slot = 0; slot <= slots; ++slot) out[i + slot * stride] = (float)taken[slot];
    out[i + (kClusterSlots + 1) * stride] = sum;
  }
}

// in: kSampledPixels values. out: their sum.
__kernel void probe_sum_of_pixels(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  for (uint i = first; i < first + LANES; ++i) {
    float values[kSampledPixels] ALIGNED;
    for (uint k = 0; k < kSampledPixels; ++k) values[k] = in[i + k * stride];
    out[i] = sum_of_pixels(values);
  }
}

// in: four numbers of 16 bits. out: the hash of them, halves of 16 bits of each number, the low one first;
// and random_unit() of 1 2 3 4 and the first two.
__kernel void probe_random(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  for (uint i = first; i < first + LANES; ++i) {
    uint4 v = (uint4)((uint)in[i], (uint)in[i + stride], (uint)in[i + 2 * stride], (uint)in[i + 3 * stride]);
    uint4 hash = hash4(v);
    uint of_axis[4] = {hash.x, hash.y, hash.z, hash.w};
    for (uint axis = 0; axis < 4; ++axis) {
      out[i + 2 * axis * stride] = (float)(of_axis[axis] & 0xffff);
      out[i + (2 * axis + 1) * stride] = (float)(of_axis[axis] >> 16);
    }
    out[i + 8 * stride] = random_unit((uint4)(1, 2, 3, 4), v.x, v.y);
  }
}

// in: a place of a pixel in its group of 8 × 8, in Z order. out: its pick.
__kernel void probe_bayer_pick(__global const float* in, __global float* out, uint stride) {
  uint first = work_item() * LANES;
  for (uint i = first; i < first + LANES; ++i) out[i] = (float)bayer_pick((uint)in[i]);
}
