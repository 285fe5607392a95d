#pragma once

#include <string>

#include "scene/scene.hpp"

namespace luciole {

/// The index in Scene::textures of the picture file `path`, which is added, not decoded yet, where it is new.
/// A file that many materials name is one texture.
int addTexture(Scene& scene, const std::string& path);

/// Decodes, in parallel, every texture that addTexture() left without levels. Throws as readTexture does.
void decodeTextures(Scene& scene);

}  // namespace luciole
