#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "luciole/scene.hpp"
#include "scene/find_file.hpp"
#include "scene/json/scene_changes.hpp"
#include "scene/lights/light_field.hpp"

namespace luciole {

/// The content of a Luciole scene's file, without what completeScene() adds.
struct SceneFile {
  Scene scene;
  std::vector<LightField> light_fields;  ///< not among the scene's lights yet
};

/// Reads a Luciole scene, from standard input for "-", and every mesh and texture that it names. search: more
/// folders for these files. changes: applied to the file's JSON; throws InputError if one of them can't be.
/// Throws InputError "file: place: what is wrong".
SceneFile loadJsonScene(const std::string& path, const std::vector<std::string>& search = {},
                        std::vector<SceneChange> changes = {});

/// The same of a file's text. `file` is its name for messages; the files it names are found as by findFile().
SceneFile parseJsonScene(const std::string& text, const std::string& file, const SearchFolders& where,
                         std::vector<SceneChange> changes = {});

/// Reads the members "background", "ambient", "fog" and "lighting" of a scene file, those that there are,
/// into the scene. Throws InputError.
void readSurroundings(const JsonNode& top, Scene& scene);

/// Throws InputError "where: …" unless each side is from 1 to kLargestSide pixels.
void checkPictureSize(glm::ivec2 size, const std::string& where);

}  // namespace luciole
