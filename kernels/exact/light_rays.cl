// Which of many pairs of a point and a light see each other: exactly, by rays through the tree.
//
// What beam_shadows.cl decides for all pixels of a tile and a light this decides for single pairs, in any
// order, by the same rules.
//
// In: pairs, start points in the tree's space, lights and the tree. Out: a bit for each pair that nothing is
// between; where the scene has materials with holes also one for each pair about which textures decide.
//
//   kTreeWidth rays are aimed side by side (rays.clh); then for each
//   ├─ the triangles that blocked the last ones: half of all rays, or more, end here
//   └─ a walk through the tree, blocks before nodes, until a triangle blocks the ray
//
// A work-item takes kRayRun pairs. Rays that follow each other are fast where they start and end near each
// other, as large triangles then block many of them, and what they meet is in the caches. Cost: some 60
// instructions for each node and for each block of 16 triangles, of which a ray in a scene of 300,000
// triangles meets 4 and 2.
#include "exact/light_rays.h"
#include "exact/rays.clh"
#include "features.clh"
#include "lanes.clh"
#include "shared.h"

// What rays go through.
typedef struct {
  __global const float* nodes;
  __global const int* children;
  __global const float* blocks;
  __global const uint* block_bits;
  HoleMasks masks;
  int root;
  float width;  // of all of it
} RayScene;

// The last triangles without holes that blocked rays, as a block of the tree has them.
typedef struct {
  float rows[kBlockRows][kTreeWidth] ALIGNED;
  float width[kTreeWidth] ALIGNED;  // of their boxes
  uint reference[kTreeWidth];
  uint used;  // bits
  uint next;  // to replace, modulo kTreeWidth
} LastBlockers;

// The walk of a ray through the tree.
typedef struct {
  int next;     // where it goes next: a node, or as its complement a block
  float width;  // of the block's box
  int node;     // whose children are visited
  uint left;    // bits of those that are left
  uint height;  // of the stack: nodes above, and their children that are left
  int nodes[kMaxTreeDepth];
  uint lefts[kMaxTreeDepth];
} RayWalk;

INLINE __global const float* node_rows(const RayScene* scene, int node) {
  return scene->nodes + node * (kNodeRows * kTreeWidth);
}
INLINE __global const float* block_rows(const RayScene* scene, uint block) {
  return scene->blocks + block * (kBlockRows * kTreeWidth);
}

INLINE void fetch_rows(__global const float* rows, uint count) {
#ifdef PREFETCH
  for (uint row = 0; row < count; ++row) PREFETCH(rows + row * kTreeWidth);
#endif
}

INLINE void remember_triangle(const RayScene* scene, LastBlockers* last, uint reference) {
  uint to = last->next++ % kTreeWidth;
  __global const float* rows = block_rows(scene, BLOCK_OF(reference)) + SLOT_OF(reference);
  for (uint row = 0; row < kBlockRows; ++row) last->rows[row][to] = rows[row * kTreeWidth];
  float width = 0.0f;
  UNROLLED(axis, 3) {
    float a = last->rows[kCornerRows + axis][to], b = last->rows[kCornerRows + 3 + axis][to],
          c = last->rows[kCornerRows + 6 + axis][to];
    width = greater(width, greater(a, greater(b, c)) - lesser(a, lesser(b, c)));
  }
  last->width[to] = width;
  last->reference[to] = reference;
  last->used |= 1u << to;
}

// Whether a triangle that the start is beyond blocks the light but for holes, by the rules of blockers.clh.
SHARED_WORK bool blocks_exactly(__global const float* blocks, uint reference, float4 light, float4 start) {
  __global const float* plane =
      blocks + BLOCK_OF(reference) * (kBlockRows * kTreeWidth) + kPlaneRows * kTreeWidth + SLOT_OF(reference);
  float height =
      fma(plane[0], start.x,
          fma(plane[kTreeWidth], start.y, fma(plane[2 * kTreeWidth], start.z, -plane[3 * kTreeWidth])));
  return side_of_light(blocks, reference, light) == (height > 0.0f ? 1 : -1) &&
         edges_hold(blocks, reference, light, start) && is_before(blocks, reference, light, start);
}

