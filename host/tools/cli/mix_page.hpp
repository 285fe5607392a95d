#pragma once

#include <string>
#include <vector>

#include "tools/viewing/light_mixer.hpp"

namespace luciole {

/// A group as --light-mixer has it: a factor and the sRGB colour "#rrggbb" that tints it.
struct MixerTerm {
  std::string group;
  double factor = 1;
  std::string color = "#ffffff";
};

/// A page, whole in one file, that mixes an EXR's groups of lights by sliders, which begin at these terms and
/// stops. Its picture is reduced until the groups' layers take kPageBytes at most. Throws as mixLights.
std::string mixPage(const std::string& path, const std::vector<MixerTerm>& terms, double exposure);

inline constexpr std::size_t kPageBytes = std::size_t(12) << 20;

}  // namespace luciole
