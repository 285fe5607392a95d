// The light of point lights without range. Clusters stand for lights that are far enough away. With each
// pixel's light comes a bound of its error.
//
// A work-item takes a run of tiles. The pixels of a tile that are near each other and face about the same way
// are a group:
//
//   take_pixels → light_group:      walk_clusters (light_clusters.clh)
//                                   → for each row: add_listed, then the far field (far_field.clh)
//               → highlight_group:  walk_highlights (highlights.clh)
//                                   → for each row: add_listed_highlights, then the series (lobe_series.clh)
//
// A group whose bound is above what is allowed, light_error·max(least_value, colour), is lit again with
// smaller errors of each cluster. What was accepted steers the groups after it in the run. So a pixel's light
// is a function of its run alone.
#include "clusters/cut_clusters.clh"
#include "clusters/far_field.clh"
#include "clusters/highlights.clh"
#include "clusters/light_clusters.clh"
#include "clusters/listed_highlights.clh"
#include "clusters/lobe_series.clh"
#include "clusters/lobes.clh"
#include "features.clh"
#include "lanes.clh"
#include "long_sum.clh"
#include "math.clh"
#include "quotient.clh"
#include "shade/fog.clh"
#include "shared.h"

enum { kTileRows = kTilePixels / LANES, kMostTries = 12 };

// A light's rounding, in units of 2⁻²⁴. Of its light: 6 of 1/d, 3 of a normal's length, 13 of the falloff, 10
// of colour, place and products. And of its colour over d², however small the cosine is: 4 of the difference
// and of the dot product.
#define LIGHT_ROUNDING 32
#define COSINE_ROUNDING 5

// Pixels of a group lie this share of the first one's distance from the eye around it, and their normals this
// near to its own.
#define GROUP_RADIUS 0.03f
#define GROUP_SPREAD 0.12f
// So many pixels of a group, which follow each other in Z order, share the series of highlights.
enum { kHighlightPixels = 64 };
// Stands for a bound that no float holds.
#define LARGEST_BOUND 3e38f
// The largest share of the allowed error that is accepted of one cluster.
#define MOST_SHARE 0.0625f
// The share of the allowed error that the diffuse light of pixels with highlights may take. The highlights
// may take the rest.
#define DIFFUSE_SHARE 0.5f

// The planes of a G-buffer that are read, x y z or r g b each, from a tile's first pixel on. specular: r g b
// and the exponent.
typedef struct {
  __global const float *position, *normal, *diffuse, *specular;
  uint stride;
} Tile;

// A channel's bound shall be error·max(least_value, its light) at most.
typedef struct {
  float error, least_value;
} AllowedError;

// What all tiles share.
typedef struct {
  ShadeFrame frame;
  ClusterTree diffuse, specular;
  AllowedError allowed;
} Scene;

// The share of the allowed error that is accepted of a cluster.
typedef struct {
  float diffuse, specular;
} Shares;

// What a tile's statistics count, see ClusteredLightCounts.
typedef struct {
  uint far_clusters, clusters, lights, redone;
} Counts;

// The pixels of a group, in rows of LANES. The last row is filled up with its first pixel. All have the same
// exponent.
enum {
  kPosition = 0,
  kNormal = 3,
  kDiffuse = 6,
  kSpecular = 9,
  kPixelValues = CLUSTERED_HIGHLIGHTS ? 12 : 9
};
typedef struct {
  uint count;
  uint place[kTilePixels];  // in the tile
  float exponent;
  bool redone;  // whether all were lit again
  float value[kPixelValues][kTilePixels] ALIGNED;
} GroupPixels;

INLINE floatL pixel_values(const GroupPixels* pixels, uint value, uint first) {
  return *(const floatL*)(pixels->value[value] + first);
}
INLINE vec3L pixel_vector(const GroupPixels* pixels, uint value, uint first) {
  vec3L v = {pixel_values(pixels, value, first), pixel_values(pixels, value + 1, first),
             pixel_values(pixels, value + 2, first)};
  return v;
}