// Finds one of some triangles that blocks ray i. may: bits of those that may, by lane. sure: of those that
// certainly do, but for holes. references: of each lane, or 0: they follow `first`. holes: bits of those with
// holes. Returns its lane, or LANES. Sets *unsure where a texture decides.
SHARED_WORK uint find_blocker(const RayScene* scene, const RayGroup* g, uint i, uint may, uint sure,
                              const uint* references, uint first, uint holes, bool* unsure) {
  float4 start = (float4)(g->start[0][i], g->start[1][i], g->start[2][i], 0.0f);
  float4 light = (float4)(g->place[0][i], g->place[1][i], g->place[2][i], g->place[3][i]);
  for (; may; may &= may - 1) {
    uint lane = lowest_bit(may), reference = references ? references[lane] : first + lane;
    if (!(sure >> lane & 1) && !blocks_exactly(scene->blocks, reference, light, start)) continue;
    if (!HOLES || !(holes >> lane & 1)) return lane;
    uint block = BLOCK_OF(reference), slot = SLOT_OF(reference);
    uint opacity = opacity_on_ray(&scene->masks, g, i, block_rows(scene, block) + slot, block, slot,
                                  scene->block_bits[block] >> kTreeWidth);
    if (opacity == kSolid) return lane;
    *unsure |= opacity == kMixed;
  }
  return LANES;
}

// Whether one of the last blockers blocks ray i.
INLINE bool last_block(const RayScene* scene, const RayGroup* g, uint i, const LastBlockers* last) {
  for (uint at = 0; at < kTreeWidth; at += LANES) {
    RayCorners corners = last_corners(g, i, last->rows[0] + at);
    EdgeRange edges = edge_range(g, i, &corners);
    floatL width = of_rays(last->width, at);
    floatL rounding = fma_lanes(width, (floatL)(g->rounding[i]), (floatL)(g->lost[i]));
    uint within = within_edges(&edges, rounding) & last->used >> at;
    if (!within) continue;
    RayPlanes planes = last_planes(last->rows[0] + at);
    RayBlockers found = blockers_of(g, i, &edges, width, rounding, &planes);
    if (found.sure & within) return true;
    bool unsure;
    if (found.may & within &&
        find_blocker(scene, g, i, found.may & within, 0, last->reference + at, 0, 0, &unsure) != LANES)
      return true;
  }
  return false;
}

// Whether a triangle of a block blocks ray i. width: of its box. Sets *unsure where a texture decides.
INLINE bool block_blocks(const RayScene* scene, const RayGroup* g, uint i, uint block, float width,
                         LastBlockers* last, bool* unsure) {
  uint bits = scene->block_bits[block];
  floatL rounding = fma(width, g->rounding[i], g->lost[i]);
  for (uint at = 0; at < kTreeWidth; at += LANES) {
    __global const float* rows = block_rows(scene, block) + at;
    RayCorners corners = block_corners(g, i, rows);
    EdgeRange edges = edge_range(g, i, &corners);
    uint within = within_edges(&edges, rounding) & (bits & 0xffff) >> at;
    if (!within) continue;
    RayPlanes planes = block_planes(rows);
    RayBlockers found = blockers_of(g, i, &edges, width, rounding, &planes);
    uint may = found.may & within, holes = HOLES ? bits >> (kTreeWidth + at) : 0;
    if (!may) continue;
    uint sure = found.sure & within & ~holes, first = block * kTreeWidth + at;
    uint lane = sure ? lowest_bit(sure) : find_blocker(scene, g, i, may, found.sure, 0, first, holes, unsure);
    if (lane == LANES) continue;
    if (!(holes >> lane & 1)) remember_triangle(scene, last, first + lane);
    return true;
  }
  return false;
}

// Chooses where a walk goes next, of a node's children the last one, and fetches what is there. Returns
// whether anything is left.
INLINE bool choose_next(const RayScene* scene, RayWalk* walk) {
  if (!walk->left) {
    if (!walk->height) return false;
    --walk->height;
    walk->node = walk->nodes[walk->height];
    walk->left = walk->lefts[walk->height];
  }
  uint child = 31 - clz(walk->left);
  walk->left ^= 1u << child;
  walk->next = scene->children[walk->node * kTreeWidth + child];
  if (walk->next >= 0) {
    fetch_rows((__global const float*)(scene->children + walk->next * kTreeWidth), 1);
    fetch_rows(node_rows(scene, walk->next), kNodeRows);
    return true;
  }
  fetch_rows(block_rows(scene, ~walk->next), kPlaneRows);
  __global const float* box = node_rows(scene, walk->node) + child;
  walk->width = 0.0f;
  UNROLLED(axis, 3)
    walk->width = greater(walk->width, box[(2 * axis + 1) * kTreeWidth] - box[2 * axis * kTreeWidth]);
  return true;
}

