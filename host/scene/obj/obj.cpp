#include "scene/obj/obj.hpp"

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <unordered_map>

#include "base/large_pages.hpp"
#include "base/text_file.hpp"
#include "base/utf8.hpp"
#include "image/srgb.hpp"
#include "luciole/error.hpp"
#include "scene/find_file.hpp"
#include "scene/load_textures.hpp"
#include "scene/normals.hpp"
#include "scene/obj/mtl.hpp"
#include "scene/obj/obj_file.hpp"
#include "scene/obj/obj_text.hpp"
#include "scene/triangulate.hpp"

namespace luciole {
namespace {

/// A limit of vertex colours, far above any that is meant.
constexpr double kMostColor = 1e6;
/// An sRGB value above which colours are hardly meant so; linear it is 900 times white.
constexpr double kMostSrgb = 16;

struct Triangle {
  std::array<ObjCorner, 3> corners;
  int entry;           ///< index of its material among the entries, -1: none or unknown
  int part;            ///< index of the object that it is of, among Parts::names
  unsigned smoothing;  ///< group; 0: flat
};

/// The names in an mtllib statement without quotes: each ends with ".mtl", or else at a blank.
std::vector<std::string> cutAtEndings(std::string_view words) {
  std::vector<std::string> names;
  std::string_view rest = words, name;
  const auto ends = [](std::string_view word) {
    return word.size() >= 4 && isKeyword(word.substr(word.size() - 4), ".mtl");
  };
  for (std::string_view word; !(word = takeWord(rest)).empty();) {
    const char* const begin = name.empty() ? word.data() : name.data();
    name = {begin, word.data() + word.size()};
    if (!ends(word)) continue;
    names.emplace_back(name);
    name = {};
  }
  while (!(name = trimmed(name)).empty()) names.emplace_back(takeWord(name));
  return names;
}

/// The names in an mtllib statement.
std::vector<std::string> namesIn(std::string_view words) {
  words = nameWithoutComment(words);
  std::vector<std::string> names;
  while (!(words = trimmed(words)).empty()) {
    const std::size_t quote = words.find('"'), end = words.find('"', quote + 1);
    const bool has_quotes = quote != words.npos && end != words.npos;
    for (std::string& name : cutAtEndings(words.substr(0, has_quotes ? quote : words.npos)))
      names.push_back(std::move(name));
    if (!has_quotes) break;
    names.emplace_back(words.substr(quote + 1, end - quote - 1));
    words.remove_prefix(end + 1);
  }
  return names;
}

/// The paths that the arguments of an mtllib statement name: one file whose name may contain blanks, or else
/// several. `miss` is called with those that aren't there.
template <class Miss>
std::vector<std::string> materialPaths(const SearchFolders& where, const std::string& arguments,
                                       const Miss& miss) {
  for (const std::string& name : spellings(arguments))
    if (const std::filesystem::path whole = std::filesystem::path(where.folder) / name; isFile(whole))
      return {whole.string()};
  std::vector<std::string> paths;
  const auto find = [&](const std::string& name) {
    for (const std::string& spelling : spellings(name)) {
      const std::filesystem::path beside = std::filesystem::path(where.folder) / spelling;
      const auto path = isFile(beside) ? beside.string() : findFile(spelling, where);
      if (!path) continue;
      paths.push_back(*path);
      return true;
    }
    return false;
  };
  for (const std::string& name : namesIn(arguments)) {
    if (find(name)) continue;
    bool any_word = false;
    std::string_view rest = name;
    if (name.find(' ') != name.npos)
      for (std::string_view word; !(word = takeWord(rest)).empty();) any_word |= find(std::string(word));
    if (name.starts_with('#')) break;  // a comment
    if (!any_word) miss(name);
  }
  return paths;
}

/// The materials of all files that the statements name, each file once. Files that aren't there are told;
/// their materials become the default one.
std::vector<MtlEntry> readEntries(const std::string& path, const std::vector<std::string>& material_files,
                                  const std::vector<std::string>& search, Scene& scene) {
  const SearchFolders where{std::filesystem::path(path).parent_path().string(), search};
  std::vector<MtlEntry> entries;
  std::set<std::string> read, statements, missed;
  const auto miss = [&](const std::string& name) {
    if (!missed.insert(name).second) return;
    scene.warnings.push_back(
        {fmt::format("{}: there is no material file '{}'", path, forMessage(name)), "missing material file"});
  };
  for (const std::string& arguments : material_files) {
    if (!statements.insert(arguments).second) continue;
    for (const std::string& file : materialPaths(where, arguments, miss)) {
      if (!read.insert(file).second) continue;
      for (MtlEntry& entry : readMtl(file, scene.warnings)) entries.push_back(std::move(entry));
    }
  }
  return entries;
}

/// Finds the entries of names. What may be quotes or a comment is part of a name where there is a material of
/// all of it.
class EntryNames {
 public:
  /// Of entries with one name the first counts.
  explicit EntryNames(std::vector<MtlEntry>& entries) {
    for (MtlEntry& entry : entries) {
      const auto [first, is_new] = indices_.emplace(entry.name, static_cast<int>(&entry - entries.data()));
      if (!is_new && entries[first->second].statements != entry.statements)
        entries[first->second].is_given_twice = true;
    }
    for (const MtlEntry& entry : entries)
      for (std::string& spelling : spellings(entry.name))
        indices_.emplace(std::move(spelling), static_cast<int>(&entry - entries.data()));
  }

