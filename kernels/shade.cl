// Shading: lights a G-buffer.
//
//   I = ambient·Ka + Σ lights falloff·spot·( Ia·Ka + visibility·( Id·Kd·max(N·L,0) + Is·Ks·(R·V)ⁿ ) ) + emission
//
// seen through fog. Other models than Phong's change the inner brackets (reflect()). The sums over the lights leave the material
// out: it is multiplied once at the end.
//
// In: the planes of a G-buffer, tile by tile (view space, metres, linear colours), and for each tile the list of its lights
// (cull.cl).
// Out: 3 planes of linear colour, a float for each pixel, and one more with OUTPUT_SHADOW.
// A work-item shades ROWS rows of LANES pixels. The pixels of a row share their lights: those that the list has for their 4×4
// square. Pairs of a row and a light are taken ABREAST at a time, whatever row they belong to.
// Cost: some 130 instructions for a pair of LANES pixels and a light without a shadow. A lookup in a shadow map costs about as much
// again for each texel that it reads.
// A light that culling may leave out adds exactly zero: the picture does not depend on whether a list holds it.
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

#define ROWS ROWS_PER_ITEM(LANES, LIGHT_LISTS)
#define EACH_ROW(row) _Pragma("unroll") for (uint row = 0; row < ROWS; ++row)

// Whether the picture's model is this one: known at compile time where the program has only one model.
#define MODEL_IS(number) IS(HAS_MODEL(number), MODELS & (MODELS - 1), model == (number))

// The light that a row of pixels reflects, in one sum for each of the material's colours, which multiply the sums at the end. Sums
// that a program doesn't use are never touched.
enum { kAmbientPart, kDiffusePart, kSpecularPart, kGrazingPart, kParts };
#define USES_PART(part)                                                                                              \
  ((part) == kDiffusePart || ((part) == kAmbientPart && LIGHT_AMBIENT) || ((part) == kSpecularPart && SPECULAR) || \
   ((part) == kGrazingPart && GRAZING))
#define EACH_PART(part) _Pragma("unroll") for (uint part = 0; part < kParts; ++part) if (USES_PART(part))

typedef struct {
  vec3L part[kParts];
  // With LONG_SUMS the parts above are the open blocks of these sums.
  LongSum closed[kParts];
  intL terms;    // how many terms each lane's open block has
  uint fullest;  // upper bound of `terms` over the lanes
} LightSums;

// A row of pixels on its way through the lights. View space, metres.
typedef struct {
  intL covered;
  vec3L position, normal;
  vec3L geometric_normal;      // the triangle's own, with SHADOWS
  floatL lift;                 // along the normal to where shadow tests start, with SHADOWS
  vec3L to_eye, mirrored_eye;  // unit; mirrored at the normal
  floatL shininess;
  Gloss gloss;
  LightSums sums;
  floatL visible, shadow_lights;  // with OUTPUT_SHADOW: sum of visibilities, and of how many lights with shadows
  uint place;                     // of the first pixel in its tile
} Pixels;

// A light and a row of pixels that it may light.
//
// ABREAST pairs go through each stage side by side. Inside a pair every operation waits for the one before, some 130 cycles
// from the light's place to its highlight. A core looks some 200 instructions ahead, which is two pairs: one pair after another
// it would wait half of the time.
typedef struct {
  vec3L to_light;      // from the surface to the light, metres; unit for directional lights
  floatL inverse_d;    // the reciprocal of its length
  floatL n_dot_l;
  floatL attenuation;  // falloff × spot effect
  floatL strength;     // attenuation × visibility where the surface faces the light, else 0
  floatL diffuse;      // factors of the strength: for the diffuse colour,
  floatL highlight;    // for the specular colour,
  floatL grazing;      // and for the specular colour at grazing angles (grazing_color)
} Pair;

// The shadow maps of a picture's lights, or with EXACT the bits of each entry of the lists (classify.cl), after unsure ones were
// traced.
typedef struct {
  __global const ShadowMap *maps;
  __global const ShadowFace *faces;
  __global const ShadowTexel *texels;
  uint texel_count;
  __global const uint *pair_bits;
} Shadows;

