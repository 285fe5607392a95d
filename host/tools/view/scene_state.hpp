#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "luciole/scene.hpp"
#include "tools/view/view_changes.hpp"

// What a page is told of a scene, for its lists and controls.
namespace luciole {

inline constexpr std::size_t kMostListed = 256;  ///< lights

/// The scene's name, size, cameras, lights, materials and surroundings, as its files have them, and what its
/// pictures' options may be. Colours come as numbers and, as "…hex", in sRGB.
nlohmann::json sceneState(const Scene& scene, const SceneValues& loaded);

/// Example shaders by kind and name: {"model": {"rim.clh": text}}.
nlohmann::json exampleShaders();

/// The name of a light, a material or an object, or "light 3".
std::string nameOr(const std::string& name, const char* kind, std::size_t index);

}  // namespace luciole