  /// -1: there is none.
  int find(const std::string& name) const {
    for (const std::string& spelling : spellings(utf8Of(name)))
      if (const auto found = indices_.find(spelling); found != indices_.end()) return found->second;
    return -1;
  }

 private:
  std::unordered_map<std::string, int> indices_;
};

/// The entries of the file's usemtl statements, -1 for none. Tells those that faces use and that aren't
/// there.
std::vector<int> findEntries(const std::string& path, const ObjFile& file, std::vector<MtlEntry>& entries,
                             std::vector<Warning>& warnings) {
  const EntryNames names(entries);
  std::vector<bool> is_used(file.material_names.size());
  for (const ObjFace& face : file.faces)
    if (face.material >= 0) is_used[face.material] = true;
  std::vector<int> found;
  std::set<std::string> missed;
  for (const std::string& name : file.material_names) {
    found.push_back(names.find(name));
    if (found.back() >= 0 || !is_used[found.size() - 1] || !missed.insert(name).second) continue;
    warnings.push_back(
        {fmt::format("{}: there is no material '{}'; its faces are grey", path, forMessage(name)),
         "missing material"});
  }
  return found;
}

/// The objects of a file.
struct Parts {
  std::vector<std::string> names;  ///< may be empty
  std::vector<int> of_statement;   ///< by ObjFace::part + 1
};

/// The objects that statements of one kind make, of those that have faces.
Parts partsBy(const ObjFile& file, const std::vector<bool>& is_used, bool is_object) {
  Parts parts;
  std::unordered_map<std::string, int> known;
  std::string name;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (i > 0 && file.parts[i - 1].is_object == is_object) name = file.parts[i - 1].name;
    int part = -1;
    if (is_used[i]) {
      part = known.emplace(name, static_cast<int>(parts.names.size())).first->second;
      if (part == static_cast<int>(parts.names.size())) parts.names.push_back(utf8Of(name));
    }
    parts.of_statement.push_back(part);
  }
  return parts;
}

/// The most objects that a file is taken apart into.
constexpr std::size_t kMostParts = 100'000;

/// The file's objects by its o statements, or by its g statements if these make one object only; those of
/// one name are one.
Parts partsOf(const std::string& path, const ObjFile& file, std::vector<Warning>& warnings) {
  std::vector<bool> is_used(file.parts.size() + 1);
  for (const ObjFace& face : file.faces) is_used[face.part + 1] = true;
  Parts objects = partsBy(file, is_used, true);
  if (objects.names.size() == 1) {
    Parts groups = partsBy(file, is_used, false);
    // Faces before the first g are the object's.
    for (std::string& name : groups.names)
      if (name.empty()) name = objects.names[0];
    if (groups.names.size() > 1 || objects.names[0].empty()) objects = std::move(groups);
  }
  if (objects.names.size() <= kMostParts) return objects;
  warnings.push_back({fmt::format("{}: has {} named parts, expected {} at most; drawn as one object", path,
                                  objects.names.size(), kMostParts),
                      "too many parts"});
  return {{""}, std::vector<int>(is_used.size(), 0)};
}

/// The index of a face's material among the entries, -1: none or unknown.
int entryOf(const ObjFace& face, const std::vector<int>& entry_of_material) {
  return face.material < 0 ? -1 : entry_of_material[face.material];
}

/// Cuts the file's faces into triangles.
std::vector<Triangle> cutFaces(const ObjFile& file, const std::vector<int>& entry_of_material,
                               const Parts& parts) {
  std::vector<Triangle> triangles;
  reserveLarge(triangles, file.faces.size());
  std::vector<glm::dvec3> polygon;
  for (const ObjFace& face : file.faces) {
    const ObjCorner* corners = &file.corners[face.first_corner];
    const int entry = entryOf(face, entry_of_material);
    const int part = parts.of_statement[face.part + 1];
    if (face.corner_count == 3) {
      triangles.push_back({{corners[0], corners[1], corners[2]}, entry, part, face.smoothing});
      continue;
    }
    polygon.clear();
    for (int i = 0; i < face.corner_count; ++i) polygon.emplace_back(file.positions[corners[i].position]);
    for (const auto& [a, b, c] : triangulate(polygon))
      triangles.push_back({{corners[a], corners[b], corners[c]}, entry, part, face.smoothing});
  }
  return triangles;
}

/// Normalizes the file's normals. Corners whose normal has no direction get none.
void normalize(ObjFile& file, std::vector<Triangle>& triangles) {
  bool all_usable = true;
  for (glm::vec3& normal : file.normals) {
    const double length = glm::length(glm::dvec3(normal));
    all_usable &= length > 0;
    normal = length > 0 ? glm::vec3(glm::dvec3(normal) / length) : glm::vec3(0);
  }
  if (all_usable) return;
  for (Triangle& triangle : triangles) {
    for (ObjCorner& corner : triangle.corners) {
      if (corner.normal >= 0 && file.normals[corner.normal] == glm::vec3(0)) corner.normal = -1;
    }
  }
}

/// Reverses triangles that face away from the file's normals, where all three corners have one.
void windByNormals(const ObjFile& file, std::vector<Triangle>& triangles) {
  for (Triangle& triangle : triangles) {
    auto& [a, b, c] = triangle.corners;
    if (a.normal < 0 || b.normal < 0 || c.normal < 0) continue;
    const glm::dvec3 origin(file.positions[a.position]);
    const glm::dvec3 face = glm::cross(glm::dvec3(file.positions[b.position]) - origin,
                                       glm::dvec3(file.positions[c.position]) - origin);
    const glm::dvec3 sum(file.normals[a.normal] + file.normals[b.normal] + file.normals[c.normal]);
    if (glm::dot(face, sum) < 0) std::swap(b, c);
  }
}

/// Gives a normal to corners without one: smooth within a smoothing group, flat outside of groups.
void addMissingNormals(ObjFile& file, std::vector<Triangle>& triangles) {
  const auto has_all = [](const Triangle& triangle) {
    return std::all_of(triangle.corners.begin(), triangle.corners.end(),
                       [](const ObjCorner& c) { return c.normal >= 0; });
  };
  if (std::all_of(triangles.begin(), triangles.end(), has_all)) return;

  // A joint is a position as one smoothing group sees it; a flat triangle has three of its own.
  std::unordered_map<std::uint64_t, std::uint32_t> joints;
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> joined;
  for (const Triangle& triangle : triangles) {
    glm::uvec3 corners;
    for (int i = 0; i < 3; ++i) {
      const int position = triangle.corners[i].position;
      const std::uint64_t key =
          std::uint64_t{triangle.smoothing} << 32 | static_cast<std::uint32_t>(position);
      const std::uint32_t fresh = static_cast<std::uint32_t>(positions.size());
      corners[i] = triangle.smoothing == 0 ? fresh : joints.emplace(key, fresh).first->second;
      if (corners[i] == fresh) positions.push_back(file.positions[position]);
    }
    joined.push_back(corners);
  }
  const std::vector<glm::vec3> normals = angleWeightedNormals(positions, joined);
  const int first = static_cast<int>(file.normals.size());
  file.normals.insert(file.normals.end(), normals.begin(), normals.end());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int j = 0; j < 3; ++j) {
      int& normal = triangles[i].corners[j].normal;
      if (normal < 0) normal = first + static_cast<int>(joined[i][j]);
    }
  }
}

