#pragma once

#include <cstdint>
#include <string>

#include "luciole/scene.hpp"

namespace luciole {

/// What happens if a picture file that a scene names doesn't exist.
enum class MissingTextures : std::uint8_t {
  kError,  ///< the scene is refused
  kWarn,   ///< its materials are drawn without it, with a warning in Scene::warnings
};

/// How a scene's files are read.
struct LoadSettings {
  MissingTextures missing = MissingTextures::kError;
  bool strict = false;                ///< what breaks a format's rules is refused, not repaired
  std::vector<std::string> search{};  ///< folders to look in for files that aren't where the scene says
  GltfChoice choice{};                ///< of a glTF file
  bool tangents = false;              ///< all surfaces get tangents, for shaders: see addAllTangents()
  /// Values to replace in the scene, each "PATH=VALUE": a PATH is keys by dots and elements as [0], such as
  /// lights[0].intensity; VALUE is JSON, or else a text.
  std::vector<std::string> changes{};
  /// A picture of a sky (readSky()), which is the scene's environment, with shadows, in place of its own;
  /// empty: none.
  std::string environment{};
};

/// Reads a scene by its file's extension (.json, .obj, .gltf, .glb; case ignored), or Luciole JSON from
/// standard input for "-", completes it at frame 1 (see completeScene), so that all frames get the same
/// camera and lights, and poses it at `frame` (see poseScene). Throws InputError, or MachineError where it
/// doesn't fit into memory.
Scene loadScene(const std::string& path, double frame = 1, const LoadSettings& settings = {});

/// Adds what a picture needs and the scene's file left out. That is a camera that frames the whole (from
/// inside, for a closed hall); and where the file has no lights and doesn't ask for none: lights, some
/// ambient light, and for a mesh file a sky colour. A file that asks for no light of any kind gets a warning.
/// `is_mesh_file`: the scene came from .obj, .gltf or .glb rather than from a Luciole scene.
void completeScene(Scene& scene, bool is_mesh_file);

}  // namespace luciole
