#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "luciole/scene.hpp"
#include "scene/find_file.hpp"
#include "scene/json/json_fields.hpp"

// Places of a scene that get another value, as --set has them.
namespace luciole {

/// A member of an object by its key; an element of an array by its number, or by its "name".
struct ChangeStep {
  std::string key{};
  std::size_t index = JsonNode::kNoIndex;  ///< else the key says it
};

/// What is set to what.
struct SceneChange {
  std::string text;  ///< as typed
  std::vector<ChangeStep> place;
  Json value;
  bool is_made = false;
};

/// Where the PATH of "PATH=VALUE" ends: its = that isn't in a ["name"]. Throws InputError where it is no
/// PATH, which names the option.
std::size_t placeLength(const std::string& text, const std::string& option);

/// Reads texts PATH=VALUE. A PATH is keys by dots, elements as [0], and keys with dots of their own as
/// ["a.b"]; VALUE is JSON, or else a text as it stands. Throws InputError.
std::vector<SceneChange> readChanges(const std::vector<std::string>& texts);

/// Makes the changes inside of a member of "lights" or "cameras", or in its place. Throws InputError for a
/// place that isn't there.
Json changedMember(const JsonNode& node, std::vector<SceneChange>& changes);

/// Makes the other changes of a scene file, whose lights and cameras may be left out. All but the last key of
/// a place must be there. Changes of materials that the file doesn't have are left. Throws InputError.
void changeScene(Json& top, const std::string& file, std::vector<SceneChange>& changes);

/// Makes changes of a mesh file's materials (materials.NAME.KEY or materials[0].KEY) that aren't made yet.
/// Textures are decoded. Throws InputError where there is no such material.
void changeMaterials(std::vector<SceneChange>& changes, const SearchFolders& where, Scene& scene);

/// Makes changes of a mesh file's scene: of lights (lights[0].KEY or lights.NAME.KEY), and of what surrounds
/// it: ambient, background, fog and lighting. Throws InputError for others.
void changeLoaded(std::vector<SceneChange>& changes, Scene& scene);

/// Throws InputError for a change that isn't made: there is nothing in its place. known: what there is.
void refuseChange(const SceneChange& change, const std::string& file, const std::vector<std::string>& known);

}  // namespace luciole