// Takes a group from the pixels of a tile that are left, at least one.
INLINE void take_pixels(const Tile* tile, intL* left, GroupPixels* pixels) {
  // Choose the first pixel that is left as the group's seed.
  uint seed = 0;
  while (!any_lane(left[seed])) ++seed;
  seed = seed * LANES + lowest_bit(lane_bits(left[seed]));
  __global const float *p = tile->position + seed, *n = tile->normal + seed;
  float4 place = {p[0], p[tile->stride], p[2 * tile->stride], 0.0f},
         facing = {n[0], n[tile->stride], n[2 * tile->stride], 0.0f};
  float reach2 = GROUP_RADIUS * GROUP_RADIUS * (place.x * place.x + place.y * place.y + place.z * place.z);
  // Collect those near it that face about the same way and have the same exponent.
  pixels->count = 0;
  pixels->redone = false;
  pixels->exponent = CLUSTERED_HIGHLIGHTS ? tile->specular[seed + 3 * tile->stride] : 0.0f;
  for (uint row = 0; row < kTileRows; ++row) {
    if (!any_lane(left[row])) continue;
    vec3L position = load_vec3(tile->position + row * LANES, tile->stride),
          normal = load_vec3(tile->normal + row * LANES, tile->stride);
    vec3L from = {position.x - place.x, position.y - place.y, position.z - place.z};
    vec3L turn = {normal.x - facing.x, normal.y - facing.y, normal.z - facing.z};
    intL is_near = dot3(from, from) <= reach2, faces_alike = dot3(turn, turn) <= GROUP_SPREAD * GROUP_SPREAD;
    intL is_seed = LANE_NUMBERS + (int)(row * LANES) == (int)seed;
    intL member = left[row] & ((is_near & faces_alike) | is_seed);
    if (CLUSTERED_HIGHLIGHTS)
      member &= (load_lanes(tile->specular + row * LANES + 3 * tile->stride) == (floatL)(pixels->exponent)) |
                is_seed;
    left[row] &= ~member;
    for (uint bits = lane_bits(member); bits; bits &= bits - 1) {
      uint at = row * LANES + lowest_bit(bits);
      pixels->place[pixels->count] = at;
      for (uint axis = 0; axis < 3; ++axis) {
        pixels->value[kPosition + axis][pixels->count] = tile->position[at + axis * tile->stride];
        pixels->value[kNormal + axis][pixels->count] = tile->normal[at + axis * tile->stride];
        pixels->value[kDiffuse + axis][pixels->count] = tile->diffuse[at + axis * tile->stride];
        if (CLUSTERED_HIGHLIGHTS)
          pixels->value[kSpecular + axis][pixels->count] = tile->specular[at + axis * tile->stride];
      }
      ++pixels->count;
    }
  }
  // Fill up the last row.
  for (uint i = pixels->count; i % LANES > 0; ++i)
    for (uint value = 0; value < kPixelValues; ++value)
      pixels->value[value][i] = pixels->value[value][i / LANES * LANES];
}

// What bounds the pixels from `first` to `end` of a group. colors: kDiffuse or kSpecular.
INLINE PixelGroup bound_group(const GroupPixels* pixels, uint first, uint end, uint colors,
                              AllowedError allowed) {
  // Find the middle of the boxes around places and normals.
  PixelGroup group;
  for (uint axis = 0; axis < 6; ++axis) {
    float low = INFINITY, high = -INFINITY;
    for (uint i = first; i < end; i += LANES) {
      low = lesser(low, least_lane(pixel_values(pixels, axis, i)));
      high = greater(high, greatest_lane(pixel_values(pixels, axis, i)));
    }
    float middle = 0.5f * low + 0.5f * high;
    if (axis < 3)
      group.middle[axis] = middle;
    else
      group.normal[axis - 3] = middle;
  }
  // Find how far places and normals are from there.
  float radius2 = 0.0f, spread2 = 0.0f, thickness = 0.0f, brightest = 0.0f;
  for (uint i = first; i < end; i += LANES) {
    vec3L position = pixel_vector(pixels, kPosition, i), normal = pixel_vector(pixels, kNormal, i),
          color = pixel_vector(pixels, colors, i);
    vec3L from = {position.x - group.middle[0], position.y - group.middle[1], position.z - group.middle[2]};
    vec3L turn = {normal.x - group.normal[0], normal.y - group.normal[1], normal.z - group.normal[2]};
    radius2 = greater(radius2, greatest_lane(dot3(from, from)));
    spread2 = greater(spread2, greatest_lane(dot3(turn, turn)));
    thickness = greater(thickness, greatest_lane(abs_lanes(dot3(from, normal))));
    brightest = greater(brightest, greatest_lane(max_lanes(color.x, max_lanes(color.y, color.z))));
  }
  // More than the rounding of each.
  group.radius = 1.00001f * square_root(radius2);
  group.spread = 1.00001f * square_root(spread2);
  group.thickness = thickness + 0x1p-20f * group.radius;
  group.gain = quotient(brightest, allowed.error);
  return group;
}

