// Counts for each pixel the lights in whose range it lies, whichever way its surface faces and wherever a
// spot points. For statistics and the light_count layer: shading does not need it.
//
// In: position planes x y z (view space, metres), lights, and light lists that were culled by range alone
// (kByRange). Out: `counts`, a float for each pixel; 0 for background. A work-item takes a row of LANES
// pixels. It costs a squared distance for each light of the row's square.
#include "lanes.clh"
#include "shade/falloff.clh"
#include "shared.h"

// list_starts, list: see cull.cl.
KERNEL void count_in_range(__global const float* position, uint plane_stride,
                           __global const ShadeLight* lights, __global const uint* list_starts,
                           __global const ListEntry* list, __global float* counts) {
  uint first = work_item() * LANES;
  vec3L p = load_vec3(position + first, plane_stride);
  intL covered = p.z > -INFINITY;
  uint tile = first / kTilePixels;
  floatL sum = 0.0f;
  for (uint entry = list_starts[tile]; entry < list_starts[tile + 1]; ++entry) {
    if (!(list[entry].squares >> SQUARE_OF_PIXEL(first) & 1)) continue;
    __global const ShadeLight* light = lights + list[entry].light;
    floatL ratio2 = 0.0f;
    if (light->kind != kDirectionalLight) {
      floatL dx = light->position.x - p.x, dy = light->position.y - p.y, dz = light->position.z - p.z;
      ratio2 = SQUARED_LENGTH(dx, dy, dz) * light->position.w;
    }
    intL reached = covered & !(ratio2 >= 1.0f);
    sum += reached ? (floatL)(1.0f) : (floatL)(0.0f);
  }
  store_lanes(counts + first, sum);
}
