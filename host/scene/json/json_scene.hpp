#pragma once

#include <glm/glm.hpp>
#include <string>

#include "scene/scene.hpp"

namespace luciole {

/// Reads a Luciole scene, from standard input for "-", and every mesh and texture it names. Nothing is added
/// that the file doesn't say, but for a camera where it spreads light fields over a scene that has none: they
/// must not change from where it is seen. Throws InputError "file: place: what is wrong".
Scene loadJsonScene(const std::string& path);

/// Throws InputError "where: …" unless each side is from 1 to kLargestSide pixels.
void checkPictureSize(glm::ivec2 size, const std::string& where);

}  // namespace luciole
