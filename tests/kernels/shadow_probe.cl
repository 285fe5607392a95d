// in: position, normal; out: the share of the light that one map lets through.
#include "lanes.clh"
#include "maps/shadow.clh"
#include "shared.h"

__kernel void probe_shadow(__global const float* in, __global float* out, uint stride,
                           __global const ShadowMap* map, __global const ShadowFace* faces,
                           __global const ShadowTexel* texels, __global const uint* texel_count) {
  uint first = work_item() * LANES;
  MapPoint point =
      map_point(map, faces, load_vec3(in + first, stride), load_vec3(in + 3 * stride + first, stride));
  store_lanes(out + first, map_lookup(map, faces, texels, *texel_count, point));
}

// in: position, normal, lift; out: as above, of a G-buffer's point. Its geometric normal is its normal.
__kernel void probe_receiver(__global const float* in, __global float* out, uint stride,
                             __global const ShadowMap* map, __global const ShadowFace* faces,
                             __global const ShadowTexel* texels, __global const uint* texel_count) {
  uint first = work_item() * LANES;
  vec3L normal = load_vec3(in + 3 * stride + first, stride);
  MapPoint point = receiver_point(map, faces, load_vec3(in + first, stride), normal, normal,
                                  load_lanes(in + 6 * stride + first));
  store_lanes(out + first, map_lookup(map, faces, texels, *texel_count, point));
}

// out: where the lookup goes: x, y, depth, its plane's steps of depth right and down, the face, 1 if inside,
// else 0.
__kernel void probe_point(__global const float* in, __global float* out, uint stride,
                          __global const ShadowMap* map, __global const ShadowFace* faces) {
  uint first = work_item() * LANES;
  MapPoint point =
      map_point(map, faces, load_vec3(in + first, stride), load_vec3(in + 3 * stride + first, stride));
  store_lanes(out + first, point.x);
  store_lanes(out + stride + first, point.y);
  store_lanes(out + 2 * stride + first, point.depth);
  store_lanes(out + 3 * stride + first, point.rise_x);
  store_lanes(out + 4 * stride + first, point.rise_y);
  store_lanes(out + 5 * stride + first, convert_floatL(point.face));
  store_lanes(out + 6 * stride + first, point.inside ? (floatL)(1.0f) : (floatL)(0.0f));
}