/// The file's vertex colours, which are sRGB by custom, as linear light; white where there is none. Colours
/// that are whole numbers, some above 1, are taken as 0 to 255.
std::vector<glm::vec4> linearColors(const std::string& path, const ObjFile& file,
                                    std::vector<Warning>& warnings) {
  double most = 0;
  bool are_whole = true;
  for (const glm::dvec3& color : file.colors)
    for (int i = 0; i < 3; ++i) {
      most = std::max(most, color[i]);
      are_whole &= color[i] == std::floor(color[i]);
    }
  const bool are_bytes = are_whole && most > 1 && most <= 255;
  if (are_bytes)
    warnings.push_back(
        {fmt::format("{}: has vertex colours up to {}, expected 0 to 1; taken as 0 to 255", path, most),
         "vertex colours above 1", true});
  else if (most > kMostSrgb)
    warnings.push_back(
        {fmt::format("{}: has vertex colours up to {}, expected 0 to 1; drawn brighter than white", path,
                     most),
         "bright vertex colours"});
  const double scale = are_bytes ? 255 : 1;
  std::vector<glm::vec4> linear(file.colors.size(), glm::vec4(1));
  for (std::size_t i = 0; i < linear.size(); ++i)
    for (int c = 0; c < 3 && file.colors[i].r >= 0; ++c)
      linear[i][c] = static_cast<float>(std::min(decodeSrgb(file.colors[i][c] / scale), kMostColor));
  return linear;
}

