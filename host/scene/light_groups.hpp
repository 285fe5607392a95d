#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

#include "luciole/scene.hpp"

namespace luciole {

/// The name of the layer of light that no light emits: ambient light, emission, the fog's own colour and the
/// background. No group may have this name.
inline constexpr const char* kRestOfLight = "rest";

/// The reason why a group of lights can't have this name, or "". Names are parts of layers' names, which dots
/// divide, and of the option --light-mixer, which commas, = and : divide.
std::string faultOfGroupName(std::string_view name);

/// Groups' numbers, in Scene::light_groups, by their names.
using LightGroupNumbers = std::unordered_map<std::string, std::uint32_t>;
LightGroupNumbers lightGroupNumbers(const Scene& scene);

/// The number of the group of this name. Adds it to the scene if it is new.
std::uint32_t lightGroupNumber(const std::string& name, LightGroupNumbers& numbers, Scene& scene);

}  // namespace luciole
