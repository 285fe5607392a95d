// Lights a G-buffer. One work-item shades a row of LANES pixels; a tile's rows share its light list.
//
//   I = ambient·Ka + Σ lights falloff·spot·( Ia·Ka + visibility·( Id·Kd·max(N·L,0) + Is·Ks·(R·V)ⁿ ) ) + emission
//
// then fog. The sums over the lights leave the material out, which is multiplied once at the end. A light out of range adds
// exactly zero, so it does not matter whether a list holds it.
#include "falloff.clh"
#include "features.clh"
#include "fog.clh"
#include "lanes.clh"
#include "long_sum.clh"
#include "math.clh"
#include "phong.clh"
#include "shadow.clh"
#include "shared.h"

// A row of pixels on its way through the lights.
typedef struct {
  vec3L position, normal, to_eye;
  floatL shininess;
  vec3L ambient_sum, diffuse_sum, specular_sum;
#if LONG_SUMS
  LongSum long_ambient, long_diffuse, long_specular;  // the sums above are their open blocks,
  intL terms;                                         // of so many terms
#endif
#if OUTPUT_SHADOW
  floatL visible, shadow_lights;
#endif
} Pixels;

#if LIT
INLINE void add_light(Pixels *pixels, __global const ShadeLight *light, __global const ShadowMap *shadow_maps,
                      __global const float *shadow_depths, uint blinn) {
  vec3L to_light;
  floatL strength = 1.0f;
#if DIRECTIONAL_LIGHTS
#if PLACED_LIGHTS
  if (light->kind == kDirectionalLight)
#endif
  {
    to_light.x = light->position.x;
    to_light.y = light->position.y;
    to_light.z = light->position.z;
  }
#endif
#if PLACED_LIGHTS
#if DIRECTIONAL_LIGHTS
  if (light->kind != kDirectionalLight)
#endif
  {
    to_light.x = light->position.x - pixels->position.x;
    to_light.y = light->position.y - pixels->position.y;
    to_light.z = light->position.z - pixels->position.z;
    floatL d2 = SQUARED_LENGTH(to_light.x, to_light.y, to_light.z);
    floatL inverse_d = rsqrt_lanes(d2);
    to_light = scale3(to_light, inverse_d);
    strength = distance_falloff(light, d2, inverse_d);
#if SPOT_LIGHTS
#if POINT_LIGHTS || DIRECTIONAL_LIGHTS
    if (light->kind == kSpotLight)
#endif
      strength *= spot_falloff(light, to_light);
#endif
  }
#endif
#if LIGHT_AMBIENT
  add_scaled(&pixels->ambient_sum, light->ambient, strength);
#if LONG_SUMS
  pixels->terms += strength > 0.0f ? (intL)(1) : (intL)(0);
#endif
#endif
  floatL n_dot_l = dot3(pixels->normal, to_light);
  intL facing = n_dot_l > 0.0f;
  strength = facing ? strength : (floatL)(0.0f);
#if SHADOWS
  if (light->shadow != kNoShadow && any_lane(strength > 0.0f)) {
    floatL visibility = light_visibility(shadow_maps + light->shadow, shadow_depths, pixels->position, pixels->normal,
                                         n_dot_l);
#if OUTPUT_SHADOW
    floatL counted = strength > 0.0f ? (floatL)(1.0f) : (floatL)(0.0f);
    pixels->visible += visibility * counted;
    pixels->shadow_lights += counted;
#endif
    strength *= visibility;
  }
#endif
  if (!any_lane(strength > 0.0f)) return;
#if LONG_SUMS && !LIGHT_AMBIENT
  pixels->terms += strength > 0.0f ? (intL)(1) : (intL)(0);
#endif
  add_scaled(&pixels->diffuse_sum, light->diffuse, strength * max_lanes(n_dot_l, (floatL)(0.0f)));
#if SPECULAR
  floatL highlight;
#if PHONG_SPECULAR
#if BLINN_SPECULAR
  if (!blinn)
#endif
    highlight = phong_lobe(pixels->normal, to_light, n_dot_l, pixels->to_eye, pixels->shininess);
#endif
#if BLINN_SPECULAR
#if PHONG_SPECULAR
  if (blinn)
#endif
    highlight = blinn_lobe(pixels->normal, to_light, pixels->to_eye, pixels->shininess);
#endif
  add_scaled(&pixels->specular_sum, light->specular, strength * highlight);
#endif
}

#if LONG_SUMS
// Closes the blocks that are full. Returns one more than the terms of the fullest block then.
INLINE uint close_full_blocks(Pixels *pixels) {
  intL full = pixels->terms >= kSumBlock;
  close_block(&pixels->long_ambient, &pixels->ambient_sum, full);
  close_block(&pixels->long_diffuse, &pixels->diffuse_sum, full);
  close_block(&pixels->long_specular, &pixels->specular_sum, full);
  pixels->terms = full ? (intL)(0) : pixels->terms;
  return (uint)largest_lane(pixels->terms) + 1;
}
#endif
#endif

