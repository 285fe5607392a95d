// The diffuse light of lights without range, of which clusters stand for those far enough, with a bound of its error at each pixel.
//
// A work-item takes a run of tiles. The pixels of a tile that are near each other and face about the same way are a group:
//
//   take_group → walk_clusters (light_clusters.clh) → for each row: add_listed, then the far field (far_field.clh)
//
// A group whose bound is above what is allowed, light_error·max(1, colour), is lit again with smaller errors of each cluster. What was
// accepted steers the groups after it in the run. So a pixel's light is a function of its run alone.
#include "cut_clusters.clh"
#include "far_field.clh"
#include "fog.clh"
#include "lanes.clh"
#include "light_clusters.clh"
#include "math.clh"
#include "shared.h"

enum { kTileRows = kTilePixels / LANES, kMostTries = 12 };

// How many lights are added one by one.
enum { kSumTerms = 128 };

// A light's rounding, in units of 2⁻²⁴. Of its light: 6 of 1/d, 3 of a normal's length, 13 of the falloff, 10 of colour, place and products.
// And of its colour over d², however small the cosine is: 4 of the difference and of the dot product.
#define LIGHT_ROUNDING 32
#define COSINE_ROUNDING 5

// Pixels of a group lie this share of the first one's distance from the eye around it, and their normals this near to its own.
#define GROUP_RADIUS 0.03f
#define GROUP_SPREAD 0.08f
// What a bound that no float holds is given as.
#define LARGEST_BOUND 3e38f

// The planes of a G-buffer that are read, x y z or r g b each, from a tile's first pixel on.
typedef struct {
  __global const float *position, *normal, *diffuse;
  uint stride;
} Tile;

// The pixels of a group, in rows of LANES. The last row is filled up with its first pixel.
typedef struct {
  uint count;
  uint place[kTilePixels];  // in the tile
  float value[9][kTilePixels] __attribute__((aligned(64)));  // position, normal, diffuse
} GroupPixels;

INLINE floatL pixel_values(const GroupPixels *pixels, uint value, uint first) { return *(const floatL *)(pixels->value[value] + first); }
INLINE vec3L pixel_vector(const GroupPixels *pixels, uint value, uint first) {
  vec3L v = {pixel_values(pixels, value, first), pixel_values(pixels, value + 1, first), pixel_values(pixels, value + 2, first)};
  return v;
}

// Takes a group off the pixels that are left of a tile, which are not none.
INLINE void take_pixels(const Tile *tile, intL *left, GroupPixels *pixels) {
  uint seed = 0;
  while (!any_lane(left[seed])) ++seed;
  seed = seed * LANES + lowest_bit(lane_bits(left[seed]));
  __global const float *p = tile->position + seed, *n = tile->normal + seed;
  float4 place = {p[0], p[tile->stride], p[2 * tile->stride], 0.0f}, facing = {n[0], n[tile->stride], n[2 * tile->stride], 0.0f};
  float reach2 = GROUP_RADIUS * GROUP_RADIUS * (place.x * place.x + place.y * place.y + place.z * place.z);
  pixels->count = 0;
  for (uint row = 0; row < kTileRows; ++row) {
    if (!any_lane(left[row])) continue;
    vec3L position = load_vec3(tile->position + row * LANES, tile->stride), normal = load_vec3(tile->normal + row * LANES, tile->stride);
    vec3L from = {position.x - place.x, position.y - place.y, position.z - place.z};
    vec3L turn = {normal.x - facing.x, normal.y - facing.y, normal.z - facing.z};
    intL is_near = dot3(from, from) <= reach2, faces_alike = dot3(turn, turn) <= GROUP_SPREAD * GROUP_SPREAD;
    intL is_seed = LANE_NUMBERS + (int)(row * LANES) == (int)seed;
    intL member = left[row] & ((is_near & faces_alike) | is_seed);
    left[row] &= ~member;
    for (uint bits = lane_bits(member); bits; bits &= bits - 1) {
      uint at = row * LANES + lowest_bit(bits);
      pixels->place[pixels->count] = at;
      for (uint axis = 0; axis < 3; ++axis) {
        pixels->value[axis][pixels->count] = tile->position[at + axis * tile->stride];
        pixels->value[3 + axis][pixels->count] = tile->normal[at + axis * tile->stride];
        pixels->value[6 + axis][pixels->count] = tile->diffuse[at + axis * tile->stride];
      }
      ++pixels->count;
    }
  }
  for (uint i = pixels->count; i % LANES > 0; ++i)
    for (uint value = 0; value < 9; ++value) pixels->value[value][i] = pixels->value[value][i / LANES * LANES];
}

