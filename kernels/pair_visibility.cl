// What shadow maps say of single points and lights: for measuring how often they are wrong.
#include "features.clh"
#include "lanes.clh"
#include "math.clh"
#include "shadow.clh"
#include "shared.h"

// position, normal: planes of `stride` floats, x y z, view space; geometric_normal, lift: see shade.cl. A row of LANES points shares its light, whose map is
// map_of_row. visibility: one float a point, in [0, 1].
__kernel void pair_visibility(uint stride, __global const float *position, __global const float *normal,
                              __global const uint *geometric_normal, __global const float *lift, __global const uint *map_of_row, __global const ShadowMap *maps,
                              __global const ShadowFace *faces, __global const ShadowTexel *texels, uint texel_count,
                              __global float *visibility) {
  if (!SHADOWS) return;
  uint row = get_global_id(0), first = row * LANES;
  MapPoint point = receiver_point(maps + map_of_row[row], faces, load_vec3(position + first, stride),
                                  load_vec3(normal + first, stride), unpack_normal(*(__global const intL *)(geometric_normal + first)),
                                  LIFT ? load_lanes(lift + first) : (floatL)(0.0f));
  store_lanes(visibility + first, map_lookup(maps + map_of_row[row], faces, texels, texel_count, point));
}
