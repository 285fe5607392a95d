#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// The text of a Luciole scene with the given lights, one a line. Reading it gives the same lights to the
/// bit, but for their groups, and for some directions, which keep all but their last bit.
std::string lightsScene(const std::vector<Light>& lights);

/// The same with one object, a mesh file, and a camera, whose direction is kept to within its rounding. The
/// path is written as it is: a relative one starts at the scene's folder. Throws InputError for a path that
/// isn't UTF-8.
std::string meshWithLights(const std::string& mesh_path, const Camera& camera,
                           const std::vector<Light>& lights);

/// A copy of a Luciole scene's file, without comments, in which these lights (as lightsScene writes them)
/// replace all its lights and light fields. It keeps its cameras, or gets `camera` where it has none.
/// Relative paths are rewritten for `folder`, where the copy will lie. The file must be one that loadScene
/// reads.
std::string sceneWithLights(const std::string& scene_path, const std::string& folder, const Camera& camera,
                            const std::vector<Light>& lights);

/// The scene of a picture, for another program: the file's objects and materials, and of `scene` the lights
/// (as lightsScene writes them), ambient light, background and fog, with one camera and a size. Empty
/// scene_path: without objects. Relative paths are rewritten for `folder`. The file must be one that
/// loadScene reads.
std::string pictureScene(const std::string& scene_path, const std::string& folder, const Scene& scene,
                         const Camera& camera, const glm::ivec2& size);

/// A scene as somebody has changed it while looking at it.
struct SavedScene {
  std::string text;               ///< of a scene file
  std::vector<std::string> left;  ///< changes that the file can't hold: of materials of meshes
};

/// The scene of a file, with these values of `scene`: its lights, if one of the changes is of a light or the
/// file is a mesh file, ambient light, background and fog. camera: as scene files have it. changes:
/// as LoadSettings::changes, which made `scene` from the file's; of materials those are made that the
/// file has. Relative paths are rewritten for `folder`. Reading the text gives the values to the bit. Throws
/// InputError.
SavedScene savedScene(const std::string& scene_path, const std::string& folder, const Scene& scene,
                      const nlohmann::json& camera, const glm::ivec2& size,
                      const std::vector<std::string>& changes);

/// Rewrites a path that is relative to the current folder as one relative to `folder`.
std::string pathFrom(const std::string& folder, const std::string& path);

}  // namespace luciole