// What bounds a group's pixels.
INLINE PixelGroup bound_group(const GroupPixels *pixels, float light_error) {
  PixelGroup group;
  for (uint axis = 0; axis < 6; ++axis) {
    float low = INFINITY, high = -INFINITY;
    for (uint i = 0; i < pixels->count; i += LANES) {
      low = min(low, least_lane(pixel_values(pixels, axis, i)));
      high = max(high, greatest_lane(pixel_values(pixels, axis, i)));
    }
    float middle = 0.5f * low + 0.5f * high;
    if (axis < 3) group.middle[axis] = middle;
    else group.normal[axis - 3] = middle;
  }
  float radius2 = 0.0f, spread2 = 0.0f, thickness = 0.0f, brightest = 0.0f;
  for (uint i = 0; i < pixels->count; i += LANES) {
    vec3L position = pixel_vector(pixels, 0, i), normal = pixel_vector(pixels, 3, i), color = pixel_vector(pixels, 6, i);
    vec3L from = {position.x - group.middle[0], position.y - group.middle[1], position.z - group.middle[2]};
    vec3L turn = {normal.x - group.normal[0], normal.y - group.normal[1], normal.z - group.normal[2]};
    radius2 = max(radius2, greatest_lane(dot3(from, from)));
    spread2 = max(spread2, greatest_lane(dot3(turn, turn)));
    thickness = max(thickness, greatest_lane(abs_lanes(dot3(from, normal))));
    brightest = max(brightest, greatest_lane(max_lanes(color.x, max_lanes(color.y, color.z))));
  }
  // More than the rounding of each.
  group.radius = 1.00001f * sqrt(radius2);
  group.spread = 1.00001f * sqrt(spread2);
  group.thickness = thickness + 0x1p-20f * group.radius;
  group.gain = brightest / light_error;
  return group;
}

// What a row of pixels is lit by one by one.
typedef struct {
  Certified cut;
  vec3L lights;
  floatL weight;  // sum of the lights' largest channel over d²
} RowSums;

// Adds the lights of a walk's list to a row of pixels.
INLINE void add_listed_lights(const ClusterWalk *walk, __global const ClusteredLight *lights, vec3L position, vec3L normal, RowSums *sums) {
  for (uint from = 0; from < walk->lights; from += kSumTerms) {
    uint end = min(from + kSumTerms, walk->lights);
    vec3L some = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
    floatL some_weight = 0.0f;
    for (uint i = from; i < end; ++i) {
      __global const ClusteredLight *light = lights + walk->light[i];
      vec3L u = {light->position.x - position.x + light->rest.x, light->position.y - position.y + light->rest.y,
                 light->position.z - position.z + light->rest.z};
      floatL inverse_d = rsqrt_lanes(dot3(u, u));
      floatL cosine = max_lanes(dot3(normal, u) * inverse_d, (floatL)(0.0f));
      floatL falloff = min_lanes(inverse_d * inverse_d, (floatL)(light->position.w));
      add_scaled(&some, light->diffuse, cosine * falloff);
      some_weight = fma_lanes((floatL)(light->diffuse.w), falloff, some_weight);
    }
    sums->lights.x += some.x;
    sums->lights.y += some.y;
    sums->lights.z += some.z;
    sums->weight += some_weight;
  }
}

INLINE void add_listed(const ClusterWalk *walk, const GroupPixels *pixels, __global const float *rows, __global const ClusteredLight *lights,
                       RowSums *sums) {
  for (uint i = 0; i < pixels->count; i += LANES) {
    vec3L position = pixel_vector(pixels, 0, i), normal = pixel_vector(pixels, 3, i);
    RowSums some = sums[i / LANES];
    add_listed_lights(walk, lights, position, normal, &some);
    for (uint k = 0; k < walk->clusters; ++k) {
      uint cluster = walk->cluster[k];
      add_cut_cluster(rows + (size_t)(cluster / kClusterSlots) * (kClusterFields * kClusterSlots) + cluster % kClusterSlots, position, normal,
                      &some.cut);
    }
    sums[i / LANES] = some;
  }
}