INLINE vec3L all_lanes(float4 v) {
  vec3L all = {(floatL)(v.x), (floatL)(v.y), (floatL)(v.z)};
  return all;
}

// *sum += a·b for each channel.
INLINE void add_product(vec3L *sum, vec3L a, vec3L b) {
  sum->x = fma_lanes(a.x, b.x, sum->x);
  sum->y = fma_lanes(a.y, b.y, sum->y);
  sum->z = fma_lanes(a.z, b.z, sum->z);
}

INLINE void incident_light(Pair *pair, const Pixels *pixels, __global const ShadeLight *light) {
  if (IS(DIRECTIONAL_LIGHTS, PLACED_LIGHTS, light->kind == kDirectionalLight)) {
    pair->to_light = all_lanes(light->position);
    pair->inverse_d = 1.0f;
    pair->attenuation = 1.0f;
  } else {
    vec3L to_light = {light->position.x - pixels->position.x, light->position.y - pixels->position.y,
                      light->position.z - pixels->position.z};
    floatL d2 = SQUARED_LENGTH(to_light.x, to_light.y, to_light.z);
    pair->to_light = to_light;
    pair->inverse_d = rsqrt_lanes(d2);
    pair->attenuation = distance_falloff(light, d2, pair->inverse_d);
    if (IS(SPOT_LIGHTS, POINT_LIGHTS || DIRECTIONAL_LIGHTS, light->kind == kSpotLight))
      pair->attenuation *= spot_falloff(light, to_light, pair->inverse_d);
  }
  pair->n_dot_l = dot3(pixels->normal, pair->to_light) * pair->inverse_d;
}

// The share of the light that reaches the pixels, in [0, 1]. entry: index of the list entry that named the light, read with EXACT
// only.
INLINE floatL visibility(const Pixels *pixels, __global const ShadeLight *light, const Shadows *shadows, uint entry) {
  if (EXACT) {
    uint word = shadows->pair_bits[entry * kPairWords + pixels->place / 32] >> pixels->place % 32;
    return convert_floatL(((intL)((int)word) >> LANE_NUMBERS) & 1);
  }
  __global const ShadowMap *map = shadows->maps + light->shadow;
  MapPoint point = receiver_point(map, shadows->faces, pixels->position, pixels->normal, pixels->geometric_normal, pixels->lift);
  return map_lookup(map, shadows->faces, shadows->texels, shadows->texel_count, point);
}

// Multiplies a pair's strength by its visibility.
INLINE void apply_shadow(Pair *pair, Pixels *pixels, __global const ShadeLight *light, const Shadows *shadows, uint entry) {
  intL faces_light = pair->strength > 0.0f;
  if (light->shadow == kNoShadow || !any_lane(faces_light)) return;
  floatL visible = visibility(pixels, light, shadows, entry);
  pair->strength *= visible;
  if (OUTPUT_SHADOW) {
    floatL counted = faces_light ? (floatL)(1.0f) : (floatL)(0.0f);
    pixels->visible = fma_lanes(visible, counted, pixels->visible);
    pixels->shadow_lights += counted;
  }
}

