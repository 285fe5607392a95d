// The light of point lights and cosine lobes without range, or of directional lights, sampled, with an
// interval for each pixel.
//
// A group of pixels, near each other and facing about the same way, cuts the tree of light clusters into
// strata. Of each stratum a pixel asks two lights whether it sees them, by rays: one of each half of the
// stratum's importance (strata.clh). What they give, over the probabilities by which they are picked, is A
// and B. The pixel's light is the sum of A + B over all strata, and the sum of (A − B)² estimates its
// variance.
//
//   take_group → halve strata of the largest light · spread, until the rays allowed are spent (cut.clh)
//              → sample_new: pick lights, evaluate them, trace rays (ray_walk.clh)
//              → sum_strata, judge: is the interval narrow enough for the group? Else allow more rays.
//              → renew_kept: sample what was kept from earlier rounds anew, and judge again
//
// Neighbours in a square of 4×4 pixels take different picks of a stratum, in the order of a Bayer matrix: so
// errors are a fine dither instead of blocks. Strata of one light or two are summed, and have no variance.
//
// All random numbers are functions of a group's pixel, a stratum's place in the tree and the seed. No sum's
// order depends on LANES. So the bits are the same on every device.
#include "exact/ray_walk.clh"
#include "exact/rays.clh"
#include "features.clh"
#include "lanes.clh"
#include "math.clh"
#include "quotient.clh"
#include "sampled/cut.clh"
#include "sampled/sampled_group.clh"
#include "sampled/sampled_light.h"
#include "sampled/strata.clh"
#include "shade/fog.clh"
#include "shade/phong.clh"
#include "shared.h"

// A stratum that may give so much light is halved whatever it was found to give.
#define BRIGHT 1e3f
// How many more pairs than its own a stratum's spread is taken from: such as would be between nothing and all
// of the light.
#define PRIOR_PAIRS 0.3f
// The variance of a pixel is taken from so many pairs' worth of its group's mean, and so many of its own for
// each stratum.
#define GROUP_PAIRS 32.0f
#define OWN_PAIRS 0.2f
// The halves of a stratum differ in what they give on average, so that their difference varies more than
// their sum: by this.
#define HALVES_DIFFER 0.8f
// Light that no pair met has left no variance. So many pairs more than a group took, of a mean stratum, count
// as if one half had given all of its light and the other nothing.
#define UNSEEN_PAIRS 1.0f
// The next round's rays are at least and at most so many times this one's.
#define LEAST_GROWTH 1.15f
#define MOST_GROWTH 2.5f
enum { kMostRounds = 30 };
// From one seed of a group to the next.
#define RENEWED_SEED 0x5bd1e995u
// What tells the seeds of directional lights from those of others.
#define DIRECTIONS_SEED 0x68e31da4u
// What a sampled light gives counts as this at most: squares of sums are finite floats.
#define MOST_SAMPLE 1e17f
// And what a light gives that is summed: what a float nearly holds.
#define MOST_LIGHT 3e37f
// A light's rounding, in units of 2⁻²⁴ of its light, as in clustered_light.cl; and of its highlight.
#define LIGHT_ROUNDING 40

// What all groups share.
typedef struct {
  const SampleFrame* frame;
  LightTrees trees;
  __global const float4* places;  // of lights, in the tree's space, as light rows have them
  RayScene scene;
} Sampling;

// Rays that wait until they are kTreeWidth, and the values that are 0 where something blocks them.
typedef struct {
  RayGroup rays;
  uint value[kTreeWidth];
  uint count;
  uint traced;  // by the work-item
  LastBlockers last;
} RayQueue;

// --- samples ---

SHARED_WORK void trace_queue(const Sampling* sampling, RayQueue* queue, const Cut* cut) {
  if (!queue->count) return;
  for (uint i = queue->count; i < kTreeWidth; ++i) {
    UNROLLED(axis, 3) queue->rays.start[axis][i] = queue->rays.start[axis][0];
    UNROLLED(axis, 4) queue->rays.place[axis][i] = queue->rays.place[axis][0];
  }
  aim_rays(&queue->rays, sampling->frame->tree_most);
  for (uint i = 0; i < queue->count; ++i) {
    bool unsure;
    bool hidden = is_blocked(&sampling->scene, &queue->rays, i, &queue->last, &unsure);
    if (!hidden && !(HOLES && unsure)) continue;
    // Where a texture decides, half of the light is taken, and as much is proven to be its error.
    uint at = queue->value[i];
    float left = hidden ? 0.0f : 0.5f;
    UNROLLED(c, 3) cut->values[at + c * kSampledPixels] *= left;
    if (HOLES && !hidden) cut->unsure[at / (3 * kSampledPixels)] |= 1ul << at % kSampledPixels;
  }
  queue->traced += queue->count;
  queue->count = 0;
}