// Whether any of a group's pixels has a specular colour.
INLINE bool any_specular(const GroupPixels* pixels) {
  floatL most = 0.0f;
  for (uint i = 0; i < pixels->count; i += LANES)
    for (uint c = 0; c < 3; ++c) most = max_lanes(most, pixel_values(pixels, kSpecular + c, i));
  return greatest_lane(most) > 0.0f;
}

// The light that a row of pixels gets from what it sums one by one.
typedef struct {
  Interval cut;
  LongSum lights;
  vec3L weight;  // sum of the lights' colours over d²
} RowSums;

// Adds the lights of a walk's list to a row of pixels.
INLINE void add_listed_lights(const ClusterWalk* walk, const ClusterTree* tree, vec3L position, vec3L normal,
                              RowSums* sums) {
  for (uint from = 0; from < walk->lights; from += kSumTerms) {
    uint end = min(from + kSumTerms, walk->lights);
    vec3L block = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
    vec3L block_weight = block;
    for (uint i = from; i < end; ++i) {
      ClusteredLight light = clustered_light_of(tree, walk->light[i]);
      vec3L u = to_clustered_light(&light, position);
      floatL inverse_d = rsqrt_lanes(dot3(u, u));
      floatL cosine = max_lanes(dot3(normal, u) * inverse_d, (floatL)(0.0f));
      floatL falloff = min_lanes(inverse_d * inverse_d, (floatL)(light.falloff));
      add_scaled(&block, light.color, cosine * falloff);
      add_scaled(&block_weight, light.color, falloff);
    }
    add_block(&sums->lights, block);
    add_vectors(&sums->weight, block_weight);
  }
}

INLINE void add_listed(const ClusterWalk* walk, const GroupPixels* pixels, const ClusterTree* tree,
                       RowSums* sums) {
  for (uint i = 0; i < pixels->count; i += LANES) {
    vec3L position = pixel_vector(pixels, 0, i), normal = pixel_vector(pixels, 3, i);
    RowSums row = sums[i / LANES];
    add_listed_lights(walk, tree, position, normal, &row);
    for (uint k = 0; k < walk->clusters; ++k) {
      uint cluster = walk->cluster[k];
      add_cut_cluster(tree->rows + (size_t)(cluster / kClusterSlots) * (kClusterFields * kClusterSlots) +
                          cluster % kClusterSlots,
                      position, normal, &row.cut);
    }
    sums[i / LANES] = row;
  }
}

INLINE floatL share_of(floatL light, floatL bound, AllowedError allowed) {
  floatL share = quotient_lanes(bound, allowed.error * max_lanes(light, (floatL)(allowed.least_value)));
  return share <= 1e30f ? share : (floatL)(1e30f);
}