/// The materials of a file's triangles.
struct FileMaterials {
  std::vector<std::optional<std::uint32_t>> in_scene;  ///< by entry + 1; 0: the default material
  std::vector<int> places;                             ///< by entry + 1: index in distinct_places
  std::vector<MapPlaces> distinct_places{{}};          ///< the first is of maps that lie as the file says
};

/// Adds the materials that faces use, their textures not decoded yet.
FileMaterials addMaterials(const std::vector<MtlEntry>& entries, const std::vector<ObjFace>& faces,
                           const std::vector<int>& entry_of_material, MtlReading& reading) {
  FileMaterials materials{std::vector<std::optional<std::uint32_t>>(entries.size() + 1),
                          std::vector<int>(entries.size() + 1)};
  for (const ObjFace& face : faces) {
    const int entry = entryOf(face, entry_of_material);
    const std::size_t which = entry + 1;
    if (materials.in_scene[which]) continue;
    materials.in_scene[which] = static_cast<std::uint32_t>(reading.scene.materials.size());
    MtlMaterial made;
    made.material.name = "default";
    made.material.double_sided = true;
    if (entry >= 0) made = readMaterial(entries[entry], reading);
    reading.scene.materials.push_back(made.material);
    std::vector<MapPlaces>& distinct = materials.distinct_places;
    const auto found = std::find(distinct.begin(), distinct.end(), made.places);
    materials.places[which] = static_cast<int>(found - distinct.begin());
    if (found == distinct.end()) distinct.push_back(made.places);
  }
  return materials;
}

/// Texture coordinates of a mesh, v growing downwards, of those of the file. 0 where they grow past floats.
glm::vec2 placed(const MapPlace& place, const glm::vec2& uv) {
  if (place == MapPlace()) return {uv.x, 1 - uv.y};
  const glm::vec2 moved(place.scale * glm::dvec2(uv) + place.offset);
  return {std::isfinite(moved.x) ? moved.x : 0.0f, std::isfinite(moved.y) ? 1 - moved.y : 0.0f};
}

/// Makes the vertices of meshes, one for each distinct (position, normal, uv, places of maps).
class VertexMaker {
 public:
  VertexMaker(const ObjFile& file, const std::vector<glm::vec4>& colors, const std::vector<MapPlaces>& places)
      : file_(file), colors_(colors), places_(places), first_(file.positions.size(), -1) {
    for (const MapPlaces& those : places) {
      glows_apart_ |= those.emission != those.diffuse;
      bends_apart_ |= those.normal != those.diffuse;
    }
  }

  /// Begins a mesh, which shares no vertices with those before.
  void begin(Mesh& mesh) {
    mesh_ = &mesh;
    made_before_ = static_cast<int>(made_.size());
  }

  std::uint32_t vertex(const ObjCorner& corner, int places) {
    int* link = &first_[corner.position];
    if (*link < made_before_) *link = -1;
    for (; *link >= 0; link = &made_[*link].next) {
      const Made& other = made_[*link];
      if (other.corner.normal == corner.normal && other.corner.uv == corner.uv && other.places == places)
        return static_cast<std::uint32_t>(*link - made_before_);
    }
    *link = static_cast<int>(made_.size());
    made_.push_back({corner, places, -1});
    mesh_->positions.push_back(file_.positions[corner.position]);
    mesh_->normals.push_back(file_.normals[corner.normal]);
    if (!file_.uvs.empty()) addUvs(corner.uv < 0 ? glm::vec2(0) : file_.uvs[corner.uv], places_[places]);
    if (!colors_.empty()) mesh_->colors.push_back(colors_[corner.position]);
    return static_cast<std::uint32_t>(made_.size()) - 1 - static_cast<std::uint32_t>(made_before_);
  }

