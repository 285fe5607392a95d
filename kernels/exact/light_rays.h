// What host and device share of rays from points to lights (light_rays.cl).
#ifndef LUCIOLE_LIGHT_RAYS_H
#define LUCIOLE_LIGHT_RAYS_H

#include "shared.h"

#ifdef __cplusplus
namespace luciole {
#endif

// A ray from a start point to a light, by their indices.
typedef struct {
  uint point, light;
} LightRay;

// Rays that a work-item traces, one after another: a multiple of 32, for it writes whole words.
enum { kRayRun = 256 };

// What light_rays() takes beside buffers.
typedef struct {
  float4 tree_most;  // xyz: the largest |x|, |y|, |z| in the tree
  int tree_root;     // TriangleTree::root
  uint rays;
  uint start_stride;  // floats from a plane of starts to the next
  uint pad;
} RayFrame;

// Host and device agree.
typedef char LightRay_size_check[sizeof(LightRay) == 8 ? 1 : -1];
typedef char RayFrame_size_check[sizeof(RayFrame) == 32 ? 1 : -1];

#ifdef __cplusplus
}  // namespace luciole
#endif
#endif