// image: r, g, b planes of frame.plane_stride floats, then the share of shadowed lights that is visible if OUTPUT_SHADOW.
// list_starts: a tile's entries in `list` are [list_starts[tile], list_starts[tile + 1]); an entry indexes `lights`.
__kernel void shade(ShadeFrame frame, __global const float *position, __global const float *normal,
                    __global const float *diffuse, __global const float *specular, __global const float *ambient,
                    __global const float *emission, __global const ShadeLight *lights, __global const uint *list_starts,
                    __global const uint *list, __global const ShadowMap *shadow_maps, __global const float *shadow_depths,
                    __global float *image) {
  uint first = get_global_id(0) * LANES;
  uint stride = frame.plane_stride;
  Pixels pixels;
  pixels.position = load_vec3(position + first, stride);
  intL covered = pixels.position.z > -INFINITY;
  vec3L color = {(floatL)(frame.background.x), (floatL)(frame.background.y), (floatL)(frame.background.z)};
#if OUTPUT_SHADOW
  pixels.visible = 0.0f;
  pixels.shadow_lights = 0.0f;
#endif
  if (any_lane(covered)) {
    // Uncovered lanes compute along on a point ahead of the eye and are dropped at the end.
    pixels.position.z = covered ? pixels.position.z : (floatL)(-1.0f);
    vec3L seen = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
#if LIT
    pixels.ambient_sum = seen;
    pixels.diffuse_sum = seen;
    pixels.specular_sum = seen;
#if LONG_SUMS
    LongSum nothing = {seen, seen};
    pixels.long_ambient = nothing;
    pixels.long_diffuse = nothing;
    pixels.long_specular = nothing;
    pixels.terms = 0;
    uint fullest = 0;  // no block has more terms
#endif
    pixels.normal = load_vec3(normal + first, stride);
#if SPECULAR
    pixels.shininess = load_lanes(specular + first + 3 * stride);
#if PARALLEL_VIEW
    pixels.to_eye.x = frame.eye.x - frame.eye.w * pixels.position.x;
    pixels.to_eye.y = frame.eye.y - frame.eye.w * pixels.position.y;
    pixels.to_eye.z = frame.eye.z - frame.eye.w * pixels.position.z;
#else
    pixels.to_eye = scale3(pixels.position, (floatL)(-1.0f));
#endif
    pixels.to_eye = normalize_lanes(pixels.to_eye);
#endif
#if LIGHT_LISTS
    uint tile = first / kTilePixels;
    uint entry = list_starts[tile], end = list_starts[tile + 1];
#else
    uint entry = 0, end = frame.light_count;
#endif
    for (; entry < end; ++entry) {
#if LONG_SUMS
      if (++fullest > kSumBlock) fullest = close_full_blocks(&pixels);
#endif
#if LIGHT_LISTS
      add_light(&pixels, lights + list[entry], shadow_maps, shadow_depths, frame.blinn);
#else
      add_light(&pixels, lights + entry, shadow_maps, shadow_depths, frame.blinn);
#endif
    }
#if LONG_SUMS
    finish_sum(pixels.long_ambient, &pixels.ambient_sum);
    finish_sum(pixels.long_diffuse, &pixels.diffuse_sum);
    finish_sum(pixels.long_specular, &pixels.specular_sum);
#endif
    vec3L kd = load_vec3(diffuse + first, stride);
    seen.x += pixels.diffuse_sum.x * kd.x;
    seen.y += pixels.diffuse_sum.y * kd.y;
    seen.z += pixels.diffuse_sum.z * kd.z;
#if SPECULAR
    vec3L ks = load_vec3(specular + first, stride);
    seen.x += pixels.specular_sum.x * ks.x;
    seen.y += pixels.specular_sum.y * ks.y;
    seen.z += pixels.specular_sum.z * ks.z;
#endif
#endif
#if AMBIENT
    vec3L ka = load_vec3(ambient + first, stride);
    vec3L light = {(floatL)(frame.ambient.x), (floatL)(frame.ambient.y), (floatL)(frame.ambient.z)};
#if LIT && LIGHT_AMBIENT
    light.x += pixels.ambient_sum.x;
    light.y += pixels.ambient_sum.y;
    light.z += pixels.ambient_sum.z;
#endif
    seen.x += light.x * ka.x;
    seen.y += light.y * ka.y;
    seen.z += light.z * ka.z;
#endif
#if EMISSION
    vec3L ke = load_vec3(emission + first, stride);
    seen.x += ke.x;
    seen.y += ke.y;
    seen.z += ke.z;
#endif
#if FOG
    seen = apply_fog(frame, seen, pixels.position);
#endif
    color.x = covered ? finite_color(seen.x) : color.x;
    color.y = covered ? finite_color(seen.y) : color.y;
    color.z = covered ? finite_color(seen.z) : color.z;
  }
  store_lanes(image + first, color.x);
  store_lanes(image + first + stride, color.y);
  store_lanes(image + first + 2 * stride, color.z);
#if OUTPUT_SHADOW
  // No shadowed light facing the surface: fully visible.
  floatL share = pixels.visible / max_lanes(pixels.shadow_lights, (floatL)(1.0f));
  store_lanes(image + first + 3 * stride, pixels.shadow_lights > 0.0f ? share : (floatL)(1.0f));
#endif
}