// The lights of a half's picks, one for each lane.
typedef struct {
  vec3L place, rest, diffuse, specular;  // colours times 1/(2p)
  floatL falloff;
  vec3L axis;          // with LOBE_ROWS: see kLobeFields
  floatL round, cell;  //
} LaneLights;

// What lights give a row of a group's pixels if nothing is between, r g b.
INLINE vec3L unshadowed_light(const SampleFrame* frame, const SampledGroup* group, uint first,
                              const LaneLights* light) {
  vec3L position = group_vector(group, kPosition, first), normal = group_vector(group, kNormal, first);
  bool parallel = SAMPLED_DIRECTIONS && frame->parallel;
  if (parallel) position.x = position.y = position.z = 0.0f;
  vec3L u = {light->place.x - position.x + light->rest.x, light->place.y - position.y + light->rest.y,
             light->place.z - position.z + light->rest.z};
  floatL inverse_d = rsqrt_lanes(dot3(u, u)), none = 0.0f;
  if (parallel) inverse_d = 1.0f;
  floatL n_dot_l = dot3(normal, u) * inverse_d;
  floatL falloff = min_lanes(inverse_d * inverse_d, light->falloff);
  if (SAMPLED_LOBES) falloff *= max_lanes(light->round - dot3(light->axis, u) * inverse_d, none);
  floatL seen_cell = light->cell * falloff;
  falloff = n_dot_l > none ? falloff : none;
  if (NORMAL_MAPS)  // as before_surface() in shading.clh has it
    falloff = dot3(group_vector(group, kSurfaceNormal, first), u) * inverse_d > -0x1p-13f ? falloff : none;
  floatL strength = n_dot_l * falloff;
  vec3L color = group_vector(group, kDiffuse, first);
  vec3L value = {color.x * light->diffuse.x * strength, color.y * light->diffuse.y * strength,
                 color.z * light->diffuse.z * strength};
  if (SAMPLED_HIGHLIGHTS) {
    vec3L axis = group_vector(group, kAxis, first);
    uint model = frame->shade.model;
    floatL power, exponent = group->exponent, narrow = exponent;
    if (MODEL_IS(kBlinnPhongModel)) {
      if (WIDE_HIGHLIGHTS) exponent = wide_exponent(narrow, half_way2(dot3(u, axis) * inverse_d), seen_cell);
      power = pow_one_plus(
          blinn_lobe(u, inverse_d, axis, normal, n_dot_l, group_field(group, kNormalDotEye, first)),
          0.5f * exponent);
      if (WIDE_HIGHLIGHTS) power *= kept_energy(exponent, narrow, 2.0f);
    } else {
      if (WIDE_HIGHLIGHTS) exponent = wide_exponent(narrow, (floatL)(1.0f), seen_cell);
      power = pow_one_plus(phong_lobe(u, inverse_d, axis), exponent);
      if (WIDE_HIGHLIGHTS) power *= kept_energy(exponent, narrow, 1.0f);
    }
    strength = power * falloff;
    color = group_vector(group, kSpecular, first);
    value.x = fma_lanes(color.x * light->specular.x, strength, value.x);
    value.y = fma_lanes(color.y * light->specular.y, strength, value.y);
    value.z = fma_lanes(color.z * light->specular.z, strength, value.z);
  }
  return value;
}

