// Lights a G-buffer. One work-item shades ROWS rows of LANES pixels. The pixels of a row share their lights, those that the tile's
// list has for their square; pairs of a row and a light are taken ABREAST at a time, whatever row they belong to.
//
//   I = ambient·Ka + Σ lights falloff·spot·( Ia·Ka + visibility·( Id·Kd·max(N·L,0) + Is·Ks·(R·V)ⁿ ) ) + emission
//
// or what another model than Phong's puts in the inner brackets, see reflect(); then fog. The sums over the lights leave the
// material out, which is multiplied once at the end. A light that culling may leave out adds exactly zero, so it does not matter
// whether a list holds it.
#include "cook_torrance.clh"
#include "falloff.clh"
#include "features.clh"
#include "fog.clh"
#include "lanes.clh"
#include "long_sum.clh"
#include "math.clh"
#include "phong.clh"
#include "shadow.clh"
#include "shared.h"
#include "toon.clh"

// Whether the picture's model is this one; a program for a single model knows.
#define CHOSEN(compiled, number) ((compiled) && (MODELS == 1 || model == (number)))

#define ROWS ROWS_PER_ITEM(LANES, LIGHT_LISTS)
#define EACH_ROW(row) _Pragma("unroll") for (uint row = 0; row < ROWS; ++row)

// A row of pixels on its way through the lights.
typedef struct {
  intL covered;
  vec3L position, normal;
#if SHADOWS
  vec3L facet;  // the triangle's own normal
  floatL lift;  // metres along the normal to where shadow tests start
#endif
  vec3L to_eye, mirrored_eye;  // unit; mirrored at the normal
  floatL shininess;
  vec3L ambient_sum, diffuse_sum, specular_sum;
#if GRAZING
  Gloss gloss;
  vec3L grazing_sum;
#endif
#if LONG_SUMS
  LongSum long_ambient, long_diffuse, long_specular;  // the sums above are their open blocks,
#if GRAZING
  LongSum long_grazing;
#endif
  intL terms;                                         // of so many terms
  uint fullest;                                       // and none of more than this
#endif
#if OUTPUT_SHADOW
  floatL visible, shadow_lights;
#endif
  uint place;  // of its first pixel in the tile
} Pixels;

#if LIT
// A light and a row of pixels that it may light.
//
// ABREAST pairs go through each stage side by side. Inside a pair every operation waits for the one before, some 130 cycles
// from the light's place to its highlight. A core looks some 200 instructions ahead, which is two pairs: one pair after another
// it would wait half of the time.
typedef struct {
  vec3L to_light;    // from the surface; unit once multiplied by
  floatL inverse_d;  // 1/m
  floatL n_dot_l;
  floatL reach;      // falloff × spot effect
  floatL strength;   // reach × visibility where the surface faces the light, else 0
  floatL diffuse;    // of the strength, the factor of the diffuse colour,
  floatL highlight;  // and of the specular colour
#if GRAZING
  floatL grazing;  // and of what that becomes at a glance
#endif
} Pair;

INLINE void meet_light(Pair *pair, const Pixels *pixels, __global const ShadeLight *light) {
  pair->reach = 1.0f;
  pair->inverse_d = 1.0f;
#if DIRECTIONAL_LIGHTS
#if PLACED_LIGHTS
  if (light->kind == kDirectionalLight)
#endif
  {
    pair->to_light.x = light->position.x;
    pair->to_light.y = light->position.y;
    pair->to_light.z = light->position.z;
  }
#endif
#if PLACED_LIGHTS
#if DIRECTIONAL_LIGHTS
  if (light->kind != kDirectionalLight)
#endif
  {
    vec3L to_light = {light->position.x - pixels->position.x, light->position.y - pixels->position.y,
                      light->position.z - pixels->position.z};
    floatL d2 = SQUARED_LENGTH(to_light.x, to_light.y, to_light.z);
    pair->to_light = to_light;
    pair->inverse_d = rsqrt_lanes(d2);
    pair->reach = distance_falloff(light, d2, pair->inverse_d);
#if SPOT_LIGHTS
#if POINT_LIGHTS || DIRECTIONAL_LIGHTS
    if (light->kind == kSpotLight)
#endif
      pair->reach *= spot_falloff(light, to_light, pair->inverse_d);
#endif
  }
#endif
  pair->n_dot_l = dot3(pixels->normal, pair->to_light) * pair->inverse_d;
}

