#pragma once

#include <string>
#include <string_view>

namespace luciole {

/// The prefix of layers of light groups, before the group's name. Layers of light have channels LAYER.R,
/// LAYER.G and LAYER.B, in the units of the picture's own R, G and B.
inline constexpr std::string_view kLightGroups = "light_groups.";
/// The layers of the parts of a picture's light.
inline constexpr std::string_view kLightParts[]{"ambient_light.", "diffuse_light.", "specular_light.",
                                                "emission_light.", "fog_light."};
/// What follows the name of a layer of light in the names of its bounds: LAYER.light_error.R …
inline constexpr std::string_view kLayerBounds = "light_error.";

/// Whether a channel holds a picture's light, or a part of it or its bounds, which are as bright as the
/// exposure makes them.
inline bool isLightChannel(std::string_view name) {
  if (name == "R" || name == "G" || name == "B" || name.starts_with(kLightGroups)) return true;
  for (const std::string_view part : kLightParts)
    if (name.starts_with(part)) return true;
  return false;
}

}  // namespace luciole
