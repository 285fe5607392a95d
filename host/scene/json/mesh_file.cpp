#include "scene/json/mesh_file.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "scene/gltf/gltf.hpp"
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

void loadMeshFile(const std::string& path, Scene& scene, const std::string& variant) {
  if (extensionOf(path) == ".obj") {
    if (!variant.empty()) throw InputError(path + ": has no variants, which only glTF files have");
    loadObj(path, scene);
  } else {
    loadGltf(path, scene, variant);
  }
}

}  // namespace luciole
