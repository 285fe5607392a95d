// What a model of the user's reflects, in double.
#include "truth.clh"

#include "random.clh"
#include "shade/cook_torrance.clh"
#include "shade/oren_nayar.clh"
#include "shade/phong.clh"
#include "shade/surface.clh"
#include "shade/toon.clh"
#include "shade/ward.clh"
#include "user_text.clh"

#ifndef USER_MODEL_COUNT
INLINE Reflection user_reflection(uint number, const Surface* s, vec3L to_light, floatL n_dot_l) {
  Reflection dark = {0, 0, 0};
  return dark;
}
#endif

INLINE vec3L triple_at(__global const double* planes, uint count, uint item) {
  vec3L v = {planes[item], planes[item + count], planes[item + 2 * count]};
  return v;
}

// Of `count` pairs of a surface and a light. surfaces: planes of `count`: the normal, to_light, to_eye and
// the tangent, three each, unit; the diffuse and the specular colour; the shininess. reflections: planes of
// Reflection's members.
KERNEL void model_truth(uint count, uint model, __global const double* surfaces,
                        __global double* reflections) {
  uint item = (uint)work_item();
  if (item >= count) return;
  Surface s;
  s.normal = triple_at(surfaces, count, item);
  vec3L to_light = triple_at(surfaces + 3 * (size_t)count, count, item);
  s.to_eye = triple_at(surfaces + 6 * (size_t)count, count, item);
  s.tangent = triple_at(surfaces + 9 * (size_t)count, count, item);
  s.diffuse = triple_at(surfaces + 12 * (size_t)count, count, item);
  s.specular = triple_at(surfaces + 15 * (size_t)count, count, item);
  s.exponent = surfaces[item + 18 * (size_t)count];
  s.bitangent = cross3(s.normal, s.tangent);
  s.n_dot_v = dot3(s.normal, s.to_eye);
  s.mirrored_eye = mirror(s.to_eye, s.normal);
  s.light_way = to_light;
  s.inverse_light_way = 1;
  Reflection r = user_reflection(model, &s, to_light, dot3(s.normal, to_light));
  reflections[item] = r.diffuse;
  reflections[item + count] = r.specular;
  reflections[item + 2 * (size_t)count] = r.grazing;
}