// The shadow maps of a picture's lights, or with EXACT what is known of each entry of the lists (see classify.cl).
typedef struct {
  __global const ShadowMap *maps;
  __global const ShadowFace *faces;
  __global const ShadowTexel *texels;
  uint texel_count;
  __global const uint *pair_bits;
} Shadows;

#if SHADOWS
// entry: of the lists, that light and pixels were met by.
INLINE void cast_shadow(Pair *pair, Pixels *pixels, __global const ShadeLight *light, const Shadows *shadows, uint entry) {
  if (light->shadow == kNoShadow || !any_lane(pair->strength > 0.0f)) return;
#if EXACT
  uint word = shadows->pair_bits[entry * kPairWords + pixels->place / 32] >> pixels->place % 32;
  floatL visibility = convert_floatL(((intL)((int)word) >> LANE_NUMBERS) & 1);
#else
  MapPoint point = receiver_point(shadows->maps + light->shadow, shadows->faces, pixels->position, pixels->normal,
                                  pixels->facet, pixels->lift);
  floatL visibility = map_lookup(shadows->maps + light->shadow, shadows->faces, shadows->texels, shadows->texel_count, point);
#endif
#if OUTPUT_SHADOW
  floatL counted = pair->strength > 0.0f ? (floatL)(1.0f) : (floatL)(0.0f);
  pixels->visible += visibility * counted;
  pixels->shadow_lights += counted;
#endif
  pair->strength *= visibility;
}
#endif

// What the model makes of ABREAST pairs: all that it has to say. Any finite value will do where the surface faces away, for the
// strength is 0 there.
INLINE void reflect(Pair *pairs, Pixels *const *pixels, uint model) {
  if (CHOSEN(TOON, kToonModel)) {
    EACH_ABREAST(k) pairs[k].diffuse = toon(pairs[k].n_dot_l);
  } else {
    EACH_ABREAST(k) pairs[k].diffuse = max_lanes(pairs[k].n_dot_l, (floatL)(0.0f));
  }
#if SPECULAR
#if GRAZING
  if (CHOSEN(COOK_TORRANCE, kCookTorranceModel)) {
    EACH_ABREAST(k) {
      const Pixels *at = pixels[k];
      vec3L to_light = scale3(pairs[k].to_light, pairs[k].inverse_d);
      Glint glint = cook_torrance(at->gloss, at->normal, to_light, at->to_eye, pairs[k].n_dot_l);
      pairs[k].highlight = glint.facing;
      pairs[k].grazing = glint.grazing;
    }
    return;
  }
  EACH_ABREAST(k) pairs[k].grazing = 0.0f;
#endif
  // pow_one_minus_half(), a step at a time.
  floatL spread[ABREAST], log2_cosine[ABREAST];
  if (CHOSEN(BLINN_PHONG, kBlinnPhongModel)) {
    EACH_ABREAST(k) spread[k] = blinn_spread(pairs[k].to_light, pairs[k].inverse_d, pixels[k]->to_eye, pixels[k]->normal);
  } else {
    EACH_ABREAST(k) spread[k] = phong_spread(pairs[k].to_light, pairs[k].inverse_d, pixels[k]->mirrored_eye);
  }
  EACH_ABREAST(k) log2_cosine[k] = log2_one_minus_half(spread[k]);
  EACH_ABREAST(k) pairs[k].highlight = exp2_product(pixels[k]->shininess, log2_cosine[k]);
  if (CHOSEN(TOON, kToonModel)) {
    EACH_ABREAST(k) pairs[k].highlight = toon_highlight(pairs[k].highlight);
  }
#endif
}

#if LONG_SUMS
// Closes the blocks that are full.
INLINE void close_full_blocks(Pixels *pixels) {
  intL full = pixels->terms >= kSumBlock;
  close_block(&pixels->long_ambient, &pixels->ambient_sum, full);
  close_block(&pixels->long_diffuse, &pixels->diffuse_sum, full);
  close_block(&pixels->long_specular, &pixels->specular_sum, full);
#if GRAZING
  close_block(&pixels->long_grazing, &pixels->grazing_sum, full);
#endif
  pixels->terms = full ? (intL)(0) : pixels->terms;
  pixels->fullest = (uint)largest_lane(pixels->terms);
}

