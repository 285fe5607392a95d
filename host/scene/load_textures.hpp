#pragma once

#include <string>

#include "luciole/scene.hpp"

namespace luciole {

/// The index in Scene::textures of the picture file `path`. A new file is added without decoding it; a file
/// that several materials name is one texture of each kind. O(textures).
int addTexture(Scene& scene, const std::string& path, TextureKind kind = TextureKind::kColor);

/// Whether all textures have levels.
bool allDecoded(const Scene& scene);

/// Decodes, in parallel, every texture that addTexture() left without levels. Throws as readTexture does.
void decodeTextures(Scene& scene);

}  // namespace luciole
