// in: a group's middle, normal, radius, spread and thickness; a pixel's position and normal. rows: the
// clusters of the cases, kClusterSlots a row.
#include "clusters/cut_clusters.clh"
#include "clusters/light_clusters.clh"
#include "lanes.clh"
#include "math.clh"
#include "shared.h"

INLINE PixelGroup group_of(__global const float* in, uint stride, uint i) {
  PixelGroup group;
  for (uint axis = 0; axis < 3; ++axis) {
    group.middle[axis] = in[i + axis * stride];
    group.normal[axis] = in[i + (3 + axis) * stride];
  }
  group.radius = in[i + 6 * stride];
  group.spread = in[i + 7 * stride];
  group.thickness = in[i + 8 * stride];
  group.gain = 0.0f;
  return group;
}

INLINE vec3L vector_of(__global const float* in, uint stride, uint i) {
  vec3L v = {(floatL)(in[i]), (floatL)(in[i + stride]), (floatL)(in[i + 2 * stride])};
  return v;
}

INLINE vec3L from_middle(vec3L position, const PixelGroup* group) {
  vec3L h = {position.x - group->middle[0], position.y - group->middle[1], position.z - group->middle[2]};
  return h;
}

// out: the series of one cluster at the pixel, by channel; its bound, rounding and weight; 1 if the cluster
// is below all horizons, 2 if above, else 0.
__kernel void probe_far_cluster(__global const float* in, __global float* out, uint stride,
                                __global const float* rows) {
  uint first = work_item() * LANES, part = first % kClusterSlots / LANES;
  __global const float* row = rows + (size_t)(first / kClusterSlots) * (kClusterFields * kClusterSlots);
  for (uint lane = 0; lane < LANES; ++lane) {
    uint i = first + lane;
    PixelGroup group = group_of(in, stride, i);
    ClusterView view = view_clusters(row, part, &group);
    floatL error;
    RowVerdict verdict = judge_clusters(row, part, &group, 1.0f, 0, &view, &error);
    floatL weight = series_weight(row_field(row, part, kClusterAbsolute), view.inverse_d, view.k);
    intL it = LANE_NUMBERS == (int)lane;
    floatL none = 0.0f, one = 1.0f;
    vec3L direction = {it ? view.direction.x : none, it ? view.direction.y : none,
                       it ? view.direction.z : none};
    FieldSums sums;
    start_field(&sums);
    add_clusters(&sums, row, part, direction, it ? view.inverse_d : none, it ? one : none, it ? error : none,
                 it ? weight : none);
    count_field_row(&sums);
    Field field;
    finish_field(&sums, &field);
    FieldFactors factors = field_factors(vector_of(in + 12 * stride, stride, i),
                                         from_middle(vector_of(in + 9 * stride, stride, i), &group));
    for (uint c = 0; c < 3; ++c) {
      floatL value = field_value(field.term + c * kFieldTerms, &factors);
      out[i + c * stride] = ((const float*)&value)[lane];
    }
    out[i + 3 * stride] = field.term[kFieldBound];
    out[i + 4 * stride] = field.rounding;
    out[i + 5 * stride] = field.term[kFieldWeight];
    out[i + 6 * stride] =
        (verdict.below >> lane & 1 ? 1.0f : 0.0f) + (verdict.above >> lane & 1 ? 2.0f : 0.0f);
  }
}

// The same of lights: of an open leaf the one that is `light_rows`'. The last is 0 where it is listed.
__kernel void probe_far_light(__global const float* in, __global float* out, uint stride,
                              __global const float* light_rows) {
  uint first = work_item() * LANES;
  ClusterTree tree = {light_rows, light_rows, stride, 0};
  for (uint lane = 0; lane < LANES; ++lane) {
    uint i = first + lane;
    PixelGroup group = group_of(in, stride, i);
    ClusterWalk walk;
    walk.lights = 0;
    FieldSums sums;
    start_field(&sums);
    visit_lights(&tree, i / kClusterSlots, 1u << i % kClusterSlots, &group, 1.0f, &walk, &sums);
    bool joined = sums.open > 0;
    Field field;
    finish_field(&sums, &field);
    FieldFactors factors = field_factors(vector_of(in + 12 * stride, stride, i),
                                         from_middle(vector_of(in + 9 * stride, stride, i), &group));
    for (uint c = 0; c < 3; ++c) {
      floatL value = field_value(field.term + c * kFieldTerms, &factors);
      out[i + c * stride] = ((const float*)&value)[lane];
    }
    out[i + 3 * stride] = field.term[kFieldBound];
    out[i + 4 * stride] = field.rounding;
    out[i + 5 * stride] = field.term[kFieldWeight];
    out[i + 6 * stride] = joined ? 2.0f : walk.lights > 0 ? 0.0f : 1.0f;
  }
}

// out: the same but for the last, of the sum of all clusters of `row_count` rows.
__kernel void probe_field_sums(__global const float* in, __global float* out, uint stride,
                               __global const float* rows, __global const uint* row_count) {
  uint first = work_item() * LANES;
  PixelGroup group = group_of(in, stride, first);
  FieldSums sums;
  start_field(&sums);
  for (uint i = 0; i < *row_count; ++i) {
    __global const float* row = rows + (size_t)i * (kClusterFields * kClusterSlots);
    for (uint part = 0; part < SLOT_PARTS; ++part) {
      ClusterView view = view_clusters(row, part, &group);
      floatL error;
      judge_clusters(row, part, &group, 1.0f, 0, &view, &error);
      add_clusters(&sums, row, part, view.direction, view.inverse_d, (floatL)(1.0f), error,
                   series_weight(row_field(row, part, kClusterAbsolute), view.inverse_d, view.k));
    }
    count_field_row(&sums);
  }
  Field field;
  finish_field(&sums, &field);
  FieldFactors factors = field_factors(vector_of(in + 12 * stride, stride, first),
                                       from_middle(vector_of(in + 9 * stride, stride, first), &group));
  for (uint c = 0; c < 3; ++c)
    store_lanes(out + first + c * stride, field_value(field.term + c * kFieldTerms, &factors));
  store_lanes(out + first + 3 * stride, (floatL)(field.term[kFieldBound]));
  store_lanes(out + first + 4 * stride, (floatL)(field.rounding));
  store_lanes(out + first + 5 * stride, (floatL)(field.term[kFieldWeight]));
}

// out: the middle, and half the width, of what a cluster that the pixel's horizon cuts adds to its light, by
// channel.
__kernel void probe_cut_cluster(__global const float* in, __global float* out, uint stride,
                                __global const float* rows) {
  uint first = work_item() * LANES;
  for (uint lane = 0; lane < LANES; ++lane) {
    uint i = first + lane;
    floatL none = 0.0f;
    vec3L dark = {none, none, none};
    Interval sum = {dark, dark};
    add_cut_cluster(rows + (size_t)(i / kClusterSlots) * (kClusterFields * kClusterSlots) + i % kClusterSlots,
                    vector_of(in + 9 * stride, stride, i), vector_of(in + 12 * stride, stride, i), &sum);
    floatL low[3] = {sum.low.x, sum.low.y, sum.low.z}, high[3] = {sum.high.x, sum.high.y, sum.high.z};
    floatL values[6];
    for (uint c = 0; c < 3; ++c) {
      values[c] = 0.5f * (low[c] + high[c]);
      values[3 + c] = high[c] - values[c];
    }
    for (uint v = 0; v < 6; ++v) out[i + v * stride] = ((const float*)&values[v])[lane];
  }
}
