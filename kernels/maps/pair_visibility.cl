// Looks up shadow maps for single pairs of a point and a map, as shading does: to measure how often maps are
// wrong.
//
// In: points (view space, metres) in rows of LANES, the map that each row looks up, and the shadow maps with
// their texels. Out: `visibility`, a float for each point, in [0, 1]. A work-item takes a row, and costs one
// lookup: see shadow.clh.
#include "features.clh"
#include "lanes.clh"
#include "maps/shadow.clh"
#include "math.clh"
#include "shared.h"

// position, normal: planes x y z of `stride` floats. surface_normal, lift: see shading.clh. map_of_row: an
// index into `maps` for each row. texel_count: ≥ 1.
KERNEL void pair_visibility(uint stride, __global const float* position, __global const float* normal,
                            __global const uint* surface_normal, __global const float* lift,
                            __global const uint* map_of_row, __global const ShadowMap* maps,
                            __global const ShadowFace* faces, __global const ShadowTexel* texels,
                            uint texel_count, __global float* visibility) {
  if (!SHADOW_MAPS) return;
  uint row = work_item(), first = row * LANES;
  MapPoint point = receiver_point(maps + map_of_row[row], faces, load_vec3(position + first, stride),
                                  load_vec3(normal + first, stride),
                                  unpack_normal(*(__global const intL*)(surface_normal + first)),
                                  LIFT ? load_lanes(lift + first) : (floatL)(0.0f));
  store_lanes(visibility + first, map_lookup(maps + map_of_row[row], faces, texels, texel_count, point));
}