// Sets A or B of a stratum's pixels to what the picks give them if nothing is between, and asks rays about
// it. turn: which pick pixels take, exclusive or with their own. most: of a value. Returns the sum of what
// largest channels.
INLINE float sample_half(const Sampling* sampling, const SampledGroup* group, const Picks* picks, uint side,
                         uint turn, uint values, float most, Cut* cut, RayQueue* queue) {
  ClusteredLight light[kPicks];
  float4 specular[SAMPLED_HIGHLIGHTS ? kPicks : 1];
  float lobe[LOBE_ROWS ? kPicks : 1][kLobeFields];
  for (uint k = 0; k < kPicks; ++k) {
    uint picked = picks->light[side * kPicks + k], number = picked == kNoPick ? 0 : picked;
    float weight = picked == kNoPick ? 0.0f : picks->weight[side * kPicks + k];
#ifdef PREFETCH
    PREFETCH(sampling->places + number);
#endif
    light[k] = clustered_light_of(&sampling->trees.diffuse, number);
    light[k].color *= weight;
    if (SAMPLED_HIGHLIGHTS) {
      __global const float* f =
          light_row_of(&sampling->trees.specular, number / kClusterSlots) + number % kClusterSlots;
      specular[k] = (float4)(f[kLightColor * kClusterSlots], f[(kLightColor + 1) * kClusterSlots],
                             f[(kLightColor + 2) * kClusterSlots], 0.0f) *
                    weight;
    }
    if (LOBE_ROWS)
      for (uint field = 0; field < kLobeFields; ++field)
        lobe[LOBE_ROWS ? k : 0][field] =
            sampling->trees.lobes[(size_t)(number / kClusterSlots) * (kLobeFields * kClusterSlots) +
                                  field * kClusterSlots + number % kClusterSlots];
  }
  float given[kSampledPixels] ALIGNED;
  clear_pixels(given);
  if (HOLES) cut->unsure[2 * values + side] = 0;
  uint first_value = values * kStratumValues + side * 3 * kSampledPixels;
  for (uint i = 0; i < group->count; i += LANES) {
    float to[13 + (LOBE_ROWS ? kLobeFields : 0)][LANES] ALIGNED;
    for (uint lane = 0; lane < LANES; ++lane) {
      uint k = i + lane < group->count ? group->pick[i + lane] ^ turn : 0;
      const ClusteredLight* from = light + k;
      to[0][lane] = from->place.x;
      to[1][lane] = from->place.y;
      to[2][lane] = from->place.z;
      to[3][lane] = from->rest.x;
      to[4][lane] = from->rest.y;
      to[5][lane] = from->rest.z;
      to[6][lane] = from->color.x;
      to[7][lane] = from->color.y;
      to[8][lane] = from->color.z;
      to[9][lane] = from->falloff;
      if (SAMPLED_HIGHLIGHTS) {
        to[10][lane] = specular[k].x;
        to[11][lane] = specular[k].y;
        to[12][lane] = specular[k].z;
      }
      if (LOBE_ROWS)
        for (uint field = 0; field < kLobeFields; ++field)
          to[LOBE_ROWS ? 13 + field : 0][lane] = lobe[LOBE_ROWS ? k : 0][field];
    }
#define LANES_OF(n) (*(const floatL*)to[n])
    LaneLights lights = {{LANES_OF(0), LANES_OF(1), LANES_OF(2)},
                         {LANES_OF(3), LANES_OF(4), LANES_OF(5)},
                         {LANES_OF(6), LANES_OF(7), LANES_OF(8)},
                         {0, 0, 0},
                         LANES_OF(9),
                         {0, 0, 0},
                         0,
                         0};
    if (SAMPLED_HIGHLIGHTS) {
      lights.specular.x = LANES_OF(10);
      lights.specular.y = LANES_OF(11);
      lights.specular.z = LANES_OF(12);
    }
    if (LOBE_ROWS) {
      lights.axis.x = LANES_OF(LOBE_ROWS ? 13 + kLobeAxis : 0);
      lights.axis.y = LANES_OF(LOBE_ROWS ? 14 + kLobeAxis : 0);
      lights.axis.z = LANES_OF(LOBE_ROWS ? 15 + kLobeAxis : 0);
      lights.round = LANES_OF(LOBE_ROWS ? 13 + kLobeRound : 0);
      lights.cell = LANES_OF(LOBE_ROWS ? 13 + kLobeCell : 0);
    }
    vec3L given_row = unshadowed_light(sampling->frame, group, i, &lights);
    floatL channel[3] = {given_row.x, given_row.y, given_row.z};
    intL counts = LANE_NUMBERS + (int)i < (int)group->count;
    floatL largest = 0.0f;
    UNROLLED(c, 3) {
      floatL value = min_lanes(channel[c], (floatL)(most));
      value = counts ? value : (floatL)(0.0f);
      store_lanes(cut->values + first_value + c * kSampledPixels + i, value);
      largest = max_lanes(largest, value);
    }
    *(floatL*)(given + i) = largest;
    for (uint bits = lane_bits(largest > 0.0f); bits; bits &= bits - 1) {
      uint lane = lowest_bit(bits);
      float4 place = sampling->places[picks->light[side * kPicks + (group->pick[i + lane] ^ turn)]];
      if (place.w == kNoRay) continue;
      uint n = queue->count++;
      UNROLLED(axis, 3) queue->rays.start[axis][n] = group->field[kStart + axis][i + lane];
      queue->rays.place[0][n] = place.x;
      queue->rays.place[1][n] = place.y;
      queue->rays.place[2][n] = place.z;
      queue->rays.place[3][n] = place.w;
      queue->value[n] = first_value + i + lane;
      if (queue->count == kTreeWidth) trace_queue(sampling, queue, cut);
    }
  }
  return sum_of_pixels(given);
}

