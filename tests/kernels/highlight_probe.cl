#include "clusters/highlights.clh"
#include "clusters/light_clusters.clh"
#include "clusters/listed_highlights.clh"
#include "clusters/lobe_series.clh"
#include "clusters/lobes.clh"
#include "lanes.clh"
#include "shade/phong.clh"
#include "shared.h"

INLINE vec3L vector_of(__global const float* in, uint stride, uint i) {
  vec3L v = {(floatL)(in[i]), (floatL)(in[i + stride]), (floatL)(in[i + 2 * stride])};
  return v;
}

INLINE HighlightGroup group_of(__global const float* in, uint stride, uint i) {
  HighlightGroup group;
  for (uint axis = 0; axis < 3; ++axis) {
    group.place.middle[axis] = in[i + axis * stride];
    group.axis[axis] = in[i + (3 + axis) * stride];
    group.normal[axis] = group.place.normal[axis] = in[i + (6 + axis) * stride];
  }
  group.place.radius = in[i + 9 * stride];
  group.place.spread = in[i + 10 * stride];
  group.place.thickness = group.place.radius;
  group.place.gain = 1.0f;
  group.turn = in[i + 11 * stride];
  group.exponent = in[i + 12 * stride];
  group.model = (uint)in[i + 13 * stride];
  return group;
}

// in: a group's middle, axis, normal, radius, spread, turn, exponent and model; a pixel's position and axis.
// rows: a cluster for each case, or with of_lights a light. out: the series at the pixel, by channel; its
// bound and rounding; the largest cosine; the brightest lobe; k; 1 if all is below all horizons, 2 if it may
// join the series.
__kernel void probe_lobes(__global const float* in, __global float* out, uint stride,
                          __global const float* rows, __global const uint* of_lights) {
  uint first = work_item() * LANES, part = first % kClusterSlots / LANES;
  bool lights = *of_lights != 0;
  __global const float* row =
      rows + (size_t)(first / kClusterSlots) * ((lights ? kLightFields : kClusterFields) * kClusterSlots);
  for (uint lane = 0; lane < LANES; ++lane) {
    uint i = first + lane;
    HighlightGroup group = group_of(in, stride, i);
    ClusterView view;
    LobeView lobe;
    floatL brightest, error;
    LobeVerdict verdict =
        judge_lobes(row, part, lights, &group, (floatL)(INFINITY), &view, &lobe, &brightest, &error);
    LobeSums sums;
    start_lobes(&sums);
    if (has_lobe_series(&group))
      add_lobe_series(&sums, row, part, lights, &group, &view, &lobe, error, LANE_NUMBERS == (int)lane);
    count_lobe_row(&sums);
    Lobes lobes;
    finish_lobes(&sums, group.exponent, &lobes);
    vec3L position = vector_of(in + 14 * stride, stride, i), axis = vector_of(in + 17 * stride, stride, i);
    vec3L h = {position.x - group.place.middle[0], position.y - group.place.middle[1],
               position.z - group.place.middle[2]};
    vec3L w = {axis.x - group.axis[0], axis.y - group.axis[1], axis.z - group.axis[2]};
    LobeFactors factors = lobe_factors(h, w);
    for (uint c = 0; c < 3; ++c) {
      floatL value = lobes_value(lobes.term + c * kLobeTerms, &factors);
      out[i + c * stride] = ((const float*)&value)[lane];
    }
    out[i + 3 * stride] = lobes.term[kLobeBound];
    out[i + 4 * stride] = lobes.rounding;
    out[i + 5 * stride] = ((const float*)&lobe.cosine)[lane];
    out[i + 6 * stride] = ((const float*)&brightest)[lane];
    out[i + 7 * stride] = ((const float*)&view.k)[lane];
    out[i + 8 * stride] =
        (verdict.below >> lane & 1 ? 1.0f : 0.0f) + (verdict.series >> lane & 1 ? 2.0f : 0.0f);
  }
}

// in: a pixel's position, normal and eye, the exponent and the model. light_rows: a light for each case,
// which is listed so many times. out: its light, by channel; what is unsure of it, the rounding of its lobe,
// and the exponent's lobe_rounding().
__kernel void probe_listed_highlights(__global const float* in, __global float* out, uint stride,
                                      __global const float* light_rows, __global const uint* times) {
  uint first = work_item() * LANES;
  ClusterTree tree = {light_rows, light_rows, stride, 0};
  for (uint lane = 0; lane < LANES; ++lane) {
    uint i = first + lane;
    HighlightPixels pixels;
    pixels.position = vector_of(in, stride, i);
    pixels.normal = vector_of(in + 3 * stride, stride, i);
    pixels.eye = vector_of(in + 6 * stride, stride, i);
    pixels.mirrored_eye = mirror(pixels.eye, pixels.normal);
    pixels.n_dot_v = dot3(pixels.normal, pixels.eye);
    ClusterWalk walk;
    walk.lights = *times;
    for (uint light = 0; light < walk.lights; ++light) walk.light[light] = i;
    floatL none = 0.0f;
    vec3L dark = {none, none, none};
    HighlightSums sums = {{dark, dark}, none, none};
    float exponent = in[i + 9 * stride];
    uint model = (uint)in[i + 10 * stride];
    add_listed_highlights(&walk, &tree, &pixels, exponent, model, &sums);
    vec3L light = sum_of_blocks(&sums.light);
    floatL values[6] = {light.x,     light.y,       light.z,
                        sums.unsure, sums.rounding, (floatL)(lobe_rounding(exponent, model))};
    for (uint v = 0; v < 6; ++v) out[i + v * stride] = ((const float*)&values[v])[lane];
  }
}