// Sets the factors diffuse, highlight and grazing of ABREAST pairs as the model has them. Where the surface faces away from the
// light any finite value will do, because the strength is 0 there.
INLINE void reflect(Pair *pairs, Pixels *const *pixels, uint model) {
  if (MODEL_IS(kToonModel)) {
    EACH_ABREAST(k) pairs[k].diffuse = toon(pairs[k].n_dot_l);
  } else {
    EACH_ABREAST(k) pairs[k].diffuse = max_lanes(pairs[k].n_dot_l, (floatL)(0.0f));
  }
  if (!SPECULAR) return;
  if (MODEL_IS(kCookTorranceModel)) {
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
  // pow_one_minus_half() of all pairs, one step of all after another.
  floatL chord2[ABREAST], log2_cosine[ABREAST];
  if (MODEL_IS(kBlinnPhongModel)) {
    EACH_ABREAST(k) chord2[k] = blinn_chord2(pairs[k].to_light, pairs[k].inverse_d, pixels[k]->to_eye, pixels[k]->normal);
  } else {
    EACH_ABREAST(k) chord2[k] = phong_chord2(pairs[k].to_light, pairs[k].inverse_d, pixels[k]->mirrored_eye);
  }
  EACH_ABREAST(k) log2_cosine[k] = log2_one_minus_half(chord2[k]);
  EACH_ABREAST(k) pairs[k].highlight = exp2_product(pixels[k]->shininess, log2_cosine[k]);
  if (MODEL_IS(kToonModel)) {
    EACH_ABREAST(k) pairs[k].highlight = toon_highlight(pairs[k].highlight);
  }
}

INLINE void start_sums(LightSums *sums, bool long_sums) {
  vec3L dark = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
  EACH_PART(part) sums->part[part] = dark;
  if (!long_sums) return;
  LongSum nothing = {dark, dark};
  EACH_PART(part) sums->closed[part] = nothing;
  sums->terms = 0;
  sums->fullest = 0;
}

// Closes the blocks that are full.
INLINE void close_full_blocks(LightSums *sums) {
  intL full = sums->terms >= kSumBlock;
  EACH_PART(part) close_block(&sums->closed[part], &sums->part[part], full);
  sums->terms = full ? (intL)(0) : sums->terms;
  sums->fullest = (uint)largest_lane(sums->terms);
}

INLINE void add_pair(LightSums *sums, const Pair *pair, __global const ShadeLight *light, bool long_sums) {
  if (long_sums) {
    if (sums->fullest == kSumBlock) close_full_blocks(sums);
    sums->fullest += 1;
    sums->terms += (LIGHT_AMBIENT ? pair->attenuation : pair->strength) > 0.0f ? (intL)(1) : (intL)(0);
  }
  if (LIGHT_AMBIENT) add_scaled(&sums->part[kAmbientPart], light->ambient, pair->attenuation);
  add_scaled(&sums->part[kDiffusePart], light->diffuse, pair->strength * pair->diffuse);
  if (SPECULAR) add_scaled(&sums->part[kSpecularPart], light->specular, pair->strength * pair->highlight);
  if (GRAZING) add_scaled(&sums->part[kGrazingPart], light->specular, pair->strength * pair->grazing);
}

INLINE void finish_sums(LightSums *sums, bool long_sums) {
  if (!long_sums) return;
  // A full block is closed even if no light follows. Otherwise a following light that adds nothing would change the rounding.
  close_full_blocks(sums);
  EACH_PART(part) finish_sum(sums->closed[part], &sums->part[part]);
}

// Adds the light of `count` pairs to their rows' sums: light[k] and the row pixels[k], paired by entry[k] of the lists. All ABREAST
// elements must be valid, also those from `count` on, which add nothing.
INLINE void add_lights(Pixels *const *pixels, __global const ShadeLight *const *light, uint count, const uint *entry,
                       const Shadows *shadows, uint model, bool long_sums) {
  Pair pairs[ABREAST];
  EACH_ABREAST(k) {
    Pair *pair = pairs + k;
    incident_light(pair, pixels[k], light[k]);
    pair->attenuation = k < count ? pair->attenuation : (floatL)(0.0f);
    pair->strength = pair->n_dot_l > 0.0f ? pair->attenuation : (floatL)(0.0f);
  }
  if (SHADOWS) {
    // Unrolled, too: lookups of several pairs side by side hide each other's gathers.
    EACH_ABREAST(k) apply_shadow(pairs + k, pixels[k], light[k], shadows, entry[k]);
  }
  intL lit = 0;
  EACH_ABREAST(k) lit |= (LIGHT_AMBIENT ? pairs[k].attenuation : pairs[k].strength) > 0.0f;
  if (!any_lane(lit)) return;
  reflect(pairs, pixels, model);
  EACH_ABREAST(k) add_pair(&pixels[k]->sums, pairs + k, light[k], long_sums);
}

// The planes of a G-buffer, indexed by the place of a pixel. Those that a program doesn't use may be any pointer.
typedef struct {
  __global const float *position, *normal, *diffuse, *specular, *ambient, *emission;
  __global const uint *geometric_normal;
  __global const float *lift;
} Planes;

// Loads what lighting needs of a row of pixels. Lanes that show background compute with a point ahead of the eye, so that nothing
// overflows, and are dropped at the end.
INLINE void start_row(Pixels *pixels, const ShadeFrame *frame, uint first, const Planes *planes, bool long_sums) {
  uint stride = frame->plane_stride;
  pixels->position = load_vec3(planes->position + first, stride);
  pixels->covered = pixels->position.z > -INFINITY;
  pixels->position.z = pixels->covered ? pixels->position.z : (floatL)(-1.0f);
  pixels->place = first % kTilePixels;
  if (OUTPUT_SHADOW) {
    pixels->visible = 0.0f;
    pixels->shadow_lights = 0.0f;
  }
  if (!LIT) return;
  start_sums(&pixels->sums, long_sums);
  pixels->normal = load_vec3(planes->normal + first, stride);
  if (SHADOWS) {
    pixels->geometric_normal = unpack_normal(*(__global const intL *)(planes->geometric_normal + first));
    pixels->lift = LIFT ? load_lanes(planes->lift + first) : (floatL)(0.0f);
  }
  if (!SPECULAR) return;
  pixels->shininess = load_lanes(planes->specular + first + 3 * stride);
  if (PARALLEL_VIEW) {
    pixels->to_eye.x = fma_lanes(-frame->eye.w, pixels->position.x, frame->eye.x);
    pixels->to_eye.y = fma_lanes(-frame->eye.w, pixels->position.y, frame->eye.y);
    pixels->to_eye.z = fma_lanes(-frame->eye.w, pixels->position.z, frame->eye.z);
  } else {
    pixels->to_eye = scale3(pixels->position, (floatL)(-1.0f));
  }
  pixels->to_eye = normalize_lanes(pixels->to_eye);
  pixels->mirrored_eye = mirror(pixels->to_eye, pixels->normal);
  if (GRAZING) pixels->gloss = cook_torrance_gloss(pixels->shininess, dot3(pixels->normal, pixels->to_eye));
}

// The colour of a row of pixels whose lights are summed: times the material, with ambient light and emission, seen through fog.
INLINE vec3L finish_row(Pixels *pixels, const ShadeFrame *frame, uint first, const Planes *planes, bool long_sums) {
  uint stride = frame->plane_stride;
  LightSums *sums = &pixels->sums;
  vec3L seen = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
  if (LIT) {
    finish_sums(sums, long_sums);
    add_product(&seen, sums->part[kDiffusePart], load_vec3(planes->diffuse + first, stride));
    if (SPECULAR) {
      vec3L ks = load_vec3(planes->specular + first, stride);
      add_product(&seen, sums->part[kSpecularPart], ks);
      vec3L grazing = {grazing_color(ks.x), grazing_color(ks.y), grazing_color(ks.z)};
      if (GRAZING) add_product(&seen, sums->part[kGrazingPart], grazing);
    }
  }
  if (AMBIENT) {
    vec3L light = all_lanes(frame->ambient);
    if (LIT && LIGHT_AMBIENT) {
      light.x += sums->part[kAmbientPart].x;
      light.y += sums->part[kAmbientPart].y;
      light.z += sums->part[kAmbientPart].z;
    }
    add_product(&seen, light, load_vec3(planes->ambient + first, stride));
  }
  if (EMISSION) {
    vec3L ke = load_vec3(planes->emission + first, stride);
    seen.x += ke.x;
    seen.y += ke.y;
    seen.z += ke.z;
  }
  return FOG ? apply_fog(*frame, seen, pixels->position) : seen;
}

// Prefetches the rows of the next work-item, so that they arrive while this one sums its lights.
INLINE void prefetch_rows(uint first, uint stride, const Planes *planes) {
  prefetch_lanes(planes->position + first, stride, 3, ROWS);
  if (LIT) {
    prefetch_lanes(planes->normal + first, stride, 3, ROWS);
    prefetch_lanes(planes->diffuse + first, stride, 3, ROWS);
  }
  if (LIT && SHADOWS) prefetch_lanes((__global const float *)planes->geometric_normal + first, stride, 1, ROWS);
  if (LIT && SHADOWS && LIFT) prefetch_lanes(planes->lift + first, stride, 1, ROWS);
  if (LIT && SPECULAR) prefetch_lanes(planes->specular + first, stride, 4, ROWS);
  if (AMBIENT) prefetch_lanes(planes->ambient + first, stride, 3, ROWS);
  if (EMISSION) prefetch_lanes(planes->emission + first, stride, 3, ROWS);
}

// Capacity of the queue of pairs. With a single lane each pair is shaded as it comes.
#define QUEUE (LANES == 1 ? 1 : 128)

// Planes have frame.plane_stride elements each. specular: r, g, b and the shininess; geometric_normal: as packNormal() packs it;
// lift: metres. list_starts, list: see cull.cl; without LIGHT_LISTS every pixel meets all frame.light_count lights.
// image: planes r, g, b, and with OUTPUT_SHADOW a fourth: the mean visibility, in [0, 1], of the lights with shadows that reach the
// pixel's front.
__kernel void shade(ShadeFrame frame, __global const float *position, __global const float *normal,
                    __global const float *diffuse, __global const float *specular, __global const float *ambient,
                    __global const float *emission, __global const uint *geometric_normal, __global const float *lift,
                    __global const ShadeLight *lights, __global const uint *list_starts, __global const ListEntry *list,
                    __global const ShadowMap *shadow_maps, __global const ShadowFace *shadow_faces,
                    __global const ShadowTexel *shadow_texels, __global const uint *pair_bits, __global float *image) {
  Planes planes = {position, normal, diffuse, specular, ambient, emission, geometric_normal, lift};
  Shadows shadows = {shadow_maps, shadow_faces, shadow_texels, frame.texel_count, pair_bits};
  uint first = get_global_id(0) * (ROWS * LANES), tile = first / kTilePixels;
  uint stride = frame.plane_stride;
  uint entry = LIGHT_LISTS ? list_starts[tile] : 0;
  uint end = LIGHT_LISTS ? list_starts[tile + 1] : frame.light_count;
  // With fewer lights than that, one block takes them all.
  bool long_sums = LONG_SUMS && end - entry > kSumBlock;
  Pixels rows[ROWS];
  uint square[ROWS];  // of each row, as a bit; none for background
  EACH_ROW(row) {
    uint pixel = first + row * LANES;
    start_row(rows + row, &frame, pixel, &planes, long_sums);
    square[row] = any_lane(rows[row].covered) ? 1u << SQUARE_OF_PIXEL(pixel) : 0;
  }
  if (first + 2 * ROWS * LANES <= stride) prefetch_rows(first + ROWS * LANES, stride, &planes);

  uint light_of[QUEUE], row_of[QUEUE], entry_of[QUEUE];
  while (LIT && entry < end) {
    uint pairs = 0;
    for (; entry < end && pairs + ROWS <= QUEUE; ++entry) {
      uint light = LIGHT_LISTS ? list[entry].light : entry;
      uint squares = LIGHT_LISTS ? list[entry].squares : 0xffffffff;
      EACH_ROW(row) {
        light_of[pairs] = light;
        row_of[pairs] = row;
        if (EXACT) entry_of[pairs] = LIGHT_LISTS ? entry : tile * frame.light_count + entry;
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

  EACH_ROW(row) {
    Pixels *pixels = rows + row;
    uint pixel = first + row * LANES;
    vec3L color = all_lanes(frame.background);
    if (square[row]) {
      vec3L seen = finish_row(pixels, &frame, pixel, &planes, long_sums);
      color.x = pixels->covered ? finite_color(seen.x) : color.x;
      color.y = pixels->covered ? finite_color(seen.y) : color.y;
      color.z = pixels->covered ? finite_color(seen.z) : color.z;
    }
    stream_lanes(image + pixel, color.x);
    stream_lanes(image + pixel + stride, color.y);
    stream_lanes(image + pixel + 2 * stride, color.z);
    if (OUTPUT_SHADOW) {
      // A pixel that faces no light with a shadow counts as fully visible.
      floatL share = pixels->visible / max_lanes(pixels->shadow_lights, (floatL)(1.0f));
      stream_lanes(image + pixel + 3 * stride, pixels->shadow_lights > 0.0f ? share : (floatL)(1.0f));
    }
  }
}