// Writes the diffuse light and its bound of a group's pixels to `out`, six planes of a tile. cuts: how many
// clusters were summed. Returns the largest share that a bound has of the error that is allowed.
INLINE float finish_group(const GroupPixels* pixels, FieldSums* sums, const PixelGroup* group,
                          const RowSums* row_sums, uint cuts, AllowedError allowed,
                          float out[6][kTilePixels]) {
  // Add up the series, and count the rounding of lights and of cut clusters.
  Field field;
  finish_field(sums, &field);
  float of_lights = 0x1p-24f * (float)(LIGHT_ROUNDING + kSumTerms + 4),
        of_clusters = 0x1p-24f * (float)(64 + cuts);
  float worst = 0.0f;
  for (uint i = 0; i < pixels->count; i += LANES) {
    vec3L position = pixel_vector(pixels, kPosition, i), normal = pixel_vector(pixels, kNormal, i),
          color = pixel_vector(pixels, kDiffuse, i);
    vec3L h = {position.x - group->middle[0], position.y - group->middle[1], position.z - group->middle[2]};
    // Sum series, cut clusters and lights, and their bounds, for each channel.
    FieldFactors factors = field_factors(normal, h);
    const RowSums* row = row_sums + i / LANES;
    vec3L of_row = sum_of_blocks(&row->lights);
    floatL lights[3] = {of_row.x, of_row.y, of_row.z},
           weight[3] = {row->weight.x, row->weight.y, row->weight.z}, albedo[3] = {color.x, color.y, color.z};
    floatL low[3] = {row->cut.low.x, row->cut.low.y, row->cut.low.z};
    floatL high[3] = {row->cut.high.x, row->cut.high.y, row->cut.high.z};
    floatL light[3], bound[3];
    for (uint c = 0; c < 3; ++c) {
      floatL cut = 0.5f * (low[c] + high[c]);
      light[c] = albedo[c] * (field_value(field.term + c * kFieldTerms, &factors) + cut + lights[c]);
      bound[c] = field.term[kFieldBound] + field.rounding + (high[c] - cut) + of_clusters * high[c] +
                 of_lights * lights[c] + COSINE_ROUNDING * 0x1p-24f * weight[c];
      // The factor is more than the rounding of sums of so many bounds. Colours, products and the sum of the
      // parts are rounded, too.
      bound[c] = fma_lanes((floatL)(0x1p-21f), light[c], 1.001f * albedo[c] * bound[c]);
      worst = greater(worst, greatest_lane(share_of(light[c], bound[c], allowed)));
    }
    for (uint lane = 0; lane < LANES && i + lane < pixels->count; ++lane)
      for (uint c = 0; c < 3; ++c) {
        out[c][pixels->place[i + lane]] = ((const float*)&light[c])[lane];
        out[3 + c][pixels->place[i + lane]] = ((const float*)&bound[c])[lane];
      }
  }
  return worst;
}

// The share for the next try or group. worst: the largest share that a bound had of the allowed error. Bounds
// grow somewhat slower than the share. A step is ⅛ at least and 4 at most, so that a group that needs a tiny
// share, being nearly dark, doesn't cost the next one all its tries.
INLINE float next_share(float share, float worst) {
  return lesser(share * lesser(greater(quotient(0.7f, worst), 0.125f), 4.0f), MOST_SHARE);
}

// Sets the diffuse light of a group's pixels in `out`.
INLINE void light_group(GroupPixels* pixels, const ClusterTree* tree, AllowedError allowed, float* share,
                        float out[6][kTilePixels], Counts* counts) {
  PixelGroup group = bound_group(pixels, 0, pixels->count, kDiffuse, allowed);
  if (!(group.gain > 0.0f)) return;
  for (uint tries = 1;; ++tries) {
    ClusterWalk walk;
    FieldSums sums;
    RowSums row_sums[kTileRows];
    vec3L dark = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
    for (uint row = 0; row < kTileRows; ++row) {
      row_sums[row].cut.low = row_sums[row].cut.high = row_sums[row].lights.total =
          row_sums[row].lights.lost = dark;
      row_sums[row].weight = dark;
    }
    start_field(&sums);
    // Walk the tree, and sum what the walk lists whenever its lists are full.
    start_cluster_walk(tree, &walk);
    uint cuts = 0;
    for (bool done = false; !done;) {
      done = walk_clusters(tree, &group, tries == kMostTries ? 0.0f : *share, &walk, &sums);
      add_listed(&walk, pixels, tree, row_sums);
      cuts += walk.clusters;
      counts->lights += walk.lights * pixels->count;
      counts->clusters += walk.clusters * pixels->count;
      walk.lights = walk.clusters = 0;
    }
    counts->far_clusters += walk.far_clusters;
    // Accept the light, or try again with a smaller share.
    float worst = finish_group(pixels, &sums, &group, row_sums, cuts, allowed, out);
    *share = next_share(*share, worst);
    if (worst <= 1.0f || tries == kMostTries) return;
    pixels->redone = true;
  }
}

// The axes of a row of a group's pixels.
INLINE HighlightPixels highlight_pixels(const GroupPixels* pixels, uint first, const ShadeFrame* frame) {
  HighlightPixels row;
  row.position = pixel_vector(pixels, kPosition, first);
  row.normal = pixel_vector(pixels, kNormal, first);
  row.eye = to_eye(frame, row.position);
  row.mirrored_eye = mirror(row.eye, row.normal);
  row.n_dot_v = dot3(row.normal, row.eye);
  return row;
}

