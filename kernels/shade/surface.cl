// Changes the surfaces of a G-buffer by functions of the user's (user_text.clh), before they are lit.
//
// In and out: the planes of a G-buffer. A work-item takes a row of LANES pixels. What a function leaves as it
// is keeps its bits, also the normal, which it sees turned to the world. Cost: the function's own, and
// reading and writing the planes once.
#include "lanes.clh"
#include "math.clh"
#include "quotient.clh"
#include "random.clh"
#include "shade/noise.clh"
#include "shade/surface.clh"
#include "shade/tangents.clh"
#include "shared.h"
#include "user_text.clh"

#ifndef USER_SURFACES
INLINE void user_surface(Surface* s) {}
#endif

// A number of a material's that a function may have changed. What is negative becomes 0, what is no number
// the number before, both with a mark; so small a number that its products could be denormals becomes 0.
INLINE floatL changed_number(floatL now, floatL before, intL* faulty) {
  intL same = now == before, usable = (now >= 0.0f) & (now <= 0x1p100f), negative = now < 0.0f;
  *faulty |= !same & !usable;
  floatL kept = negative ? (floatL)(0.0f) : before;
  floatL number = usable ? (now >= 0x1p-80f ? now : (floatL)(0.0f)) : kept;
  return same ? before : number;
}

// The same for a colour, stored where it is wanted.
INLINE void store_color(vec3L now, vec3L before, intL covered, intL* faulty, __global float* p, uint stride) {
  vec3L number = {changed_number(now.x, before.x, faulty), changed_number(now.y, before.y, faulty),
                  changed_number(now.z, before.z, faulty)};
  store_lanes(p, covered ? number.x : before.x);
  store_lanes(p + stride, covered ? number.y : before.y);
  store_lanes(p + 2 * stride, covered ? number.z : before.z);
}

INLINE vec3L to_world(const SurfaceFrame* frame, vec3L v) {
  vec3L world = {dot3s(v, frame->to_world_x), dot3s(v, frame->to_world_y), dot3s(v, frame->to_world_z)};
  return world;
}

INLINE vec3L to_view(const SurfaceFrame* frame, vec3L v) {
  float4 x = frame->to_world_x, y = frame->to_world_y, z = frame->to_world_z;
  vec3L view = {fma_lanes((floatL)(z.x), v.z, fma_lanes((floatL)(x.x), v.x, y.x * v.y)),
                fma_lanes((floatL)(z.y), v.z, fma_lanes((floatL)(x.y), v.x, y.y * v.y)),
                fma_lanes((floatL)(z.z), v.z, fma_lanes((floatL)(x.z), v.x, y.z * v.y))};
  return view;
}

