#include "scene/json/mesh_file.hpp"

#include <filesystem>

#include "luciole/error.hpp"
#include "scene/obj/obj.hpp"

namespace luciole {

std::string extensionOf(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

bool isMeshFile(const std::string& path) {
  const std::string extension = extensionOf(path);
  return extension == ".obj" || extension == ".gltf" || extension == ".glb";
}

void loadMeshFile(const std::string& path, Scene& scene, const GltfChoice& choice,
                  const std::vector<std::string>& search) {
  if (extensionOf(path) == ".obj") {
    checkIsGltf(path, choice);
    loadObj(path, scene, search);
  } else {
    loadGltf(path, scene, choice, search);
  }
}

void checkIsGltf(const std::string& path, const GltfChoice& choice) {
  const std::string extension = extensionOf(path);
  if (extension == ".gltf" || extension == ".glb") return;
  if (!choice.variant.empty()) throw InputError(path + ": has no variants, which only glTF files have");
  if (!choice.animation.empty())
    throw InputError(path + ": has no animations by name, which only glTF files have");
}

}  // namespace luciole