// What the lobes turn about: Phong's by the mirrored eye, Blinn's by the eye.
INLINE vec3L lobe_axis(const HighlightPixels* row, uint model) {
  return MODEL_IS(kBlinnPhongModel) ? row->eye : row->mirrored_eye;
}

// What bounds the highlights of the pixels from `first` to `end` of a group.
INLINE HighlightGroup bound_highlights(const GroupPixels* pixels, uint first, uint end,
                                       const ShadeFrame* frame, AllowedError allowed) {
  // Bound places and normals.
  HighlightGroup group;
  group.place = bound_group(pixels, first, end, kSpecular, allowed);
  group.exponent = pixels->exponent;
  group.model = frame->model;
  // Find the middle of the axes.
  float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (uint i = first; i < end; i += LANES) {
    HighlightPixels row = highlight_pixels(pixels, i, frame);
    vec3L axis = lobe_axis(&row, group.model);
    floatL value[3] = {axis.x, axis.y, axis.z};
    for (uint c = 0; c < 3; ++c) {
      low[c] = lesser(low[c], least_lane(value[c]));
      high[c] = greater(high[c], greatest_lane(value[c]));
    }
  }
  vec3L middle = {(floatL)(0.5f * (low[0] + high[0])), (floatL)(0.5f * (low[1] + high[1])),
                  (floatL)(0.5f * (low[2] + high[2]))};
  vec3L normal = {(floatL)(group.place.normal[0]), (floatL)(group.place.normal[1]),
                  (floatL)(group.place.normal[2])};
  middle = normalize_lanes(middle);
  normal = normalize_lanes(normal);
  floatL axis[3] = {middle.x, middle.y, middle.z}, facing[3] = {normal.x, normal.y, normal.z};
  for (uint c = 0; c < 3; ++c) {
    group.axis[c] = ((const float*)&axis[c])[0];
    group.normal[c] = ((const float*)&facing[c])[0];
  }
  // Find how far axes turn from there.
  float turn2 = 0.0f;
  for (uint i = first; i < end; i += LANES) {
    HighlightPixels row = highlight_pixels(pixels, i, frame);
    vec3L of_row = lobe_axis(&row, group.model);
    vec3L turned = {of_row.x - group.axis[0], of_row.y - group.axis[1], of_row.z - group.axis[2]};
    turn2 = greater(turn2, greatest_lane(dot3(turned, turned)));
  }
  // More than the rounding of axes.
  group.turn = 1.00001f * square_root(turn2) + 0x1p-19f;
  return group;
}

// Computes the highlights of a group's pixels from `first` to `end` and their bounds, planes of light and
// bound. had: the diffuse light and its bound. Returns the largest share that both bounds together have of
// the error that is allowed.
INLINE float finish_highlights(const GroupPixels* pixels, uint first, uint end, const ShadeFrame* frame,
                               LobeSums* sums, const HighlightGroup* group, const HighlightSums* row_sums,
                               AllowedError allowed, float diffuse_light[6][kTilePixels],
                               float result[6][kHighlightPixels]) {
  // Add up the series, and count the rounding of lights.
  Lobes lobes;
  finish_lobes(sums, group->exponent, &lobes);
  float of_lights = 0x1p-24f * (float)(LIGHT_ROUNDING + kSumTerms + 4);
  float worst = 0.0f;
  for (uint i = first; i < end; i += LANES) {
    HighlightPixels row = highlight_pixels(pixels, i, frame);
    vec3L color = pixel_vector(pixels, kSpecular, i);
    vec3L h = {row.position.x - group->place.middle[0], row.position.y - group->place.middle[1],
               row.position.z - group->place.middle[2]};
    vec3L w = {row.mirrored_eye.x - group->axis[0], row.mirrored_eye.y - group->axis[1],
               row.mirrored_eye.z - group->axis[2]};
    // Sum series and lights, and their bounds, and add both to the diffuse light's.
    LobeFactors factors = lobe_factors(h, w);
    const HighlightSums* of_row = row_sums + (i - first) / LANES;
    vec3L listed = sum_of_blocks(&of_row->light);
    floatL lights[3] = {listed.x, listed.y, listed.z}, specular[3] = {color.x, color.y, color.z};
    for (uint c = 0; c < 3; ++c) {
      floatL light = specular[c] * (lobes_value(lobes.term + c * kLobeTerms, &factors) + lights[c]);
      floatL bound =
          lobes.term[kLobeBound] + lobes.rounding + of_lights * lights[c] + of_row->unsure + of_row->rounding;
      bound = fma_lanes((floatL)(0x1p-21f), light, 1.001f * specular[c] * bound);
      for (uint lane = 0; lane < LANES && i + lane < end; ++lane) {
        uint place = pixels->place[i + lane];
        float of_light = ((const float*)&light)[lane], of_bound = ((const float*)&bound)[lane];
        // Their sum is rounded, too.
        float all = diffuse_light[c][place] + of_light,
              bound_of_all = 1.00001f * (diffuse_light[3 + c][place] + of_bound + 0x1p-24f * all);
        result[c][i + lane - first] = all;
        result[3 + c][i + lane - first] = bound_of_all;
        float share = quotient(bound_of_all, allowed.error * greater(all, allowed.least_value));
        worst = greater(worst, share <= 1e30f ? share : 1e30f);
      }
    }
  }
  return worst;
}

