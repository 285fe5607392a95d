#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "luciole/model.hpp"
#include "luciole/scene.hpp"

namespace luciole {

/// The reason why a light can't be in a cluster (ShadeSettings::light_error) and is summed by itself: the
/// first that holds, in this order.
enum class ExactReason : std::uint8_t {
  kNone,         ///< it can be in a cluster
  kModel,        ///< not all surfaces have Phong's model, nor have all Blinn's
  kKind,         ///< it is no point light
  kShadow,       ///< it casts a shadow in this picture
  kRange,        ///< its range is finite
  kAttenuation,  ///< it doesn't fall off as 1 / (q d²)
  kAmbient,      ///< it has an ambient part
  kPlace,        ///< it is farther from the origin than kFarthestClustered
  kCount
};
inline constexpr std::size_t kExactReasons = std::size_t(ExactReason::kCount);

/// The reason as --stats counts it: "model" … Not for kNone.
const char* exactReasonName(ExactReason reason);

/// Metres: squares of distances, and their inverses, are floats well within this.
inline constexpr double kFarthestClustered = 1e15;

/// The properties of a picture that decide which of its lights can be in clusters.
struct ClusterConditions {
  std::optional<Model> model = Model::kPhong;  ///< of all surfaces; empty: they have different ones
  bool shadows = false;                        ///< lights with Light::shadow cast shadows
};

ExactReason exactReason(const Light& light, const ClusterConditions& use);

/// The number of lights for each ExactReason. O(n), on all cores.
std::array<std::size_t, kExactReasons> countReasons(std::span<const Light> lights,
                                                    const ClusterConditions& use);

}  // namespace luciole