// The lights of a stratum of one or two: every pixel asks each.
INLINE void take_all(const ClusterTree* tree, const Stratum* stratum, TreeNode node, Picks* picks) {
  uint leaf = node.node >> (node.level - tree->levels);
  TreeNode of_leaf = {tree->levels, leaf};
  uint slot = leaf * kLeafLights + first_light_of(tree, node) - first_light_of(tree, of_leaf);
  for (uint k = 0; k < 2 * kPicks; ++k) {
    uint light = k / kPicks;
    picks->light[k] = light < stratum->lights ? slot + light : kNoPick;
    picks->weight[k] = 1.0f;
  }
}

SHARED_WORK void sample_stratum(const Sampling* sampling, const SampledGroup* group,
                                const GroupBounds* bounds, uint4 seed, Cut* cut, uint number,
                                RayQueue* queue) {
  Stratum stratum = cut->strata[number];
  stratum.values = cut->free_count ? cut->free_values[--cut->free_count] : cut->values_count++;
  TreeNode node = {stratum.level, stratum.node};
  Picks picks;
  uint turn[2] = {0, 0};
  bool all = stratum.lights <= 2;
  if (all) {
    take_all(&sampling->trees.diffuse, &stratum, node, &picks);
  } else {
    uint4 random = hash4(seed ^ (uint4)(node.level, 0x9e3779b9u, node.node, 0u));
    turn[0] = random.x >> 16 & (kPicks - 1);
    turn[1] = random.y >> 16 & (kPicks - 1);
    uint used = 0;
    for (uint i = 0; i < group->count; ++i)
      used |= 1u << (group->pick[i] ^ turn[0]) | 1u << (kPicks + (group->pick[i] ^ turn[1]));
    pick_lights(&sampling->trees, bounds, node, seed, used, &picks);
  }
  float given = 0.0f;
  for (uint side = 0; side < 2; ++side)
    given += sample_half(sampling, group, &picks, side, turn[side], stratum.values,
                         all ? MOST_LIGHT : MOST_SAMPLE, cut, queue);
  stratum.unshadowed = quotient(given, (float)group->count);
  stratum.is_new = 1;
  cut->strata[number] = stratum;
}

// The pairs of a stratum that a group's pixels take.
INLINE float pairs_of(const SampledGroup* group) { return lesser((float)group->count, (float)(2 * kPicks)); }

// Sets how the halves of a stratum differ.
INLINE void set_spread(const SampledGroup* group, const Cut* cut, __global Stratum* stratum) {
  float count = (float)group->count, pairs = pairs_of(group);
  __global const float* values = cut->values + (size_t)stratum->values * kStratumValues;
  float squares[kSampledPixels] ALIGNED;
  clear_pixels(squares);
  for (uint at = 0; at < 3 * kSampledPixels; at += kSampledPixels)
    for (uint j = 0; j < group->count; j += LANES) {
      floatL apart = load_lanes(values + at + j) - load_lanes(values + at + j + 3 * kSampledPixels);
      *(floatL*)(squares + j) = fma_lanes(apart, apart, *(const floatL*)(squares + j));
    }
  float mean = quotient(sum_of_pixels(squares), 3.0f * count),
        prior = PRIOR_PAIRS * stratum->unshadowed * stratum->unshadowed;
  float deviation = square_root(quotient(fma(mean, pairs, prior), pairs + 2.0f * PRIOR_PAIRS));
  stratum->spread = quotient(deviation, stratum->light + 1e-30f);
  stratum->key = stratum->light * stratum->spread;
}

// Samples the strata that are new. When all rays are traced, sets how their halves differ.
INLINE void sample_new(const Sampling* sampling, const SampledGroup* group, const GroupBounds* bounds,
                       uint4 seed, Cut* cut, RayQueue* queue) {
  for (uint i = 0; i < cut->strata_count; ++i) cut->strata[i].is_new = 0;
  uint count = list_new(cut);
  for (uint i = 0; i < count; ++i) sample_stratum(sampling, group, bounds, seed, cut, cut->order[i], queue);
  trace_queue(sampling, queue, cut);
  for (uint i = 0; i < cut->strata_count; ++i)
    if (cut->strata[i].is_new && cut->strata[i].lights > 2) set_spread(group, cut, cut->strata + i);
  sort_heap(cut);
}

