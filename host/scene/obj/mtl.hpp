#pragma once

#include <glm/glm.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// One material of a .mtl file, not yet interpreted.
struct MtlEntry {
  std::string name;             ///< UTF-8
  std::string file;             ///< path of the .mtl file
  std::string statements;       ///< those after its newmtl, one a line, without comments' lines
  bool is_given_twice = false;  ///< a later one of its name has other statements; it is ignored
};

/// The materials of a .mtl file in order. A file that isn't text has none. Warns of that and of statements
/// before the first material. Throws InputError.
std::vector<MtlEntry> readMtl(const std::string& path, std::vector<Warning>& warnings);

/// The transform of a map's texture coordinates by MTL's options -s and -o: scale · uv + offset, v growing
/// upwards.
struct MapPlace {
  glm::dvec2 scale{1.0};
  glm::dvec2 offset{0.0};

  bool operator==(const MapPlace&) const = default;
};

/// The transforms of a material's maps. Those of missing maps equal the diffuse map's.
struct MapPlaces {
  MapPlace diffuse;  ///< of the map_d, too
  MapPlace emission;
  MapPlace normal;

  bool operator==(const MapPlaces&) const = default;
};

/// The state of reading a file's materials.
struct MtlReading {
  Scene& scene;                          ///< gets their textures, not decoded yet, and warnings
  std::vector<std::string> search = {};  ///< folders of pictures, beside the file's own
  std::set<std::pair<std::string, std::string>> reported = {};  ///< what of which file was said to be ignored
};

struct MtlMaterial {
  Material material;
  MapPlaces places;
};

/// Converts a material by the rules of scenes/FORMATS.md. It is always double-sided, because OBJ says nothing
/// of culling. `d` and `Tr` are ignored: programs write "d 0" for opaque materials. A value that isn't a
/// number keeps the default, with a warning. Warns of ignored statements, once for each kind in a file.
/// Missing pictures go into Scene::missing_textures.
MtlMaterial readMaterial(const MtlEntry& entry, MtlReading& reading);

/// Sets alpha_cutoff, once the textures are decoded: with a map_d, or a diffuse map with some alpha below 1,
/// there are holes where the opacity is below one half.
void cutHoles(Material& material, const Scene& scene);

/// The possible file names in a statement's words, the likeliest first: unchanged, without a trailing
/// comment, without quotes, with "\\ " read as a blank; then all of these again without what may be a
/// comment.
std::vector<std::string> spellings(std::string_view words);

}  // namespace luciole