INLINE floatL share_of(floatL light, floatL bound, float light_error) {
  floatL share = bound / (light_error * max_lanes(light, (floatL)(1.0f)));
  return share <= 1e30f ? share : (floatL)(1e30f);
}

// Writes the light and the bound of a group's pixels to `out`, six planes of a tile. blocks, cuts: how many numbers the sums over lights and
// over clusters were made of. Returns the largest share that a bound has of the error that is allowed.
INLINE float finish_group(const GroupPixels *pixels, const ShadeFrame *frame, FieldSums *sums, const PixelGroup *group,
                          const RowSums *row_sums, uint blocks, uint cuts, float light_error, float out[6][kTilePixels]) {
  Field field;
  finish_field(sums, &field);
  float of_lights = 0x1p-24f * (float)(LIGHT_ROUNDING + kSumTerms + blocks), of_clusters = 0x1p-24f * (float)(64 + cuts);
  float worst = 0.0f;
  for (uint i = 0; i < pixels->count; i += LANES) {
    vec3L position = pixel_vector(pixels, 0, i), normal = pixel_vector(pixels, 3, i), color = pixel_vector(pixels, 6, i);
    vec3L h = {position.x - group->middle[0], position.y - group->middle[1], position.z - group->middle[2]};
    FieldFactors factors = field_factors(normal, h);
    const RowSums *had = row_sums + i / LANES;
    floatL lights[3] = {had->lights.x, had->lights.y, had->lights.z}, albedo[3] = {color.x, color.y, color.z};
    floatL cut[3] = {had->cut.light.x, had->cut.light.y, had->cut.light.z};
    floatL cut_bound[3] = {had->cut.bound.x, had->cut.bound.y, had->cut.bound.z};
    vec3L seen = FOG ? fog_share(*frame, position) : (vec3L){(floatL)(1.0f), (floatL)(1.0f), (floatL)(1.0f)};
    floatL transmittance[3] = {seen.x, seen.y, seen.z};
    floatL light[3], bound[3];
    for (uint c = 0; c < 3; ++c) {
      light[c] = albedo[c] * (field_value(field.term + c * kFieldTerms, &factors) + cut[c] + lights[c]);
      bound[c] = field.term[kFieldBound] + field.rounding + cut_bound[c] + of_clusters * cut[c] + of_lights * lights[c] +
                 COSINE_ROUNDING * 0x1p-24f * had->weight;
      // The factor is more than the rounding of sums of so many bounds. Colours, products and the sum of the parts are rounded, too.
      bound[c] = fma_lanes((floatL)(0x1p-21f), light[c], 1.001f * albedo[c] * bound[c]);
      worst = max(worst, greatest_lane(share_of(light[c], bound[c], light_error)));
      light[c] = finite_color(light[c]);
      bound[c] = bound[c] * transmittance[c];
      bound[c] = bound[c] <= LARGEST_BOUND ? bound[c] : (floatL)(LARGEST_BOUND);
    }
    for (uint lane = 0; lane < LANES && i + lane < pixels->count; ++lane)
      for (uint c = 0; c < 3; ++c) {
        out[c][pixels->place[i + lane]] = ((const float *)&light[c])[lane];
        out[3 + c][pixels->place[i + lane]] = ((const float *)&bound[c])[lane];
      }
  }
  return worst;
}

