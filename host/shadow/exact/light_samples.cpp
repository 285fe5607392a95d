#include "shadow/exact/light_samples.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace luciole {
namespace {

/// The bits of a 16-bit number in reversed order.
std::uint32_t reversed(std::uint32_t bits) {
  std::uint32_t result = 0;
  for (int i = 0; i < 16; ++i) result |= (bits >> i & 1) << (15 - i);
  return result;
}

/// Sobol's second dimension, of 16 bits: its direction numbers are the rows of Pascal's triangle modulo 2.
std::uint32_t secondDimension(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t direction = 1u << 15; index != 0; index >>= 1, direction ^= direction >> 1)
    if ((index & 1) != 0) result ^= direction;
  return result;
}

/// C. Wellons' "lowbias32" (2018).
std::uint32_t hashed(std::uint32_t bits) {
  bits = (bits ^ bits >> 16) * 0x7feb352du;
  bits = (bits ^ bits >> 15) * 0x846ca68bu;
  return bits ^ bits >> 16;
}

}  // namespace

std::vector<LightSample> makeLightSamples() {
  std::vector<LightSample> samples(kLightSamples);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    // In the middle of the cells of the finest grid.
    const double angle = (secondDimension(i) + 0.5) / kLightSamples * 2 * std::numbers::pi;
    samples[i] = {float((reversed(i) + 0.5) / kLightSamples), float(std::cos(angle)), float(std::sin(angle))};
  }
  return samples;
}

std::span<const LightSample> patternOf(std::span<const LightSample> all, int samples, const glm::vec3& start,
                                       std::uint32_t light) {
  std::uint32_t hash = light;
  for (int axis = 0; axis < 3; ++axis) hash = hashed(hash ^ std::bit_cast<std::uint32_t>(start[axis]));
  const std::size_t patterns = all.size() / std::size_t(samples);
  return all.subspan(hash % patterns * std::size_t(samples), std::size_t(samples));
}

bool placeSamples(const BeamLight& light, const glm::vec3& start, std::span<const LightSample> pattern,
                  std::span<float4> to) {
  const glm::dvec3 place(light.place.x, light.place.y, light.place.z);
  const bool directional = light.place.w == 0;
  const double size = light.size;
  const glm::dvec3 to_light = directional ? place : place - glm::dvec3(start);
  const double distance = glm::length(to_light);
  if (!directional && distance <= size) return false;
  const glm::dvec3 axis = to_light / distance;
  // Any two axes across it: T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017.
  const double sign = std::copysign(1.0, axis.z), a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
  const glm::dvec3 right(1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
  const glm::dvec3 up(b, sign + axis.y * axis.y * a, -axis.y);
  // 1 − the cosine of the cone's half angle: of an angle by the chord of its half, of a sphere by its sine.
  const double sine = directional ? 0 : size / distance;
  const double most = directional ? 0.5 * size * size : sine * sine / (1 + std::sqrt(1 - sine * sine));
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const double drop = most * double(pattern[i].share), cosine_to = 1 - drop;
    const double sine_to = std::sqrt(drop * (1 + cosine_to));
    const glm::dvec3 across = double(pattern[i].cosine) * right + double(pattern[i].sine) * up;
    glm::dvec3 at;
    if (directional) {
      at = cosine_to * axis + sine_to * across;
    } else {
      // `beside`: the distance of the ray from the centre; `before`: from there back to where it enters the
      // sphere.
      const double beside = distance * sine_to,
                   before = std::sqrt(std::max(size * size - beside * beside, 0.0));
      at = place - (beside * sine_to + before * cosine_to) * axis +
           (beside * cosine_to - before * sine_to) * across;
    }
    to[i] = {float(at.x), float(at.y), float(at.z), light.place.w};
  }
  return true;
}

}  // namespace luciole
