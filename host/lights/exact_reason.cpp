#include "lights/exact_reason.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "lights/light_clusters.hpp"

namespace luciole {

const char* exactReasonName(ExactReason reason) {
  static constexpr const char* kNames[]{"none",  "model",       "kind",    "shadow",
                                        "range", "attenuation", "ambient", "place"};
  static_assert(std::size(kNames) == kExactReasons);
  return kNames[std::size_t(reason)];
}

ExactReason exactReason(const Light& light, const ClusterConditions& use) {
  if (use.model != Model::kPhong && use.model != Model::kBlinnPhong) return ExactReason::kModel;
  if (light.kind != LightKind::kPoint) return ExactReason::kKind;
  if (use.shadows && light.shadow) return ExactReason::kShadow;
  if (std::isfinite(light.range)) return ExactReason::kRange;
  const glm::vec3& falloff = light.attenuation;
  if (falloff.x != 0 || falloff.y != 0 || !(falloff.z >= kLeastQuadratic)) return ExactReason::kAttenuation;
  if (light.ambient != glm::vec3(0.0f)) return ExactReason::kAmbient;
  const glm::dvec3 place = glm::abs(light.position);
  if (!(std::max({place.x, place.y, place.z}) <= kFarthestClustered)) return ExactReason::kPlace;
  return ExactReason::kNone;
}

std::array<std::size_t, kExactReasons> countReasons(std::span<const Light> lights,
                                                    const ClusterConditions& use) {
  using Counts = std::array<std::size_t, kExactReasons>;
  const auto count = [&](const tbb::blocked_range<std::size_t>& range, Counts counts) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      ++counts[std::size_t(exactReason(lights[i], use))];
    return counts;
  };
  const auto join = [](Counts a, const Counts& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
    return a;
  };
  return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, lights.size()), Counts{}, count, join);
}

}  // namespace luciole
