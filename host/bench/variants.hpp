#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/features.hpp"
#include "render/stats.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// One way to make the picture.
struct Variant {
  std::string name{};  ///< what it changes
  int lanes = 1;       ///< of the device, see DeviceDescription
  ShadeSettings shade{};
  int samples = 1;
  bool is_default = false;
};

/// What shadows a truth has.
enum class TruthShadows : std::uint8_t {
  kNone,
  kSharp,  ///< by a ray to each light's middle
  kSoft,   ///< by many rays to a light that has a size
};

/// Variants that are measured side by side, each judged by its model's truth: errors compare within a group
/// of one model only.
struct VariantGroup {
  std::string name;
  std::string chosen_by{};      ///< the name for people to choose it by; several groups may share one
  std::string measured{};       ///< what its times cover and what its errors are against, for people
  std::vector<Stage> stages{};  ///< whose times count (see Stats::stages); empty: all but compiling
  bool samples = false;         ///< whole pictures, anti-aliased, rather than one G-buffer lit
  TruthShadows shadows = TruthShadows::kNone;
  std::vector<Variant> variants{};
};

/// All variants are of one model.
bool haveOneTruth(const VariantGroup& group);

/// Texels a side that shadow maps are tried with.
inline constexpr int kShadowSizes[] = {512, 1024, 2048, 4096};

/// Everything worth measuring of a scene, the defaults first in their group, for a device of `lanes`. A scene
/// without shadows has no group about them; one whose lights have a size has two, as sharp shadows and soft
/// ones have truths of their own. shadow_size: the only one to try, instead of kShadowSizes.
std::vector<VariantGroup> benchVariants(const Scene& scene, int lanes, std::optional<int> shadow_size);

}  // namespace luciole