// Makes room for one more term, and counts it.
INLINE void count_term(Pixels *pixels, const Pair *pair) {
  if (pixels->fullest == kSumBlock) close_full_blocks(pixels);
  pixels->fullest += 1;
#if LIGHT_AMBIENT
  pixels->terms += pair->reach > 0.0f ? (intL)(1) : (intL)(0);
#else
  pixels->terms += pair->strength > 0.0f ? (intL)(1) : (intL)(0);
#endif
}
#endif

INLINE void add_pair(Pixels *pixels, const Pair *pair, __global const ShadeLight *light) {
#if LIGHT_AMBIENT
  add_scaled(&pixels->ambient_sum, light->ambient, pair->reach);
#endif
  add_scaled(&pixels->diffuse_sum, light->diffuse, pair->strength * pair->diffuse);
#if SPECULAR
  add_scaled(&pixels->specular_sum, light->specular, pair->strength * pair->highlight);
#endif
#if GRAZING
  add_scaled(&pixels->grazing_sum, light->specular, pair->strength * pair->grazing);
#endif
}

// Adds the first `count` of ABREAST pairs, which are all there: light[k] and the row pixels[k], met by entry[k] of the lists.
INLINE void add_lights(Pixels *const *pixels, __global const ShadeLight *const *light, uint count,
                       const uint *entry, const Shadows *shadows, uint model, bool long_sums) {
  Pair pairs[ABREAST];
  intL lit = 0;
  EACH_ABREAST(k) {
    Pair *pair = pairs + k;
    meet_light(pair, pixels[k], light[k]);
    pair->reach = k < count ? pair->reach : (floatL)(0.0f);
    pair->strength = pair->n_dot_l > 0.0f ? pair->reach : (floatL)(0.0f);
#if LIGHT_AMBIENT
    lit |= pair->reach > 0.0f;
#endif
  }
#if SHADOWS
  EACH_ABREAST(k) cast_shadow(pairs + k, pixels[k], light[k], shadows, entry[k]);
#endif
#if !LIGHT_AMBIENT
  EACH_ABREAST(k) lit |= pairs[k].strength > 0.0f;
#endif
  if (!any_lane(lit)) return;
  reflect(pairs, pixels, model);
#if LONG_SUMS
  if (long_sums) {
    EACH_ABREAST(k) {
      count_term(pixels[k], pairs + k);
      add_pair(pixels[k], pairs + k, light[k]);
    }
    return;
  }
#endif
  EACH_ABREAST(k) add_pair(pixels[k], pairs + k, light[k]);
}
#endif

// What a row of pixels starts from. Uncovered lanes compute along on a point ahead of the eye and are dropped at the end.
INLINE void start_row(Pixels *pixels, ShadeFrame frame, uint first, __global const float *position,
                      __global const float *normal, __global const float *specular, __global const uint *facet,
                      __global const float *lift, bool long_sums) {
  uint stride = frame.plane_stride;
  pixels->position = load_vec3(position + first, stride);
  pixels->covered = pixels->position.z > -INFINITY;
  pixels->place = first % kTilePixels;
  pixels->position.z = pixels->covered ? pixels->position.z : (floatL)(-1.0f);
#if OUTPUT_SHADOW
  pixels->visible = 0.0f;
  pixels->shadow_lights = 0.0f;
#endif
#if LIT
  vec3L dark = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
  pixels->ambient_sum = dark;
  pixels->diffuse_sum = dark;
  pixels->specular_sum = dark;
#if GRAZING
  pixels->grazing_sum = dark;
#endif
#if LONG_SUMS
  if (long_sums) {
    LongSum nothing = {dark, dark};
    pixels->long_ambient = nothing;
    pixels->long_diffuse = nothing;
    pixels->long_specular = nothing;
#if GRAZING
    pixels->long_grazing = nothing;
#endif
    pixels->terms = 0;
    pixels->fullest = 0;
  }
#endif
  pixels->normal = load_vec3(normal + first, stride);
#if SHADOWS
  pixels->facet = unpack_normal(*(__global const intL *)(facet + first));
  pixels->lift = LIFT ? load_lanes(lift + first) : (floatL)(0.0f);
#endif
#if SPECULAR
  pixels->shininess = load_lanes(specular + first + 3 * stride);
#if PARALLEL_VIEW
  pixels->to_eye.x = frame.eye.x - frame.eye.w * pixels->position.x;
  pixels->to_eye.y = frame.eye.y - frame.eye.w * pixels->position.y;
  pixels->to_eye.z = frame.eye.z - frame.eye.w * pixels->position.z;
#else
  pixels->to_eye = scale3(pixels->position, (floatL)(-1.0f));
#endif
  pixels->to_eye = normalize_lanes(pixels->to_eye);
  pixels->mirrored_eye = mirror(pixels->to_eye, pixels->normal);
#endif
#if GRAZING
  pixels->gloss = cook_torrance_gloss(pixels->shininess, dot3(pixels->normal, pixels->to_eye));
#endif
#endif
}

