// What a model reflects of single lights, by the code that lights pictures: for luciole check-model.
#include "shade/shading.clh"

// Of `stride` pairs of a surface and a light, a multiple of LANES. model: kPhongModel …, or a user's; with
// MATERIAL_MODELS off. surfaces: planes of `stride`: the normal, the way to the light, to_eye and the
// tangent, three each, view space; the diffuse and the specular colour; the shininess; the reciprocal of the
// way's length. reflections: planes: N·L as lights have it; the factors for the diffuse colour, for the
// specular colour and at grazing angles; and the same three as a user's function gave them.
KERNEL void model_probe(uint stride, uint model, __global const float* surfaces,
                        __global float* reflections) {
  uint first = (uint)work_item() * LANES;
  surfaces += first;
  reflections += first;
  Pixels pixels;
  Pixels* row = &pixels;
  Pair pair;
  pixels.normal = load_vec3(surfaces, stride);
  pair.to_light = load_vec3(surfaces + 3 * stride, stride);
  pixels.to_eye = load_vec3(surfaces + 6 * stride, stride);
#if USER_MODEL_COUNT > 0
  pixels.diffuse = load_vec3(surfaces + 12 * stride, stride);
  pixels.specular = load_vec3(surfaces + 15 * stride, stride);
  pixels.tangent = load_vec3(surfaces + 9 * stride, stride);
  pixels.bitangent = cross3(pixels.normal, pixels.tangent);
#endif
  floatL shininess = load_lanes(surfaces + 18 * stride);
  pair.inverse_d = load_lanes(surfaces + 19 * stride);
  pair.n_dot_l = max_lanes(dot3(pixels.normal, pair.to_light) * pair.inverse_d, (floatL)(0.0f));
  pair.strength = 1.0f;
  set_gloss(&pixels, shininess, model);
  start_sums(&pixels.sums, false);
  reflect(1, &pair, &row, model);
  store_lanes(reflections, pair.n_dot_l);
  store_lanes(reflections + stride, pair.diffuse);
  store_lanes(reflections + 2 * stride, SPECULAR ? pair.highlight : (floatL)(0.0f));
  store_lanes(reflections + 3 * stride, GRAZING ? pair.grazing : (floatL)(0.0f));
#if USER_MODEL_COUNT > 0
  Surface s = surface_of(&pixels, &pair);
  Reflection r =
      user_reflection(model - kModelCount, &s, scale3(pair.to_light, pair.inverse_d), pair.n_dot_l);
  store_lanes(reflections + 4 * stride, r.diffuse);
  store_lanes(reflections + 5 * stride, r.specular);
  store_lanes(reflections + 6 * stride, r.grazing);
#endif
}
