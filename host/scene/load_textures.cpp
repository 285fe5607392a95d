#include "scene/load_textures.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <filesystem>

#include "image/make_normals.hpp"
#include "image/read_texture.hpp"

namespace luciole {

int addTexture(Scene& scene, const std::string& path, TextureKind kind) {
  const std::string name = std::filesystem::path(path).lexically_normal().string();
  const auto found = std::find_if(scene.textures.begin(), scene.textures.end(), [&](const Texture& texture) {
    return texture.name == name && texture.kind == kind;
  });
  const int index = static_cast<int>(found - scene.textures.begin());
  if (found == scene.textures.end()) scene.textures.push_back({.name = name, .levels = {}, .kind = kind});
  return index;
}

bool allDecoded(const Scene& scene) {
  return std::none_of(scene.textures.begin(), scene.textures.end(),
                      [](const Texture& texture) { return texture.levels.empty(); });
}

void decodeTextures(Scene& scene) {
  const auto decode = [&](std::size_t i) {
    Texture& texture = scene.textures[i];
    if (!texture.levels.empty()) return;
    const TextureKind kind = texture.kind;
    texture = readTexture(texture.name);
    if (kind != TextureKind::kColor) makeNormals(kind, texture);
  };
  // One by one, because each takes long.
  tbb::parallel_for(std::size_t{0}, scene.textures.size(), decode, tbb::simple_partitioner());
}

}  // namespace luciole