// The colour of a row of pixels, its lights summed.
INLINE vec3L finish_row(Pixels *pixels, ShadeFrame frame, uint first, __global const float *diffuse,
                        __global const float *specular, __global const float *ambient, __global const float *emission,
                        bool long_sums) {
  vec3L seen = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
#if LIT
#if LONG_SUMS
  if (long_sums) {
    // A block that is just full is closed even where no more lights come: lights that add nothing must not decide it.
    close_full_blocks(pixels);
    finish_sum(pixels->long_ambient, &pixels->ambient_sum);
    finish_sum(pixels->long_diffuse, &pixels->diffuse_sum);
    finish_sum(pixels->long_specular, &pixels->specular_sum);
#if GRAZING
    finish_sum(pixels->long_grazing, &pixels->grazing_sum);
#endif
  }
#endif
  vec3L kd = load_vec3(diffuse + first, frame.plane_stride);
  seen.x += pixels->diffuse_sum.x * kd.x;
  seen.y += pixels->diffuse_sum.y * kd.y;
  seen.z += pixels->diffuse_sum.z * kd.z;
#if SPECULAR
  vec3L ks = load_vec3(specular + first, frame.plane_stride);
  seen.x += pixels->specular_sum.x * ks.x;
  seen.y += pixels->specular_sum.y * ks.y;
  seen.z += pixels->specular_sum.z * ks.z;
#endif
#if GRAZING
  seen.x += pixels->grazing_sum.x * grazing_color(ks.x);
  seen.y += pixels->grazing_sum.y * grazing_color(ks.y);
  seen.z += pixels->grazing_sum.z * grazing_color(ks.z);
#endif
#endif
#if AMBIENT
  vec3L ka = load_vec3(ambient + first, frame.plane_stride);
  vec3L light = {(floatL)(frame.ambient.x), (floatL)(frame.ambient.y), (floatL)(frame.ambient.z)};
#if LIT && LIGHT_AMBIENT
  light.x += pixels->ambient_sum.x;
  light.y += pixels->ambient_sum.y;
  light.z += pixels->ambient_sum.z;
#endif
  seen.x += light.x * ka.x;
  seen.y += light.y * ka.y;
  seen.z += light.z * ka.z;
#endif
#if EMISSION
  vec3L ke = load_vec3(emission + first, frame.plane_stride);
  seen.x += ke.x;
  seen.y += ke.y;
  seen.z += ke.z;
#endif
#if FOG
  seen = apply_fog(frame, seen, pixels->position);
#endif
  return seen;
}

// Pairs that wait for their turn at most; a single lane takes each as it comes.
#define QUEUE (LANES == 1 ? 1 : 128)

