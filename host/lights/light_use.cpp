#include "lights/light_use.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "lights/light_clusters.hpp"

namespace luciole {
namespace {

/// Whether rays to a light's place decide its shadow.
bool isKnownByRays(const Light& light, ShadowMethod shadows) {
  return shadows == ShadowMethod::kExact || shadows == ShadowMethod::kAuto ||
         (shadows == ShadowMethod::kSoftExact &&
          (light.kind == LightKind::kDirectional ? light.half_angle : light.radius) == 0);
}

}  // namespace

const char* reasonName(LightUse use) {
  static constexpr const char* kNames[]{"none",   "none",  "none",        "model",   "kind", "profile",
                                        "shadow", "range", "attenuation", "ambient", "place"};
  static_assert(std::size(kNames) == kLightUses);
  return kNames[std::size_t(use)];
}

bool isCosineLobe(const Light& light) {
  // What a cutoff this near to a right angle leaves out is below the rounding of its cosine.
  constexpr double kRightAngle = std::numbers::pi / 2 - 1e-9;
  return light.kind == LightKind::kSpot && light.falloff == SpotFalloff::kExponent && light.exponent == 1 &&
         light.cutoff >= kRightAngle;
}

LightUse lightUse(const Light& light, const UseConditions& conditions) {
  if (conditions.model != Model::kPhong && conditions.model != Model::kBlinnPhong) return LightUse::kByModel;
  if (light.kind == LightKind::kSpot && !isCosineLobe(light)) return LightUse::kByKind;
  if (light.luminaire >= 0) return LightUse::kByProfile;
  const bool casts = light.shadow && conditions.shadows != ShadowMethod::kOff;
  if (casts && !isKnownByRays(light, conditions.shadows)) return LightUse::kByShadow;
  if (light.kind == LightKind::kDirectional)
    return light.ambient == glm::vec3(0.0f) ? LightUse::kSampledDirection : LightUse::kByAmbient;
  if (std::isfinite(light.range)) return LightUse::kByRange;
  const glm::vec3& falloff = light.attenuation;
  if (falloff.x != 0 || falloff.y != 0 || !(falloff.z >= kLeastQuadratic)) return LightUse::kByAttenuation;
  if (light.ambient != glm::vec3(0.0f)) return LightUse::kByAmbient;
  const glm::dvec3 place = glm::abs(light.position);
  if (!(std::max({place.x, place.y, place.z}) <= kFarthestClustered)) return LightUse::kByPlace;
  // Clusters know neither lobes nor how wide highlights are.
  return casts || light.kind == LightKind::kSpot || light.cell > 0 ? LightUse::kSampled
                                                                   : LightUse::kClustered;
}

LightUseCounts countUses(std::span<const Light> lights, const UseConditions& conditions) {
  const auto count = [&](const tbb::blocked_range<std::size_t>& range, LightUseCounts counts) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      ++counts[std::size_t(lightUse(lights[i], conditions))];
    return counts;
  };
  const auto join = [](LightUseCounts a, const LightUseCounts& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
    return a;
  };
  return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, lights.size()), LightUseCounts{}, count,
                              join);
}

std::size_t countCasting(std::span<const Light> lights, LightUse use, const UseConditions& conditions) {
  if (conditions.shadows == ShadowMethod::kOff) return 0;
  return std::size_t(std::count_if(lights.begin(), lights.end(), [&](const Light& light) {
    return light.shadow && lightUse(light, conditions) == use;
  }));
}

}  // namespace luciole