// Whether a triangle blocks ray i. *unsure: none is known to, and a texture decides.
INLINE bool is_blocked(const RayScene* scene, const RayGroup* g, uint i, LastBlockers* last, bool* unsure) {
  *unsure = false;
  if (last_block(scene, g, i, last)) return true;
  RayWalk walk;
  walk.next = scene->root;
  walk.width = scene->width;
  walk.left = walk.height = 0;
  do {
    if (walk.next < 0) {
      if (block_blocks(scene, g, i, ~walk.next, walk.width, last, unsure)) return true;
      continue;
    }
    uint met = met_children(g, i, node_rows(scene, walk.next));
    if (!met) continue;
    if (walk.left) {
      walk.nodes[walk.height] = walk.node;
      walk.lefts[walk.height++] = walk.left;
    }
    walk.node = walk.next;
    walk.left = met;
  } while (choose_next(scene, &walk));
  return false;
}

// The buffers of rays: see light_rays().
typedef struct {
  __global const LightRay* rays;
  __global const float* starts;
  __global const BeamLight* lights;
  __global uint *lit, *unsure;
} RayBuffers;

// Loads up to kTreeWidth rays. Places without one repeat the last.
INLINE void load_rays(const RayFrame* frame, const RayBuffers* buffers, uint first, uint count, RayGroup* g) {
  for (uint i = 0; i < kTreeWidth; ++i) {
    LightRay ray = buffers->rays[first + (i < count ? i : count - 1)];
    float4 place = buffers->lights[ray.light].place;
    UNROLLED(axis, 3) g->start[axis][i] = buffers->starts[axis * frame->start_stride + ray.point];
    g->place[0][i] = place.x;
    g->place[1][i] = place.y;
    g->place[2][i] = place.z;
    g->place[3][i] = place.w;
  }
#ifdef PREFETCH
  uint next = first + kTreeWidth, end = min(next + kTreeWidth, frame->rays);
  for (; next < end; ++next) PREFETCH(buffers->lights + buffers->rays[next].light);
#endif
}

WORK void trace_run(const RayScene* scene, const RayFrame* frame, const RayBuffers* buffers, uint first) {
  uint end = min(frame->rays, first + kRayRun);
  LastBlockers last;
  for (uint i = 0; i < sizeof(LastBlockers) / sizeof(uint); ++i) ((uint*)&last)[i] = 0;
  uint lit = 0, unsure = 0;
  for (; first < end; first += kTreeWidth) {
    RayGroup group;
    uint count = min(end - first, (uint)kTreeWidth);
    load_rays(frame, buffers, first, count, &group);
    aim_rays(&group, frame->tree_most);
    for (uint i = 0; i < count; ++i) {
      bool open;
      if (is_blocked(scene, &group, i, &last, &open)) continue;
      uint bit = 1u << (first + i) % 32;
      if (HOLES && open)
        unsure |= bit;
      else
        lit |= bit;
    }
    if (first % 32 == 0 && first + kTreeWidth < end) continue;
    buffers->lit[first / 32] = lit;
    if (HOLES) buffers->unsure[first / 32] = unsure;
    lit = unsure = 0;
  }
}

// starts: planes x y z, in the tree's space. nodes, children, blocks, block_bits: see TriangleTree; with
// HOLES block_bits, hole_texels, hole_triangles, first_hole_triangle: see HoleMasks. A work-item takes
// kRayRun rays.
// - lit: a bit for each ray that nothing blocks.
// - unsure: with HOLES only, for each: it isn't set in `lit`, and textures decide.
KERNEL void light_rays(RayFrame frame, __global const LightRay* rays, __global const float* starts,
                       __global const BeamLight* lights, __global const float* nodes,
                       __global const int* children, __global const float* blocks,
                       __global const uint* block_bits, __global const uchar* hole_texels,
                       __global const HoleTriangle* hole_triangles, __global const uint* first_hole_triangle,
                       __global uint* lit, __global uint* unsure) {
  HoleMasks masks = {hole_texels, hole_triangles, first_hole_triangle};
  float4 most = frame.tree_most;
  RayScene scene = {nodes,
                    children,
                    blocks,
                    block_bits,
                    masks,
                    frame.tree_root,
                    2.0f * greater(most.x, greater(most.y, most.z))};
  RayBuffers buffers = {rays, starts, lights, lit, unsure};
  trace_run(&scene, &frame, &buffers, get_global_id(0) * kRayRun);
}