// Lights a tile; black pixels stay as they are, without a look at the lights. share: of the allowed error that is accepted of a cluster; updated. counts: as clusteredLight() sums them.
INLINE void light_tile(const Tile *tile, const ShadeFrame *frame, const ClusterTree *tree, __global const ClusteredLight *lights, float light_error, float *share,
                       __global float *light, __global float *bound, __global uint *counts) {
  float out[6][kTilePixels] __attribute__((aligned(64)));
  intL left[kTileRows], any_left = 0;
  for (uint row = 0; row < kTileRows; ++row) {
    vec3L color = load_vec3(tile->diffuse + row * LANES, tile->stride);
    left[row] = load_lanes(tile->position + row * LANES + 2 * tile->stride) > -INFINITY;
    left[row] &= max_lanes(color.x, max_lanes(color.y, color.z)) > 0.0f;
    any_left |= left[row];
    for (uint i = 0; i < 6; ++i) *(floatL *)(out[i] + row * LANES) = 0.0f;
  }
  uint clusters = 0, cut = 0, listed = 0, redone = 0;
  while (any_lane(any_left)) {
    GroupPixels pixels;
    take_pixels(tile, left, &pixels);
    PixelGroup group = bound_group(&pixels, light_error);
    for (uint tries = 1;; ++tries) {
      ClusterWalk walk;
      FieldSums sums;
      RowSums row_sums[kTileRows];
      vec3L dark = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
      for (uint row = 0; row < kTileRows; ++row) {
        row_sums[row].cut.light = row_sums[row].cut.bound = row_sums[row].lights = dark;
        row_sums[row].weight = 0.0f;
      }
      start_field(&sums);
      start_cluster_walk(tree, &walk);
      uint blocks = 0, cuts = 0;  // that the sums of lights and of clusters are made of
      for (bool done = false; !done;) {
        done = walk_clusters(tree, &group, tries == kMostTries ? 0.0f : *share, &walk, &sums);
        add_listed(&walk, &pixels, tree->rows, lights, row_sums);
        blocks += (walk.lights + kSumTerms - 1) / kSumTerms;
        cuts += walk.clusters;
        listed += walk.lights * pixels.count;
        cut += walk.clusters * pixels.count;
        walk.lights = walk.clusters = 0;
      }
      clusters += walk.far_clusters;
      float worst = finish_group(&pixels, frame, &sums, &group, row_sums, blocks, cuts, light_error, out);
      // Errors grow somewhat slower than what is accepted.
      *share *= min(max(0.6f / worst, 0.125f), 4.0f);
      if (worst <= 1.0f || tries == kMostTries) break;
      redone += pixels.count;
    }
    any_left = 0;
    for (uint row = 0; row < kTileRows; ++row) any_left |= left[row];
  }
  for (uint row = 0; row < kTileRows; ++row)
    for (uint c = 0; c < 3; ++c) {
      store_lanes(light + row * LANES + c * tile->stride, *(const floatL *)(out[c] + row * LANES));
      store_lanes(bound + row * LANES + c * tile->stride, *(const floatL *)(out[3 + c] + row * LANES));
    }
  counts[0] = clusters;
  counts[1] = cut;
  counts[2] = listed;
  counts[3] = redone;
}

WORK void light_run(Tile tile, ShadeFrame frame, ClusterTree tree, __global const ClusteredLight *lights, float light_error, uint tiles,
                    __global float *light, __global float *bound, __global uint *counts) {
  float share = 0x1p-8f;
  for (uint i = 0; i < tiles; ++i) {
    light_tile(&tile, &frame, &tree, lights, light_error, &share, light, bound, counts);
    tile.position += kTilePixels;
    tile.normal += kTilePixels;
    tile.diffuse += kTilePixels;
    light += kTilePixels;
    bound += kTilePixels;
    counts += 4;
  }
}

__kernel void clustered_light(ShadeFrame frame, __global const float *position, __global const float *normal,
                              __global const float *diffuse, __global const float *rows, __global const ClusteredLight *lights,
                              uint light_count, uint levels, float light_error, uint tiles_x, uint run, __global float *light,
                              __global float *bound, __global uint *counts) {
  ClusterTree tree = {rows, light_count, levels};
  uint runs = (tiles_x + run - 1) / run, item = get_global_id(0), column = item % runs * run;
  uint first_tile = item / runs * tiles_x + column, first = first_tile * kTilePixels;
  Tile tile = {position + first, normal + first, diffuse + first, frame.plane_stride};
  light_run(tile, frame, tree, lights, light_error, min(run, tiles_x - column), light + first, bound + first, counts + 4 * first_tile);
}