// --- sums ---

// Of a group's pixels: their light, its variance, and what is surely its largest error but for that.
typedef struct {
  float light[3][kSampledPixels] ALIGNED;
  float variance[3][kSampledPixels] ALIGNED;
  float proven[3][kSampledPixels] ALIGNED;
  float unseen;  // the variance of light that no pair met
} GroupLight;

// Adds the values of pixels whose rays textures decide.
INLINE void add_unsure(__global const float* values, ulong pixels, GroupLight* sums) {
  for (; pixels; pixels &= pixels - 1) {
    uint pixel = 63 - (uint)clz(pixels & (0 - pixels));
    for (uint c = 0; c < 3; ++c) sums->proven[c][pixel] += values[c * kSampledPixels + pixel];
  }
}

INLINE void sum_strata(const SampledGroup* group, const Cut* cut, GroupLight* sums) {
  for (uint c = 0; c < 3; ++c) {
    clear_pixels(sums->light[c]);
    clear_pixels(sums->variance[c]);
    clear_pixels(sums->proven[c]);
  }
  float squares = 0.0f;
  for (uint i = 0; i < cut->strata_count; ++i) {
    Stratum stratum = cut->strata[i];
    if (!stratum.lights) continue;
    __global const float* values = cut->values + (size_t)stratum.values * kStratumValues;
    bool sampled = stratum.lights > 2;
    if (sampled) squares = fma(stratum.unshadowed, stratum.unshadowed, squares);
    for (uint c = 0; c < 3; ++c)
      for (uint j = 0; j < group->count; j += LANES) {
        floatL a = load_lanes(values + c * kSampledPixels + j),
               b = load_lanes(values + (3 + c) * kSampledPixels + j), apart = a - b;
        *(floatL*)(sums->light[c] + j) += a + b;
        if (sampled)
          *(floatL*)(sums->variance[c] + j) =
              fma_lanes(apart, apart, *(const floatL*)(sums->variance[c] + j));
      }
    if (HOLES) {
      add_unsure(values, cut->unsure[2 * stratum.values], sums);
      add_unsure(values + 3 * kSampledPixels, cut->unsure[2 * stratum.values + 1], sums);
    }
  }
  sums->unseen = quotient(UNSEEN_PAIRS * squares, pairs_of(group) * (float)(cut->heap_count + 1));
  // Each stratum's sum rounds once, and so does the sum with what was there before.
  float rounding = 0x1p-24f * (float)(LIGHT_ROUNDING + cut->strata_count + 2);
  for (uint c = 0; c < 3; ++c)
    for (uint j = 0; j < group->count; j += LANES)
      *(floatL*)(sums->proven[c] + j) = fma_lanes((floatL)(rounding), *(const floatL*)(sums->light[c] + j),
                                                  *(const floatL*)(sums->proven[c] + j));
}

// The planes that are written, r g b each, from a tile's first pixel on.
typedef struct {
  __global float *light, *bound, *half_width;
} SampledPlanes;

// Light, proven error and half width of a group's pixels that other lights gave before, as the tile's planes
// have them: errors as seen through the fog; and the share of light that the fog lets through. r g b.
typedef struct {
  float light[3][kSampledPixels] ALIGNED;
  float bound[3][kSampledPixels] ALIGNED;
  float half_width[SAMPLED_DIRECTIONS ? 3 : 1][kSampledPixels] ALIGNED;  // with SAMPLED_DIRECTIONS
  float seen[FOG ? 3 : 1][kSampledPixels] ALIGNED;
} BeforeLight;

// What a launch for other lights gave a channel of pixels: see SAMPLED_DIRECTIONS in judge().
INLINE floatL width_before(const BeforeLight* before, uint c, uint j) {
  return *(const floatL*)(before->half_width[SAMPLED_DIRECTIONS ? c : 0] + j);
}

