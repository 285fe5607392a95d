#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "luciole/model.hpp"
#include "luciole/scene.hpp"

namespace luciole {

/// Why a light is summed by itself when others might stand for it (ShadeSettings::light_error): the first
/// that holds, in this order.
enum class ExactReason : std::uint8_t {
  kNone,         ///< others may stand for it
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

/// What of a picture decides which of its lights others may stand for.
struct ClusterConditions {
  std::optional<Model> model = Model::kPhong;  ///< none: surfaces have different ones
  bool shadows = false;                        ///< lights cast them that can
};

ExactReason exactReason(const Light& light, const ClusterConditions& use);

/// How many lights each reason holds for, by ExactReason. O(n), on all cores.
std::array<std::size_t, kExactReasons> countReasons(std::span<const Light> lights,
                                                    const ClusterConditions& use);

}  // namespace luciole
