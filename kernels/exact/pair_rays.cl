// The pairs of a pixel and a light about which beams leave open how much of the light reaches the pixel: by
// rays to samples of the light (sample_rays.clh).
//
// In: the words of beam_shadows.cl, and what it reads. Out: the share of each of their pairs, and where each
// word's shares begin. Where only textures can tell the host decides, and on a device without doubles, which
// can't place samples, always. A work-item takes a tile.
#include "exact/beam_points.clh"
#include "exact/light_samples.h"
#include "exact/sample_rays.clh"
#include "features.clh"
#include "lanes.clh"
#include "quotient.clh"
#include "shared.h"

// The buffers of a G-buffer, its lights and its pairs: see pair_rays().
typedef struct {
  __global const float *position, *normal, *lift;
  __global const BeamLight* lights;
  __global const float* quarter_cosines;
  __global const uint* list_starts;
  __global const ListEntry* list;
  __global const uint *unsure, *first_pair;
  __global uint* first_share;
  __global float* shares;
  __global uint* open;
} PairBuffers;

INLINE float4 start_of_pixel(const BeamFrame* frame, const PairBuffers* buffers, uint pixel) {
  uint lane = pixel % LANES, at = pixel - lane, stride = frame->plane_stride;
  vec3L p = load_vec3(buffers->position + at, stride), n = load_vec3(buffers->normal + at, stride);
  vec3L s = start_points(frame, p, n, LIFT ? load_lanes(buffers->lift + at) : (floatL)(0.0f));
  return (float4)(((const float*)&s.x)[lane], ((const float*)&s.y)[lane], ((const float*)&s.z)[lane], 0.0f);
}

// The share of a light that reaches the start of `rays`; OPEN_SHARE where the host decides.
INLINE float seen_share(const RayScene* scene, const PairBuffers* buffers, const BeamLight* light,
                        uint samples, SampleRays* rays, uint* likely) {
#ifdef SAMPLE_DOUBLES
  // A light without a size is left open by a texture.
  if (light->size == 0.0f) return OPEN_SHARE;
  LightCone cone;
  if (!see_light(light, rays->start, &cone)) return 1.0f;
  rays->parallel = cone.parallel;
  rays->count = samples;
  rays->rows = (samples + kTreeWidth - 1) / kTreeWidth;
  uint first = first_of_pattern(rays->start, light->number, samples);
  for (uint row = 0; row < rays->rows; ++row) {
    uint from = row * kTreeWidth, count = min(samples - from, (uint)kTreeWidth);
    float share[kTreeWidth], cosine[kTreeWidth], sine[kTreeWidth], at[kTreeWidth][3];
    for (uint i = 0; i < count; ++i) {
      LightSample sample = light_sample(first + from + i, buffers->quarter_cosines);
      share[i] = sample.share;
      cosine[i] = sample.cosine;
      sine[i] = sample.sine;
    }
    // Apart, for a processor to do several at once.
    for (uint i = 0; i < count; ++i) place_sample(&cone, share[i], cosine[i], sine[i], at[i]);
    for (uint i = 0; i < kTreeWidth; ++i)
      UNROLLED(axis, 3) rays->place[axis][from + i] = i < count ? at[i][axis] : rays->place[axis][0];
  }
  aim_samples(rays);
  trace_samples(scene, rays, likely);
  for (uint row = 0; HOLES && row < rays->rows; ++row)
    if (rays->open[row] & rays->unblocked[row]) return OPEN_SHARE;
  return quotient((float)rays->left, (float)samples);
#else
  return OPEN_SHARE;
#endif
}

WORK void trace_tile(uint tile, const BeamFrame* frame, const RayScene* scene, const PairBuffers* buffers,
                     uint samples) {
  uint entry = LIGHT_LISTS ? buffers->list_starts[tile] : tile * frame->light_count;
  uint end = LIGHT_LISTS ? buffers->list_starts[tile + 1] : entry + frame->light_count;
  uint share = buffers->first_pair[tile], likely = NO_BLOCK, open = 0;
  SampleRays rays;
  rays.tree_most = frame->tree_most;
  for (; entry < end; ++entry) {
    BeamLight light =
        buffers->lights[LIGHT_LISTS ? buffers->list[entry].light : entry - tile * frame->light_count];
    for (uint word = 0; word < kPairWords; ++word) {
      uint at = entry * kPairWords + word;
      buffers->first_share[at] = share;
      for (uint left = buffers->unsure[at]; left; left &= left - 1, ++share) {
        rays.start = start_of_pixel(frame, buffers, tile * kTilePixels + word * 32 + lowest_bit(left));
        float seen = seen_share(scene, buffers, &light, samples, &rays, &likely);
        buffers->shares[share] = seen;
        open += seen == OPEN_SHARE;
      }
    }
  }
  buffers->open[tile] = open;
}

// position … first_hole_triangle, unsure: see beam_shadows(). samples: of a light.
// quarter_cosines: see light_sample(). first_pair: of each tile, the index of its first share.
// - first_share: for each word of `unsure` the index of its first bit's share.
// - shares: in [0, 1], or OPEN_SHARE.
// - open: of each tile, how many of its shares are OPEN_SHARE.
KERNEL void pair_rays(BeamFrame frame, uint samples, __global const float* position,
                      __global const float* normal, __global const float* lift,
                      __global const BeamLight* lights, __global const uint* list_starts,
                      __global const ListEntry* list, __global const float* nodes,
                      __global const int* children, __global const float* blocks,
                      __global const uint* block_bits, __global const uchar* hole_texels,
                      __global const HoleTriangle* hole_triangles, __global const uint* first_hole_triangle,
                      __global const float* quarter_cosines, __global const uint* unsure,
                      __global const uint* first_pair, __global uint* first_share, __global float* shares,
                      __global uint* open) {
  HoleMasks masks = {hole_texels, hole_triangles, first_hole_triangle};
  RayScene scene = {nodes, children, blocks, block_bits, masks, frame.tree_root, 0.0f};
  PairBuffers buffers = {position, normal, lift,       lights,      quarter_cosines, list_starts,
                         list,     unsure, first_pair, first_share, shares,          open};
  trace_tile(work_item(), &frame, &scene, &buffers, samples);
}
