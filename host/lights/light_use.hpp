#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "luciole/model.hpp"
#include "luciole/scene.hpp"
#include "luciole/settings.hpp"

namespace luciole {

/// What a picture with an error allowed (ShadeSettings::light_error) may do with a light: let clusters stand
/// for it, sample it, or for the first reason that holds, in this order, sum it by itself.
enum class LightUse : std::uint8_t {
  kClustered,         ///< it casts no shadow
  kSampled,           ///< it has a place: its shadow is known by rays, or it casts none
  kSampledDirection,  ///< the same of a directional light
  kByModel,           ///< not all surfaces have Phong's model, nor have all Blinn's
  kByKind,            ///< it is a spot, and no cosine lobe (isCosineLobe)
  kByProfile,         ///< it is a luminaire with a profile
  kByShadow,          ///< its shadow is that of a map, or of a light of a size
  kByRange,           ///< its range is finite
  kByAttenuation,     ///< it doesn't fall off as 1 / (q d²)
  kByAmbient,         ///< it has an ambient part
  kByPlace,           ///< it is farther from the origin than kFarthestClustered
  kCount
};
inline constexpr std::size_t kLightUses = std::size_t(LightUse::kCount);

/// The reason as --stats counts it: "model" … Not for kClustered and kSampled.
const char* reasonName(LightUse use);

/// Metres: squares of distances, and their inverses, are floats well within this.
inline constexpr double kFarthestClustered = 1e15;

/// The properties of a picture that decide about its lights' uses.
struct UseConditions {
  std::optional<Model> model = Model::kPhong;  ///< of all surfaces; empty: they have different ones
  ShadowMethod shadows = ShadowMethod::kOff;
};

/// Whether a spot shines as a flat face does: by the cosine to its axis, all of the half space ahead.
bool isCosineLobe(const Light& light);

LightUse lightUse(const Light& light, const UseConditions& conditions);

/// The number of lights for each use.
using LightUseCounts = std::array<std::size_t, kLightUses>;
/// O(n), on all cores.
LightUseCounts countUses(std::span<const Light> lights, const UseConditions& conditions);
/// The lights of a use that cast shadows. O(n).
std::size_t countCasting(std::span<const Light> lights, LightUse use, const UseConditions& conditions);

}  // namespace luciole