// frame.given: the groups that the G-buffer has, frame.changed: those that are written to `new_…`, as bits
// kNormalGroup …; others may be any pointer, and count as zeros. Planes have frame.plane_stride elements
// each, as in shade.cl; uv: u, v; object, material: indices. new_lift goes with new_normal. faulty_pixels:
// raised by the number of pixels to which the functions gave a number below 0, no number, or no direction.
KERNEL void surface(SurfaceFrame frame, __global const float* position, __global const float* normal,
                    __global const float* diffuse, __global const float* specular,
                    __global const float* ambient, __global const float* emission, __global const float* lift,
                    __global const uint* tangent, __global const float* uv, __global const uint* object,
                    __global const uint* material, __global float* new_normal, __global float* new_diffuse,
                    __global float* new_specular, __global float* new_ambient, __global float* new_emission,
                    __global float* new_lift, __global uint* faulty_pixels) {
  uint first = work_item() * LANES, stride = frame.plane_stride, given = frame.given;
  vec3L p = load_vec3(position + first, stride);
  intL covered = p.z > -INFINITY;
  p.z = covered ? p.z : (floatL)(-1.0f);
  vec3L none = {(floatL)(0.0f), (floatL)(0.0f), (floatL)(0.0f)};
  vec3L n = load_vec3(normal + first, stride);
  vec3L eye = {fma_lanes((floatL)(-frame.eye.w), p.x, (floatL)(frame.eye.x)),
               fma_lanes((floatL)(-frame.eye.w), p.y, (floatL)(frame.eye.y)),
               fma_lanes((floatL)(-frame.eye.w), p.z, (floatL)(frame.eye.z))};
  Surface s;
  s.position = to_world(&frame, p);
  s.position.x += frame.to_world_x.w;
  s.position.y += frame.to_world_y.w;
  s.position.z += frame.to_world_z.w;
  s.normal = to_world(&frame, n);
  s.to_eye = to_world(&frame, normalize_lanes(eye));
  s.n_dot_v = dot3(s.normal, s.to_eye);
  s.diffuse = load_vec3(diffuse + first, stride);
  s.specular = given & kSpecularGroup ? load_vec3(specular + first, stride) : none;
  s.exponent = given & kSpecularGroup ? load_lanes(specular + first + 3 * stride) : none.x;
  s.ambient = given & kAmbientGroup ? load_vec3(ambient + first, stride) : none;
  s.emission = given & kEmissionGroup ? load_vec3(emission + first, stride) : none;
  s.uv.x = given & kUvGroup ? load_lanes(uv + first) : none.x;
  s.uv.y = given & kUvGroup ? load_lanes(uv + first + stride) : none.x;
  s.object = given & kObjectGroup ? *(__global const intL*)(object + first) : (intL)(-1);
  s.material = given & kMaterialGroup ? *(__global const intL*)(material + first) : (intL)(-1);
  s.tangent = s.bitangent = none;
  if (given & kTangentGroup) {
    load_tangents(tangent + first, n, &s.tangent, &s.bitangent);
    s.tangent = to_world(&frame, s.tangent);
    s.bitangent = to_world(&frame, s.bitangent);
  }

  Surface before = s;
  if (any_lane(covered)) user_surface(&s);

  intL faulty = 0;
  if (frame.changed & kNormalGroup) {
    intL same =
        (s.normal.x == before.normal.x) & (s.normal.y == before.normal.y) & (s.normal.z == before.normal.z);
    floatL length2 = dot3(s.normal, s.normal);
    intL usable = (length2 >= 0x1p-80f) & (length2 <= 0x1p80f);
    faulty |= !same & !usable;
    intL turned = covered & usable & !same;
    vec3L view = normalize_lanes(to_view(&frame, s.normal));
    store_lanes(new_normal + first, turned ? view.x : n.x);
    store_lanes(new_normal + first + stride, turned ? view.y : n.y);
    store_lanes(new_normal + first + 2 * stride, turned ? view.z : n.z);
    if (given & kLiftGroup) {
      // As under normal maps: the height above the surface stays, up to twice the way along the normal.
      floatL height = load_lanes(lift + first), along = max_lanes(dot3(view, n), (floatL)(0.5f));
      store_lanes(new_lift + first, turned ? quotient_lanes(height, along) : height);
    }
  }
  if (frame.changed & kDiffuseGroup)
    store_color(s.diffuse, before.diffuse, covered, &faulty, new_diffuse + first, stride);
  if (frame.changed & kSpecularGroup) {
    store_color(s.specular, before.specular, covered, &faulty, new_specular + first, stride);
    floatL exponent = changed_number(s.exponent, before.exponent, &faulty);
    store_lanes(new_specular + first + 3 * stride, covered ? exponent : before.exponent);
  }
  if (frame.changed & kAmbientGroup)
    store_color(s.ambient, before.ambient, covered, &faulty, new_ambient + first, stride);
  if (frame.changed & kEmissionGroup)
    store_color(s.emission, before.emission, covered, &faulty, new_emission + first, stride);
  for (uint bits = lane_bits(faulty & covered); bits; bits &= bits - 1) atomic_inc(faulty_pixels);
}
