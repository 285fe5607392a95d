// Which of many pairs of a point and a light see each other: exactly, by rays through the tree.
//
// What beam_shadows.cl decides for all pixels of a tile and a light this decides for single pairs, in any
// order, by the same rules.
//
// In: pairs, start points in the tree's space, lights and the tree. Out: a bit for each pair that nothing is
// between; where the scene has materials with holes also one for each pair about which textures decide.
//
// A work-item takes kRayRun pairs: kTreeWidth rays are aimed side by side (rays.clh), then each walks through
// the tree (ray_walk.clh).
#include "exact/light_rays.h"
#include "exact/ray_walk.clh"
#include "exact/rays.clh"
#include "features.clh"
#include "lanes.clh"
#include "shared.h"

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
  trace_run(&scene, &frame, &buffers, work_item() * kRayRun);
}