INLINE void load_before(const SampleFrame* frame, const SampledGroup* group, uint stride,
                        const SampledPlanes* planes, BeforeLight* before) {
  for (uint c = 0; c < 3; ++c) {
    clear_pixels(before->light[c]);
    clear_pixels(before->bound[c]);
    if (SAMPLED_DIRECTIONS) clear_pixels(before->half_width[SAMPLED_DIRECTIONS ? c : 0]);
    for (uint j = 0; j < group->count; ++j) {
      uint at = group->place[j] + c * stride;
      before->light[c][j] = planes->light[at];
      before->bound[c][j] = planes->bound[at];
      if (SAMPLED_DIRECTIONS) before->half_width[SAMPLED_DIRECTIONS ? c : 0][j] = planes->half_width[at];
    }
  }
  if (!FOG) return;
  for (uint j = 0; j < group->count; j += LANES) {
    vec3L share = fog_share(frame->shade, group_vector(group, kPosition, j));
    *(floatL*)(before->seen[0] + j) = share.x;
    *(floatL*)(before->seen[FOG ? 1 : 0] + j) = share.y;
    *(floatL*)(before->seen[FOG ? 2 : 0] + j) = share.z;
  }
}

INLINE floatL seen_share(const BeforeLight* before, uint c, uint j) {
  return FOG ? *(const floatL*)(before->seen[FOG ? c : 0] + j) : (floatL)(1.0f);
}

// Makes of each pixel's own variance an estimate from its group's, too. Returns the mean square of the half
// width as a share of the one allowed, of the worst channel.
//
// With SAMPLED_DIRECTIONS lights with a place are sampled first, then directional ones. Their errors have
// random numbers of their own, so they are independent, and the variance of their sum is the sum of both. So
// its deviation times as many as each half width has is √(w₁² + w₂²). The half width of Student's
// distribution holds for such a sum with at least the same probability (R. Mickey and M. Brown, "Bounds on
// the Distribution Functions of the Behrens-Fisher Statistic", 1966). The first takes half of the square at
// most.
INLINE float judge(const SampleFrame* frame, const SampledGroup* group, const BeforeLight* before,
                   uint strata, GroupLight* sums) {
  float worst = 0.0f, own = OWN_PAIRS * (float)strata, count = (float)group->count;
  for (uint c = 0; c < 3; ++c) {
    float shares[kSampledPixels] ALIGNED;
    for (uint j = 0; j < kSampledPixels; j += LANES)
      *(floatL*)(shares + j) = *(const floatL*)(sums->variance[c] + j);
    float of_group = HALVES_DIFFER * quotient(sum_of_pixels(shares), count);
    clear_pixels(shares);
    for (uint j = 0; j < group->count; j += LANES) {
      floatL variance = *(const floatL*)(sums->variance[c] + j), seen = seen_share(before, c, j);
      variance = quotient_lanes(GROUP_PAIRS * of_group + own * HALVES_DIFFER * variance,
                                (floatL)(GROUP_PAIRS + own)) +
                 sums->unseen;
      *(floatL*)(sums->variance[c] + j) = variance;
      floatL light = seen * (*(const floatL*)(before->light[c] + j) + *(const floatL*)(sums->light[c] + j));
      floatL allowed = frame->light_error * max_lanes(light, (floatL)(frame->least_value)),
             proven = fma_lanes(seen, *(const floatL*)(sums->proven[c] + j),
                                *(const floatL*)(before->bound[c] + j));
      // A proven error takes half of what is allowed at most.
      floatL room = max_lanes(allowed - proven, 0.5f * allowed);
      floatL share = quotient_lanes(frame->deviations * seen, room);
      share = share * share * variance;
      if (SAMPLED_DIRECTIONS) {
        floatL first = quotient_lanes(width_before(before, c, j), room);
        share += min_lanes(first * first, (floatL)(0.5f));
      }
      *(floatL*)(shares + j) = LANE_NUMBERS + (int)j < (int)group->count ? share : (floatL)(0.0f);
    }
    worst = greater(worst, quotient(sum_of_pixels(shares), count));
  }
  return worst;
}

// What sampled_light.cl counts of a tile.
typedef struct {
  uint of[kSampleCounts];
} SampleCounts;

// Strata that were sampled in an earlier round are to be sampled anew. They were kept since their samples
// differ little: so on average these miss light.
INLINE void renew_kept(Cut* cut) {
  for (uint i = 0; i < cut->strata_count; ++i) {
    __global Stratum* stratum = cut->strata + i;
    if (stratum->lights <= 2 || stratum->is_new) continue;
    cut->free_values[cut->free_count++] = stratum->values;
    stratum->values = kNoValues;
  }
}

// Samples what isn't sampled yet. Returns what judge() does.
SHARED_WORK float sample_and_judge(const Sampling* sampling, const SampledGroup* group,
                                   const GroupBounds* bounds, const BeforeLight* before, uint4 seed, Cut* cut,
                                   RayQueue* queue, GroupLight* sums) {
  sample_new(sampling, group, bounds, seed, cut, queue);
  sum_strata(group, cut, sums);
  return judge(sampling->frame, group, before, cut->heap_count + 1, sums);
}