 private:
  void addUvs(const glm::vec2& uv, const MapPlaces& places) {
    mesh_->uvs.push_back(placed(places.diffuse, uv));
    if (glows_apart_) mesh_->emission_uvs.push_back(placed(places.emission, uv));
    if (bends_apart_) mesh_->normal_uvs.push_back(placed(places.normal, uv));
    // A light map must not repeat as the diffuse map does.
    if (places_.size() > 1) mesh_->lightmap_uvs.push_back(placed({}, uv));
  }

  struct Made {
    ObjCorner corner;
    int places;
    int next;  ///< the next vertex at the same position, or -1
  };
  const ObjFile& file_;
  const std::vector<glm::vec4>& colors_;
  const std::vector<MapPlaces>& places_;
  bool glows_apart_ = false, bends_apart_ = false;
  Mesh* mesh_ = nullptr;
  int made_before_ = 0;     ///< how many vertices the meshes before have
  std::vector<int> first_;  ///< the first vertex of each position, or one of a mesh before, or -1
  std::vector<Made> made_;
};

/// The numbers of the triangles of each part, in their order.
std::vector<std::vector<std::size_t>> trianglesOfParts(const std::vector<Triangle>& triangles,
                                                       std::size_t parts) {
  std::vector<std::size_t> counts(parts);
  for (const Triangle& triangle : triangles) ++counts[triangle.part];
  std::vector<std::vector<std::size_t>> numbers(parts);
  for (std::size_t i = 0; i < parts; ++i) numbers[i].reserve(counts[i]);
  for (std::size_t i = 0; i < triangles.size(); ++i) numbers[triangles[i].part].push_back(i);
  return numbers;
}

/// A mesh a part.
std::vector<Mesh> makeMeshes(ObjFile& file, const std::vector<glm::vec4>& colors,
                             const FileMaterials& materials, std::size_t parts,
                             std::vector<Triangle>& triangles) {
  normalize(file, triangles);
  windByNormals(file, triangles);
  addMissingNormals(file, triangles);
  std::vector<Mesh> meshes(parts);
  VertexMaker maker(file, colors, materials.distinct_places);
  const auto numbers = trianglesOfParts(triangles, parts);
  for (std::size_t part = 0; part < parts; ++part) {
    Mesh& mesh = meshes[part];
    maker.begin(mesh);
    mesh.triangles.reserve(numbers[part].size());
    mesh.triangle_materials.reserve(numbers[part].size());
    for (const std::size_t i : numbers[part]) {
      const Triangle& triangle = triangles[i];
      const int places = materials.places[triangle.entry + 1];
      glm::uvec3 vertices;
      for (int j = 0; j < 3; ++j) vertices[j] = maker.vertex(triangle.corners[j], places);
      mesh.triangles.push_back(vertices);
      mesh.triangle_materials.push_back(*materials.in_scene[triangle.entry + 1]);
    }
  }
  return meshes;
}

}  // namespace

std::uint32_t loadObj(const std::string& path, Scene& scene, const std::vector<std::string>& search) {
  ObjFile file = readObjFile(path);
  if (file.faces.empty())
    throw InputError(fmt::format("{}: has {}, expected an OBJ file with at least one", path,
                                 file.has_lines ? "points, lines or curves, but no faces" : "no faces"));
  scene.warnings.insert(scene.warnings.end(), file.warnings.begin(), file.warnings.end());
  std::vector<MtlEntry> entries = readEntries(path, file.material_files, search, scene);
  const std::vector<int> entry_of_material = findEntries(path, file, entries, scene.warnings);
  const Parts parts = partsOf(path, file, scene.warnings);
  const std::vector<glm::vec4> colors = linearColors(path, file, scene.warnings);

  const std::size_t first_material = scene.materials.size();
  MtlReading reading{scene, search};
  const FileMaterials materials = addMaterials(entries, file.faces, entry_of_material, reading);
  std::vector<Mesh> meshes;
  const auto make = [&] {
    std::vector<Triangle> triangles = cutFaces(file, entry_of_material, parts);
    meshes = makeMeshes(file, colors, materials, parts.names.size(), triangles);
  };
  if (allDecoded(scene))
    make();  // in this thread, whose memory is warm
  else
    tbb::parallel_invoke([&] { decodeTextures(scene); }, make);
  for (std::size_t i = first_material; i < scene.materials.size(); ++i) cutHoles(scene.materials[i], scene);
  const std::uint32_t first = static_cast<std::uint32_t>(scene.meshes.size());
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    meshes[i].name = utf8Of(path);
    scene.objects.push_back({first + static_cast<std::uint32_t>(i), glm::dmat4(1.0), -1, parts.names[i]});
    scene.meshes.push_back(std::move(meshes[i]));
  }
  return first;
}

}  // namespace luciole
