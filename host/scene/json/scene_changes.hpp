#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "luciole/scene.hpp"
#include "scene/find_file.hpp"
#include "scene/json/json_fields.hpp"

// Changes of single values of a scene, for the option --set.
namespace luciole {

/// A member of an object by its key; an element of an array by its number, or by its "name".
struct ChangeStep {
  std::string key{};
  std::size_t index = JsonNode::kNoIndex;  ///< else the key says it
};

/// A value for a place of a scene.
struct SceneChange {
  std::string text;  ///< as typed
  std::vector<ChangeStep> place;
  Json value;
  bool is_made = false;
};

/// The length of PATH in "PATH=VALUE": up to the first = outside of ["name"]. Throws InputError, naming the
/// option, if there is none.
std::size_t placeLength(const std::string& text, const std::string& option);

/// Reads texts PATH=VALUE. A PATH is keys by dots, elements as [0], and keys with dots of their own as
/// ["a.b"]; VALUE is JSON, or else a text as it stands. Throws InputError.
std::vector<SceneChange> readChanges(const std::vector<std::string>& texts);

/// Applies the changes to a member of "lights" or "cameras" and returns it. Throws InputError for a place
/// that doesn't exist.
Json changedMember(const JsonNode& node, std::vector<SceneChange>& changes);

/// Applies the other changes to a scene file. `top` may lack lights and cameras. All but the last key of a
/// place must exist. Changes of materials that the file doesn't define are left for changeMaterials(). Throws
/// InputError.
void changeScene(Json& top, const std::string& file, std::vector<SceneChange>& changes);

/// Applies the remaining changes to materials of mesh files (materials.NAME.KEY or materials[0].KEY). Decodes
/// textures. Throws InputError if there is no such material.
void changeMaterials(std::vector<SceneChange>& changes, const SearchFolders& where, Scene& scene);

/// Applies changes to the scene of a mesh file: to lights (lights[0].KEY or lights.NAME.KEY), ambient,
/// background, fog and lighting. Throws InputError for others.
void changeLoaded(std::vector<SceneChange>& changes, Scene& scene);

/// Throws InputError for a change whose place doesn't exist. known: the names that exist there.
void refuseChange(const SceneChange& change, const std::string& file, const std::vector<std::string>& known);

}  // namespace luciole
