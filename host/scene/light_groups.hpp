#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

#include "luciole/scene.hpp"

namespace luciole {

/// What layers call the light that no light gives: ambient light, emission, the fog's own colour and the
/// background. No group may have that name.
inline constexpr const char* kRestOfLight = "rest";

/// Why no group of lights can have this name; "" where one can. It becomes a part of a layer's name, which
/// dots divide, and commas, = and : divide what --light-mixer says.
std::string faultOfGroupName(std::string_view name);

/// Groups' numbers, in Scene::light_groups, by their names.
using LightGroupNumbers = std::unordered_map<std::string, std::uint32_t>;
LightGroupNumbers lightGroupNumbers(const Scene& scene);

/// The number of the group of this name, which the scene gets where it has none of that name.
std::uint32_t lightGroupNumber(const std::string& name, LightGroupNumbers& numbers, Scene& scene);

}  // namespace luciole
