// Where rays from a G-buffer's pixels start (light_rays.cl): at the points that beams have (beam_points.clh).
//
// In: planes of a G-buffer. Out: planes x y z of the start points. A work-item takes LANES pixels.
#include "exact/beam_points.clh"
#include "features.clh"
#include "lanes.clh"
#include "shared.h"

// position, normal: planes x y z; lift: a plane, metres, read with LIFT only. starts: planes x y z, in the
// tree's space, of all pixels. Those that show nothing are somewhere.
KERNEL void ray_starts(BeamFrame frame, __global const float* position, __global const float* normal,
                       __global const float* lift, __global float* starts) {
  uint at = work_item() * LANES, stride = frame.plane_stride;
  vec3L p = load_vec3(position + at, stride), n = load_vec3(normal + at, stride);
  p.z = p.z > -INFINITY ? p.z : (floatL)(-1.0f);
  vec3L start = start_points(&frame, p, n, LIFT ? load_lanes(lift + at) : (floatL)(0.0f));
  store_lanes(starts + at, start.x);
  store_lanes(starts + stride + at, start.y);
  store_lanes(starts + 2 * stride + at, start.z);
}