// Adds the highlights of a group's pixels from `first` to `end` to `out`.
INLINE void highlight_group(const GroupPixels* pixels, uint first, uint end, const ShadeFrame* frame,
                            const ClusterTree* tree, AllowedError allowed, float* share,
                            float out[6][kTilePixels], Counts* counts) {
  HighlightGroup group = bound_highlights(pixels, first, end, frame, allowed);
  if (!(group.place.gain > 0.0f)) return;
  float result[6][kHighlightPixels];
  for (uint tries = 1;; ++tries) {
    ClusterWalk walk;
    LobeSums sums;
    HighlightSums row_sums[kHighlightPixels / LANES];
    vec3L dark = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
    for (uint row = 0; row < kHighlightPixels / LANES; ++row) {
      row_sums[row].light.total = row_sums[row].light.lost = dark;
      row_sums[row].unsure = row_sums[row].rounding = 0.0f;
    }
    start_lobes(&sums);
    // Walk the tree, and sum what the walk lists whenever its lists are full.
    start_cluster_walk(tree, &walk);
    for (bool done = false; !done;) {
      done = walk_highlights(tree, &group, tries == kMostTries ? 0.0f : *share, &walk, &sums);
      for (uint i = first; i < end; i += LANES) {
        HighlightPixels row = highlight_pixels(pixels, i, frame);
        HighlightSums lit = row_sums[(i - first) / LANES];
        add_listed_highlights(&walk, tree, &row, group.exponent, group.model, &lit);
        row_sums[(i - first) / LANES] = lit;
      }
      counts->lights += walk.lights * (end - first);
      walk.lights = 0;
    }
    counts->far_clusters += walk.far_clusters;
    // Accept the light, or try again with a smaller share.
    float worst = finish_highlights(pixels, first, end, frame, &sums, &group, row_sums, allowed, out, result);
    *share = next_share(*share, worst);
    if (worst <= 1.0f || tries == kMostTries) break;
    if (!pixels->redone && tries == 1) counts->redone += end - first;
  }
  for (uint i = first; i < end; ++i)
    for (uint plane = 0; plane < 6; ++plane) out[plane][pixels->place[i]] = result[plane][i - first];
}