// Lights a group.
INLINE void light_sampled_group(const Sampling* sampling, const SampledGroup* group,
                                const BeforeLight* before, uint4 seed, Cut* cut, RayQueue* queue,
                                GroupLight* sums, SampleCounts* counts) {
  GroupBounds bounds = bound_sampled(sampling->frame, group);
  start_cut(&sampling->trees.diffuse, cut);
  uint budget = sampling->frame->pilot;
  float worst;
  for (uint round = 1;; ++round) {
    while ((cut->cost < budget || (cut->heap_count && cut->strata[cut->heap[0]].light >= BRIGHT)) &&
           halve_stratum(&sampling->trees, &bounds, cut)) {
    }
    worst = sample_and_judge(sampling, group, &bounds, before, seed, cut, queue, sums);
    counts->of[kSampledRounds] += 1;
    bool is_last = !cut->heap_count || cut->strata_count == kMostStrata || round == kMostRounds;
    if (round > 1 && (worst <= 1.0f || is_last)) {
      renew_kept(cut);
      seed.x += RENEWED_SEED;
      worst = sample_and_judge(sampling, group, &bounds, before, seed, cut, queue, sums);
    }
    if (worst <= 1.0f || is_last) break;
    // The error falls about as the rays' number to the power −0.65.
    float more = square_root(1.1f * worst);
    more *= square_root(more);
    budget = (uint)((float)cut->cost * lesser(greater(more, LEAST_GROWTH), MOST_GROWTH)) + 1;
  }
  counts->of[kSampledGroups] += 1;
  counts->of[kSampledStrata] += cut->strata_count;
  if (!(worst <= 1.0f)) counts->of[kMissedPixels] += group->count;
}

// --- tiles ---

INLINE void store_group(const SampleFrame* frame, const SampledGroup* group, const BeforeLight* before,
                        const GroupLight* sums, uint stride, const SampledPlanes* planes) {
  for (uint c = 0; c < 3; ++c) {
    float light[kSampledPixels] ALIGNED, proven[kSampledPixels] ALIGNED, width[kSampledPixels] ALIGNED;
    for (uint j = 0; j < group->count; j += LANES) {
      floatL seen = seen_share(before, c, j), variance = *(const floatL*)(sums->variance[c] + j);
      // The root is of one that isn't 0.
      floatL deviation = variance * rsqrt_lanes(max_lanes(variance, (floatL)(1e-36f)));
      *(floatL*)(light + j) =
          finite_color(*(const floatL*)(before->light[c] + j) + *(const floatL*)(sums->light[c] + j));
      *(floatL*)(proven + j) = finite_color(
          fma_lanes(seen, *(const floatL*)(sums->proven[c] + j), *(const floatL*)(before->bound[c] + j)));
      floatL half_width = frame->deviations * seen * deviation;
      if (SAMPLED_DIRECTIONS) {
        floatL first = width_before(before, c, j), square = fma_lanes(first, first, half_width * half_width);
        half_width = square * rsqrt_lanes(max_lanes(square, (floatL)(1e-36f)));
      }
      *(floatL*)(width + j) = finite_color(half_width);
    }
    for (uint j = 0; j < group->count; ++j) {
      uint at = group->place[j] + c * stride;
      planes->light[at] = light[j];
      planes->bound[at] = proven[j];
      planes->half_width[at] = width[j];
    }
  }
}

// Adds the light of a tile's pixels and their intervals.
INLINE void light_sampled_tile(const Sampling* sampling, const SampledTile* tile, Cut* cut, RayQueue* queue,
                               const SampledPlanes* planes, SampleCounts* counts) {
  const SampleFrame* frame = sampling->frame;
  for (uint first = 0; first < kTilePixels; first += kSampledPixels) {
    ulong left = 0;
    for (uint i = 0; i < kSampledPixels; ++i) {
      bool reflects = false;
      for (uint c = 0; c < 3; ++c) {
        uint at = first + i + c * tile->stride;
        reflects |= tile->diffuse[at] > 0.0f;
        if (SAMPLED_HIGHLIGHTS) reflects |= tile->specular[at] > 0.0f;
      }
      if (reflects && tile->position[first + i + 2 * tile->stride] > -INFINITY) left |= 1ul << i;
    }
    while (left) {
      SampledGroup group;
      GroupLight sums;
      BeforeLight before;
      take_group(frame, tile, first, &left, &group);
      load_before(frame, &group, tile->stride, planes, &before);
      float position[3] = {group.field[kPosition][0], group.field[kPosition + 1][0],
                           group.field[kPosition + 2][0]};
      uint2 pixel = pixel_of(frame, position);
      uint4 seed = (uint4)(frame->seed, pixel.x, pixel.y,
                           SAMPLED_DIRECTIONS && frame->parallel ? DIRECTIONS_SEED : 0u);
      light_sampled_group(sampling, &group, &before, seed, cut, queue, &sums, counts);
      store_group(frame, &group, &before, &sums, tile->stride, planes);
    }
  }
}

