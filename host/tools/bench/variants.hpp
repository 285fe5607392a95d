#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lighting/stats.hpp"
#include "luciole/scene.hpp"
#include "shade/features.hpp"

namespace luciole {

/// One way to make the picture.
struct Variant {
  std::string name{};  ///< what it changes
  int lanes = 1;       ///< of the device, see DeviceDescription
  ShadeSettings shade{};
  int samples = 1;
  bool is_default = false;
};

/// The shadows in a truth.
enum class TruthShadows : std::uint8_t {
  kNone,
  kSharp,  ///< by a ray to each light's middle
  kSoft,   ///< by many rays to a light that has a size
};

/// Variants that are measured side by side. Each is compared with the truth of its model, so errors compare
/// only within a group of one model.
struct VariantGroup {
  std::string name;
  std::string chosen_by{};      ///< the name in --only; several groups may share one
  std::string measured{};       ///< the content of its times and the reference of its errors, for people
  std::vector<Stage> stages{};  ///< stages whose times count (see Stats::stages); empty: all but compiling
  bool samples = false;         ///< whole pictures, anti-aliased, rather than one G-buffer lit
  TruthShadows shadows = TruthShadows::kNone;
  std::vector<Variant> variants{};
};

/// Whether all variants are of one model, and so have the same truth.
bool haveOneTruth(const VariantGroup& group);

/// Texels a side that shadow maps are tried with.
inline constexpr int kShadowSizes[] = {512, 1024, 2048, 4096};

/// Samples of a light of a size that soft exact shadows are tried with.
inline constexpr std::array kSoftSamples{1, 4, 16, 64, 256};

/// All groups of variants that a scene allows to measure, for a device of `lanes`; the defaults are the first
/// in their group. A scene without shadows has no group for them. A scene whose lights have a size has two,
/// because sharp and soft shadows have different truths. shadow_size: if set, the only size to try.
std::vector<VariantGroup> benchVariants(const Scene& scene, int lanes, std::optional<int> shadow_size);

}  // namespace luciole
