#pragma once

#include <string>
#include <vector>

#include "render/features.hpp"
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

/// Variants that are measured side by side, each judged by its model's truth: errors compare within a group
/// of one model only.
struct VariantGroup {
  std::string name;
  std::string measured{};             ///< what its times cover and what its errors are against, for people
  std::vector<std::string> stages{};  ///< whose times count (see Stats::stages); empty: all but compiling
  bool samples = false;               ///< whole pictures, anti-aliased, rather than one G-buffer lit
  bool shadows = false;               ///< the truth has shadows
  std::vector<Variant> variants{};
};

/// All variants are of one model.
bool haveOneTruth(const VariantGroup& group);

/// Everything worth measuring of a scene, the defaults first in their group, for a device of `lanes`. A scene
/// without shadows has no group about them.
std::vector<VariantGroup> benchVariants(const Scene& scene, int lanes);

}  // namespace luciole
