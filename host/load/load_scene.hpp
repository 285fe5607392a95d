#pragma once

#include <cstdint>
#include <string>

#include "scene/scene.hpp"

namespace luciole {

/// What becomes of a picture that a scene names and that isn't there.
enum class MissingTextures : std::uint8_t {
  kError,  ///< the scene is refused
  kWarn,   ///< its materials are drawn without it, and Scene::warnings say so
};

/// Reads a scene by its file's extension (.json, .obj, .gltf, .glb; case ignored), or Luciole JSON from
/// standard input for "-", completes it at frame 1 (see completeScene), so that all frames have the same, and
/// poses it at `frame` (see poseScene). Throws InputError.
Scene loadScene(const std::string& path, double frame = 1, MissingTextures missing = MissingTextures::kError);

/// Gives a scene what a picture needs and its file left out: a camera that frames the whole (from inside, for
/// a closed hall), and, where it has no lights and doesn't say so, lights, some ambient, and for a mesh file
/// a sky colour. Where it says that there is no light of any kind, that is worth a warning. `is_mesh_file`:
/// the scene came from .obj, .gltf or .glb rather than from a Luciole scene.
void completeScene(Scene& scene, bool is_mesh_file);

/// The warning of a scene that nothing lights, for commands that put lights of their own in place of its
/// lights to leave out.
std::string nothingLights(const Scene& scene);

}  // namespace luciole
