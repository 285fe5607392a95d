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
  std::string file;             ///< the .mtl file's path
  std::string statements;       ///< those after its newmtl, one a line, without comments' lines
  bool is_given_twice = false;  ///< there is another of its name with other statements, which doesn't count
};

/// The materials of a .mtl file in order. Of a file that is no text there are none, and a warning, as for
/// statements before the first material. Throws InputError.
std::vector<MtlEntry> readMtl(const std::string& path, std::vector<Warning>& warnings);

/// Where a map lies on a surface, by MTL's options -s and -o: scale · uv + offset, v growing upwards.
struct MapPlace {
  glm::dvec2 scale{1.0};
  glm::dvec2 offset{0.0};

  bool operator==(const MapPlace&) const = default;
};

/// Where the maps of a material lie. Those that it doesn't have lie where the diffuse map does.
struct MapPlaces {
  MapPlace diffuse;  ///< of the map_d, too
  MapPlace emission;
  MapPlace normal;

  bool operator==(const MapPlaces&) const = default;
};

/// What the materials of a file are read with.
struct MtlReading {
  Scene& scene;                          ///< gets their textures, not decoded yet, and warnings
  std::vector<std::string> search = {};  ///< folders of pictures, beside the file's own
  std::set<std::pair<std::string, std::string>> reported = {};  ///< what of which file was said to be ignored
};

struct MtlMaterial {
  Material material;
  MapPlaces places;
};

/// Interprets a material; scenes/FORMATS.md says what of it is read. Always double-sided, because OBJ says
/// nothing of culling. `d` and `Tr` are ignored: nothing is blended here, and programs are known to write
/// "d 0" for opaque materials. A value that is no number leaves the default, with a warning; what is ignored
/// gets a warning, one of each kind a file. Missing pictures are noted in Scene::missing_textures.
MtlMaterial readMaterial(const MtlEntry& entry, MtlReading& reading);

/// Sets alpha_cutoff, once the textures are decoded: with a map_d, or a diffuse map with some alpha below 1,
/// there are holes where the opacity is below one half.
void cutHoles(Material& material, const Scene& scene);

/// The names that a statement's words may mean, the likeliest first: as they are, without a comment behind
/// them, without quotes, with blanks for backslashes before blanks; all of it again without what may be a
/// comment.
std::vector<std::string> spellings(std::string_view words);

}  // namespace luciole