WORK void light_tiles(const Sampling* sampling, SampledTile tile, Cut* cut, SampledPlanes planes,
                      __global uint* counts, volatile __global uint* next_tile) {
  RayQueue queue;
  queue.count = 0;
  for (uint i = 0; i < sizeof(LastBlockers) / sizeof(uint); ++i) ((uint*)&queue.last)[i] = 0;
  for (uint number; (number = atomic_inc(next_tile)) < sampling->frame->tiles;) {
    uint first = number * kTilePixels;
    SampledTile at = {
        tile.position + first, tile.normal + first,         tile.diffuse + first, tile.specular + first,
        tile.lift + first,     tile.surface_normal + first, tile.stride};
    SampledPlanes to = {planes.light + first, planes.bound + first, planes.half_width + first};
    SampleCounts counted;
    for (uint i = 0; i < kSampleCounts; ++i) counted.of[i] = 0;
    queue.traced = 0;
    light_sampled_tile(sampling, &at, cut, &queue, &to, &counted);
    counted.of[kSampledRays] = queue.traced;
    for (uint i = 0; i < kSampleCounts; ++i) counts[number * kSampleCounts + i] = counted.of[i];
  }
}

// rows … specular_light_rows: of the trees of clusters by diffuse and by specular colours. places: of their
// lights, kClusterSlots a row of lights (BeamLight::place; w: kNoRay for those that cast no shadow). lobes:
// rows of kLobeFields. nodes … first_hole_triangle: of the tree over the triangles. strata … unsure: room for
// kMostStrata of each work-item.
// - light, bound, half_width: planes r g b of what the pixels reflect, of proven errors, and of half widths
//   that hold with the confidence asked for, both seen through the fog. They hold those of other lights, to
//   which what is sampled is added.
// - counts: kSampleCounts for each tile.
// A work-item takes tile after tile from `next_tile`, which is 0 at first.
KERNEL void sampled_light(SampleFrame frame, __global const float* position, __global const float* normal,
                          __global const float* diffuse, __global const float* specular,
                          __global const float* lift, __global const uint* surface_normal,
                          __global const float* rows, __global const float* light_rows,
                          __global const float* specular_rows, __global const float* specular_light_rows,
                          __global const float4* places, __global const float* lobes,
                          __global const float* nodes, __global const int* children,
                          __global const float* blocks, __global const uint* block_bits,
                          __global const uchar* hole_texels, __global const HoleTriangle* hole_triangles,
                          __global const uint* first_hole_triangle, __global Stratum* strata,
                          __global uint* heap, __global uint* order, __global uint* free_values,
                          __global float* values, __global ulong* unsure, __global float* light,
                          __global float* bound, __global float* half_width, __global uint* counts,
                          volatile __global uint* next_tile) {
  float4 size = frame.tree_most;
  Sampling sampling = {&frame,
                       {{rows, light_rows, frame.light_count, frame.levels},
                        {specular_rows, specular_light_rows, frame.light_count, frame.levels},
                        lobes,
                        frame.largest_cell},
                       places,
                       {nodes,
                        children,
                        blocks,
                        block_bits,
                        {hole_texels, hole_triangles, first_hole_triangle},
                        frame.tree_root,
                        2.0f * greater(size.x, greater(size.y, size.z))}};
  size_t first = work_item() * kMostStrata;
  Cut cut = {strata + first,
             heap + first,
             order + first,
             free_values + first,
             values + first * kStratumValues,
             unsure + (HOLES ? 2 * first : 0),
             0,
             0,
             0,
             0,
             0};
  SampledTile tile = {position, normal, diffuse, specular, lift, surface_normal, frame.shade.plane_stride};
  SampledPlanes planes = {light, bound, half_width};
  light_tiles(&sampling, tile, &cut, planes, counts, next_tile);
}