// Lights a tile. shares: updated by what was accepted.
INLINE void light_tile(const Tile* tile, const Scene* scene, Shares* shares, __global float* light,
                       __global float* bound, __global uint* counts) {
  // Find the pixels that reflect anything, and set their light to 0.
  float out[6][kTilePixels] ALIGNED;
  intL left[kTileRows], any_left = 0;
  for (uint row = 0; row < kTileRows; ++row) {
    // Black pixels stay as they are.
    vec3L color = load_vec3(tile->diffuse + row * LANES, tile->stride);
    floatL most = max_lanes(color.x, max_lanes(color.y, color.z));
    if (CLUSTERED_HIGHLIGHTS) {
      vec3L specular = load_vec3(tile->specular + row * LANES, tile->stride);
      most = max_lanes(most, max_lanes(specular.x, max_lanes(specular.y, specular.z)));
    }
    left[row] = (load_lanes(tile->position + row * LANES + 2 * tile->stride) > -INFINITY) & (most > 0.0f);
    any_left |= left[row];
    for (uint i = 0; i < 6; ++i) *(floatL*)(out[i] + row * LANES) = 0.0f;
  }
  // Light them group by group.
  Counts counted = {0, 0, 0, 0};
  while (any_lane(any_left)) {
    GroupPixels pixels;
    take_pixels(tile, left, &pixels);
    bool shines = CLUSTERED_HIGHLIGHTS && any_specular(&pixels);
    AllowedError of_diffuse = scene->allowed;
    if (shines) of_diffuse.error *= DIFFUSE_SHARE;
    light_group(&pixels, &scene->diffuse, of_diffuse, &shares->diffuse, out, &counted);
    if (pixels.redone) counted.redone += pixels.count;
    if (shines)
      for (uint first = 0; first < pixels.count; first += kHighlightPixels)
        highlight_group(&pixels, first, min(first + kHighlightPixels, pixels.count), &scene->frame,
                        &scene->specular, scene->allowed, &shares->specular, out, &counted);
    any_left = 0;
    for (uint row = 0; row < kTileRows; ++row) any_left |= left[row];
  }
  // Write the light, and the bound as it is seen through fog.
  for (uint row = 0; row < kTileRows; ++row) {
    vec3L position = load_vec3(tile->position + row * LANES, tile->stride);
    intL covered = position.z > -INFINITY;
    vec3L seen = {(floatL)(1.0f), (floatL)(1.0f), (floatL)(1.0f)};
    if (FOG) seen = fog_share(scene->frame, position);
    floatL transmittance[3] = {seen.x, seen.y, seen.z};
    for (uint c = 0; c < 3; ++c) {
      floatL of_bound = *(const floatL*)(out[3 + c] + row * LANES) * transmittance[c];
      of_bound = of_bound <= LARGEST_BOUND ? of_bound : (floatL)(LARGEST_BOUND);
      store_lanes(light + row * LANES + c * tile->stride,
                  finite_color(*(const floatL*)(out[c] + row * LANES)));
      store_lanes(bound + row * LANES + c * tile->stride, covered ? of_bound : (floatL)(0.0f));
    }
  }
  counts[0] = counted.far_clusters;
  counts[1] = counted.clusters;
  counts[2] = counted.lights;
  counts[3] = counted.redone;
}

WORK void light_run(Tile tile, const Scene* scene, uint tiles, __global float* light, __global float* bound,
                    __global uint* counts) {
  Shares shares = {0x1p-8f, 0x1p-8f};
  for (uint i = 0; i < tiles; ++i) {
    light_tile(&tile, scene, &shares, light, bound, counts);
    tile.position += kTilePixels;
    tile.normal += kTilePixels;
    tile.diffuse += kTilePixels;
    tile.specular += kTilePixels;
    light += kTilePixels;
    bound += kTilePixels;
    counts += 4;
  }
}

// rows, light_rows: of the tree of diffuse light; highlight_rows, highlight_light_rows: of that of specular
// light, which has the same places. A work-item takes kClusterRun tiles side by side.
KERNEL void clustered_light(ClusterFrame frame, __global const float* position, __global const float* normal,
                            __global const float* diffuse, __global const float* specular,
                            __global const float* rows, __global const float* light_rows,
                            __global const float* highlight_rows, __global const float* highlight_light_rows,
                            __global float* light, __global float* bound, __global uint* counts) {
  Scene scene = {frame.shade,
                 {rows, light_rows, frame.light_count, frame.levels},
                 {highlight_rows, highlight_light_rows, frame.light_count, frame.levels},
                 {frame.light_error, frame.least_value}};
  uint runs = (frame.tiles_x + kClusterRun - 1) / kClusterRun, item = work_item();
  uint column = item % runs * kClusterRun, first_tile = item / runs * frame.tiles_x + column;
  uint first = first_tile * kTilePixels;
  Tile tile = {position + first, normal + first, diffuse + first, specular + first, frame.shade.plane_stride};
  light_run(tile, &scene, min((uint)kClusterRun, frame.tiles_x - column), light + first, bound + first,
            counts + 4 * first_tile);
}