// image: r, g, b planes of frame.plane_stride floats, then the share of shadowed lights that is visible if OUTPUT_SHADOW.
// facet: by packNormal(), read only if SHADOWS; lift: metres, only with LIFT too. list_starts, list: see cull.cl; an entry of the list indexes `lights`.
__kernel void shade(ShadeFrame frame, __global const float *position, __global const float *normal,
                    __global const float *diffuse, __global const float *specular, __global const float *ambient,
                    __global const float *emission, __global const uint *facet, __global const float *lift,
                    __global const ShadeLight *lights, __global const uint *list_starts, __global const ListEntry *list, __global const ShadowMap *shadow_maps,
                    __global const ShadowFace *shadow_faces, __global const ShadowTexel *shadow_texels,
                    __global const uint *pair_bits, __global float *image) {
#if LIT
  Shadows shadows = {shadow_maps, shadow_faces, shadow_texels, frame.texel_count, pair_bits};
#endif
  uint first = get_global_id(0) * (ROWS * LANES);
  uint stride = frame.plane_stride;
#if LIGHT_LISTS
  uint tile = first / kTilePixels;
  uint entry = list_starts[tile], end = list_starts[tile + 1];
#else
  uint entry = 0, end = frame.light_count;
#endif
  // No block can be full before.
  bool long_sums = end - entry > kSumBlock;
  Pixels rows[ROWS];
  uint square[ROWS];  // of each row, as a bit; none for background
  EACH_ROW(row) {
    uint pixel = first + row * LANES;
    start_row(rows + row, frame, pixel, position, normal, specular, facet, lift, long_sums);
    square[row] = any_lane(rows[row].covered) ? 1u << SQUARE_OF_PIXEL(pixel) : 0;
  }
  // While the lights are summed, memory brings what comes next.
  uint next = first + ROWS * LANES;
  if (next + ROWS * LANES <= stride) {
    prefetch_lanes(position + next, stride, 3, ROWS);
#if LIT
    prefetch_lanes(normal + next, stride, 3, ROWS);
    prefetch_lanes(diffuse + next, stride, 3, ROWS);
#if SHADOWS
    prefetch_lanes((__global const float *)facet + next, stride, 1, ROWS);
#if LIFT
    prefetch_lanes(lift + next, stride, 1, ROWS);
#endif
#endif
#if SPECULAR
    prefetch_lanes(specular + next, stride, 4, ROWS);
#endif
#endif
#if AMBIENT
    prefetch_lanes(ambient + next, stride, 3, ROWS);
#endif
#if EMISSION
    prefetch_lanes(emission + next, stride, 3, ROWS);
#endif
  }
#if LIT
  uint light_of[QUEUE], row_of[QUEUE], entry_of[QUEUE];
  while (entry < end) {
    uint pairs = 0;
    for (; entry < end && pairs + ROWS <= QUEUE; ++entry) {
#if LIGHT_LISTS
      uint light = list[entry].light, squares = list[entry].squares;
#else
      uint light = entry, squares = 0xffffffff;
#endif
      EACH_ROW(row) {
        light_of[pairs] = light;
        row_of[pairs] = row;
#if EXACT
        entry_of[pairs] = LIGHT_LISTS ? entry : first / kTilePixels * frame.light_count + entry;
#endif
        pairs += (squares & square[row]) ? 1 : 0;
      }
    }
    for (uint pair = 0; pair < pairs; pair += ABREAST) {
      Pixels *pixels[ABREAST];
      __global const ShadeLight *light[ABREAST];
      uint met_by[ABREAST];
      EACH_ABREAST(k) {
        uint at = min(pair + k, pairs - 1);
        pixels[k] = rows + (ROWS == 1 ? 0 : row_of[at]);
        light[k] = lights + light_of[at];
        met_by[k] = EXACT ? entry_of[at] : 0;
      }
      add_lights(pixels, light, pairs - pair, met_by, &shadows, frame.model, long_sums);
    }
  }
#endif
  EACH_ROW(row) {
    Pixels *pixels = rows + row;
    uint pixel = first + row * LANES;
    vec3L color = {(floatL)(frame.background.x), (floatL)(frame.background.y), (floatL)(frame.background.z)};
    if (square[row]) {
      vec3L seen = finish_row(pixels, frame, pixel, diffuse, specular, ambient, emission, long_sums);
      color.x = pixels->covered ? finite_color(seen.x) : color.x;
      color.y = pixels->covered ? finite_color(seen.y) : color.y;
      color.z = pixels->covered ? finite_color(seen.z) : color.z;
    }
    stream_lanes(image + pixel, color.x);
    stream_lanes(image + pixel + stride, color.y);
    stream_lanes(image + pixel + 2 * stride, color.z);
#if OUTPUT_SHADOW
    // No shadowed light facing the surface: fully visible.
    floatL share = pixels->visible / max_lanes(pixels->shadow_lights, (floatL)(1.0f));
    stream_lanes(image + pixel + 3 * stride, pixels->shadow_lights > 0.0f ? share : (floatL)(1.0f));
#endif
  }
}
