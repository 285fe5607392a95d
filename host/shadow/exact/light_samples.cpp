#include "shadow/exact/light_samples.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace luciole {

std::vector<float> quarterCosines() {
  std::vector<float> cosines(kQuarterCells);
  for (std::size_t i = 0; i < cosines.size(); ++i)
    cosines[i] = float(std::cos((double(i) + 0.5) / kLightSamples * 2 * std::numbers::pi));
  return cosines;
}

std::vector<LightSample> makeLightSamples() {
  const std::vector<float> quarter = quarterCosines();
  std::vector<LightSample> samples;
  for (uint i = 0; i < kLightSamples; ++i) samples.push_back(light_sample(i, quarter.data()));
  return samples;
}

std::span<const LightSample> patternOf(std::span<const LightSample> all, int samples, const glm::vec3& start,
                                       std::uint32_t light) {
  const std::size_t first = first_of_pattern({start.x, start.y, start.z, 0}, light, uint(samples));
  return all.subspan(first, std::size_t(samples));
}

bool placeSamples(const BeamLight& light, const glm::vec3& start, std::span<const LightSample> pattern,
                  std::span<float4> to) {
  LightCone cone;
  if (!see_light(&light, {start.x, start.y, start.z, 0}, &cone)) return false;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    float at[3];
    place_sample(&cone, pattern[i].share, pattern[i].cosine, pattern[i].sine, at);
    to[i] = {at[0], at[1], at[2], light.place.w};
  }
  return true;
}

}  // namespace luciole
