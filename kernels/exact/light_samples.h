// Where the samples of a light of a size lie, as a point sees it: for host and devices, to the bit. In
// doubles, of operations that IEEE 754 rounds. A device without doubles leaves samples to the host.
#ifndef LUCIOLE_LIGHT_SAMPLES_H
#define LUCIOLE_LIGHT_SAMPLES_H

#include "exact/wide_integer.h"
#include "shared.h"
#ifdef __cplusplus
#include <cmath>
#define INLINE static inline
#define __global
namespace luciole {
INLINE ulong double_bits(double value) { return std::bit_cast<ulong>(value); }
#else
#include "lanes.clh"
#endif

// A sample of the disc that a light of a size shows, in polar coordinates: `share` is the share of the solid
// angle inside its circle, 0 at the middle and 1 at the rim; cosine and sine are those of its azimuth.
typedef struct {
  float share, cosine, sine;
} LightSample;

// Of makeLightSamples(), and of a light from a point, at most.
#ifdef __cplusplus
inline constexpr int kLightSamples = 1 << 16, kMostSoftSamples = 1024;
#else
enum { kLightSamples = 1 << 16, kMostSoftSamples = 1024 };
#endif

// Cosines of the azimuths of a quarter of the cells, from the first on: see light_sample().
enum { kQuarterCells = 1 << 14 };

// The bits of a 16-bit number in reversed order.
INLINE uint reversed_bits(uint bits) {
  bits = (bits & 0x5555) << 1 | (bits >> 1 & 0x5555);
  bits = (bits & 0x3333) << 2 | (bits >> 2 & 0x3333);
  bits = (bits & 0x0f0f) << 4 | (bits >> 4 & 0x0f0f);
  return (bits & 0x00ff) << 8 | bits >> 8;
}

// Sobol's second dimension, of 16 bits. Its direction numbers are the rows of Pascal's triangle modulo 2, and
// C(k, j) is odd where all bits of j are in k: so each bit is the sum of those whose index has all bits of
// its own.
INLINE uint second_dimension(uint index) {
  index ^= index >> 1 & 0x5555;
  index ^= index >> 2 & 0x3333;
  index ^= index >> 4 & 0x0f0f;
  index ^= index >> 8 & 0x00ff;
  return reversed_bits(index);
}

// The sample of an index below kLightSamples, in the middle of its cell. quarter: kQuarterCells cosines.
INLINE LightSample light_sample(uint index, __global const float* quarter) {
  uint cell = second_dimension(index), turn = cell / kQuarterCells, at = cell % kQuarterCells;
  float along = quarter[at], across = quarter[kQuarterCells - 1 - at];
  float x = turn % 2 == 0 ? along : across, y = turn % 2 == 0 ? across : along;
  LightSample sample;
  sample.share = ((float)reversed_bits(index) + 0.5f) * (1.0f / kLightSamples);
  sample.cosine = turn == 1 || turn == 2 ? -x : x;
  sample.sine = turn >= 2 ? -y : y;
  return sample;
}

// C. Wellons' "lowbias32" (2018).
INLINE uint hashed(uint bits) {
  bits = (bits ^ bits >> 16) * 0x7feb352du;
  bits = (bits ^ bits >> 15) * 0x846ca68bu;
  return bits ^ bits >> 16;
}

// The first sample of the pattern of a light from a point: see patternOf().
INLINE uint first_of_pattern(float4 start, uint light, uint samples) {
  uint hash = hashed(light ^ float_bits(start.x));
  hash = hashed(hash ^ float_bits(start.y));
  hash = hashed(hash ^ float_bits(start.z));
  return hash % ((uint)kLightSamples / samples) * samples;
}

// A test defines NO_DOUBLES to compile as for a device that has none.
#if (defined(__cplusplus) || defined(cl_khr_fp64)) && !defined(NO_DOUBLES)
#define SAMPLE_DOUBLES
#ifndef __cplusplus
INLINE ulong double_bits(double value) { return as_ulong(value); }
#endif

// The cone in which a point sees a light.
typedef struct {
  double place[3];  // of the light; of a directional one nothing
  double axis[3], right[3], up[3];
  double distance, size;
  double most;  // 1 − the cosine of the half angle
  bool parallel;
} LightCone;

// Returns false if the point is inside the light.
INLINE bool see_light(const BeamLight* light, float4 start, LightCone* cone) {
  double x = light->place.x, y = light->place.y, z = light->place.z;
  cone->parallel = light->place.w == 0.0f;
  cone->place[0] = x;
  cone->place[1] = y;
  cone->place[2] = z;
  if (!cone->parallel) {
    x -= start.x;
    y -= start.y;
    z -= start.z;
  }
  cone->distance = sqrt(x * x + y * y + z * z);
  cone->size = light->size;
  if (!cone->parallel && cone->distance <= cone->size) return false;
  x /= cone->distance;
  y /= cone->distance;
  z /= cone->distance;
  // Any two axes across it: T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017.
  double sign = double_bits(z) >> 63 != 0 ? -1.0 : 1.0, a = -1 / (sign + z), b = x * y * a;
  cone->axis[0] = x;
  cone->axis[1] = y;
  cone->axis[2] = z;
  cone->right[0] = 1 + sign * x * x * a;
  cone->right[1] = sign * b;
  cone->right[2] = -sign * x;
  cone->up[0] = b;
  cone->up[1] = sign + y * y * a;
  cone->up[2] = -y;
  // Of an angle by the chord of its half, of a sphere by its sine.
  double sine = cone->parallel ? 0 : cone->size / cone->distance;
  cone->most = cone->parallel ? 0.5 * cone->size * cone->size : sine * sine / (1 + sqrt(1 - sine * sine));
  return true;
}

// A sample's place on the near side of the light's sphere, or the direction to it, as BeamLight.place.
// Samples are uniform by solid angle.
INLINE void place_sample(const LightCone* cone, float share, float cosine, float sine, float* at) {
  double drop = cone->most * (double)share, cosine_to = 1 - drop, sine_to = sqrt(drop * (1 + cosine_to));
  double along, aside;
  if (cone->parallel) {
    along = -cosine_to;
    aside = sine_to;
  } else {
    // `beside`: the distance of the ray from the centre; `before`: from there back to where it enters the
    // sphere.
    double beside = cone->distance * sine_to, square = cone->size * cone->size - beside * beside;
    double before = sqrt(square > 0 ? square : 0.0);
    along = beside * sine_to + before * cosine_to;
    aside = beside * cosine_to - before * sine_to;
  }
  for (uint i = 0; i < 3; ++i) {
    double across = (double)cosine * cone->right[i] + (double)sine * cone->up[i];
    double from = cone->parallel ? -(along * cone->axis[i]) : cone->place[i] - along * cone->axis[i];
    at[i] = (float)(from + aside * across);
  }
}
#endif

#ifdef __cplusplus
}  // namespace luciole
#undef __global
#undef INLINE
#endif
#endif
