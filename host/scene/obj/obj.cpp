#include "scene/obj/obj.hpp"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <sstream>
#include <type_traits>
#include <unordered_map>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "scene/load_textures.hpp"
#include "scene/normals.hpp"
#include "scene/obj/mtl.hpp"
#include "scene/obj/obj_text.hpp"
#include "scene/triangulate.hpp"

namespace luciole {
namespace {

/// Where a triangle's corner finds its data in the file's lists; -1: the file gives none.
struct Corner {
  int position;
  int normal;
  int uv;
};

struct Triangle {
  std::array<Corner, 3> corners;
  int entry;           ///< index of its material in ObjFile::entries, -1: none or unknown
  unsigned smoothing;  ///< group; 0: flat
};

/// A parsed OBJ file with its polygons cut into triangles.
struct ObjFile {
  std::vector<MtlEntry> entries;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> colors;  ///< one a position, or none
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> uvs;  ///< v grows upwards, as in the file
  std::vector<Triangle> triangles;
};

/// Tells tinyobjloader the materials' names and nothing else: their values are read when a face uses them.
class NamesOnly : public tinyobj::MaterialReader {
 public:
  explicit NamesOnly(const std::vector<MtlEntry>& entries) : entries_(entries) {}
  bool operator()(const std::string&, std::vector<tinyobj::material_t>*, std::map<std::string, int>* ids,
                  std::string*, std::string*) override {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      std::string name = entries_[i].name;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return c == ' ' || c == '\t'; }, kNameBlank);
      ids->emplace(name, static_cast<int>(i));
    }
    return true;
  }

 private:
  const std::vector<MtlEntry>& entries_;
};

std::string withSlashes(const std::string& words) {
  std::string path;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool escaped_blank = words[i] == '\\' && i + 1 < words.size() && words[i + 1] == ' ';
    if (escaped_blank) continue;
    path += words[i] == '\\' ? '/' : words[i];
  }
  return path;
}

/// The paths that the arguments of an mtllib statement name: one file whose name may hold blanks, or else
/// several names with blanks between. Files that don't exist are left out: their materials become the default
/// one.
std::vector<std::string> materialPaths(const std::filesystem::path& folder, const std::string& arguments) {
  const std::filesystem::path whole = folder / withSlashes(arguments);
  if (isFile(whole)) return {whole.string()};
  std::vector<std::string> paths;
  for (std::size_t begin = 0; begin < arguments.size();) {
    std::size_t end = begin;
    while (end < arguments.size() && (arguments[end] != ' ' || (end > begin && arguments[end - 1] == '\\')))
      ++end;
    const std::filesystem::path path = folder / withSlashes(arguments.substr(begin, end - begin));
    if (end > begin && isFile(path)) paths.push_back(path.string());
    begin = end + 1;
  }
  return paths;
}

std::vector<MtlEntry> readEntries(const std::string& path, const std::vector<std::string>& material_files) {
  std::vector<MtlEntry> entries;
  for (const std::string& arguments : material_files) {
    for (const std::string& file : materialPaths(std::filesystem::path(path).parent_path(), arguments)) {
      for (MtlEntry& entry : readMtl(file)) entries.push_back(std::move(entry));
    }
  }
  return entries;
}

void addFace(ObjFile& file, const tinyobj::index_t* corners, int count, int entry, unsigned smoothing) {
  if (count < 3) return;
  std::vector<glm::dvec3> polygon;
  for (int i = 0; i < count; ++i) polygon.emplace_back(file.positions[corners[i].vertex_index]);
  for (const std::array<int, 3>& cut : triangulate(polygon)) {
    Triangle triangle{{}, entry, smoothing};
    for (int i = 0; i < 3; ++i) {
      const tinyobj::index_t& corner = corners[cut[i]];
      triangle.corners[i] = {corner.vertex_index, corner.normal_index, corner.texcoord_index};
    }
    file.triangles.push_back(triangle);
  }
}

ObjFile parse(const std::string& path) {
  ObjText obj = readObjText(path);
  ObjFile file;
  file.entries = readEntries(path, obj.material_files);
  NamesOnly reader(file.entries);
  obj.text.insert(0, "mtllib names\n");

  tinyobj::attrib_t lists;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> unused;
  std::string warnings, errors;
  std::istringstream stream(std::move(obj.text));
  // Polygons stay whole: tinyobjloader cuts concave quads wrongly.
  if (!tinyobj::LoadObj(&lists, &shapes, &unused, &warnings, &errors, &stream, &reader, false, false)) {
    throw InputError(path + ": " + forMessage(errors));
  }
  const auto vectors = [](const std::vector<float>& values, auto& list) {
    constexpr int n = std::remove_reference_t<decltype(list)>::value_type::length();
    list.resize(values.size() / n);
    for (std::size_t i = 0; i < list.size(); ++i) {
      for (int j = 0; j < n; ++j) list[i][j] = values[n * i + j];
    }
  };
  vectors(lists.vertices, file.positions);
  vectors(lists.normals, file.normals);
  vectors(lists.texcoords, file.uvs);
  if (lists.colors.size() == lists.vertices.size()) vectors(lists.colors, file.colors);

  for (const tinyobj::shape_t& shape : shapes) {
    std::size_t first = 0;
    for (std::size_t face = 0; face < shape.mesh.num_face_vertices.size(); ++face) {
      const int count = shape.mesh.num_face_vertices[face];
      const unsigned smoothing = obj.has_smoothing ? shape.mesh.smoothing_group_ids[face] : 1;
      addFace(file, &shape.mesh.indices[first], count, shape.mesh.material_ids[face], smoothing);
      first += count;
    }
  }
  if (file.triangles.empty())
    throw InputError(path + ": has no faces, expected an OBJ file with at least one");
  return file;
}

/// Makes the file's normals unit; corners whose normal has no direction are left without.
void normalize(ObjFile& file) {
  std::vector<bool> usable;
  for (glm::vec3& normal : file.normals) {
    const double length = glm::length(glm::dvec3(normal));
    usable.push_back(length > 0);
    if (length > 0) normal = glm::vec3(glm::dvec3(normal) / length);
  }
  for (Triangle& triangle : file.triangles) {
    for (Corner& corner : triangle.corners) {
      if (corner.normal >= 0 && !usable[corner.normal]) corner.normal = -1;
    }
  }
}

/// Winds triangles to agree with the file's normals, where all three corners have one.
void windByNormals(ObjFile& file) {
  for (Triangle& triangle : file.triangles) {
    auto& [a, b, c] = triangle.corners;
    if (a.normal < 0 || b.normal < 0 || c.normal < 0) continue;
    const glm::dvec3 origin(file.positions[a.position]);
    const glm::dvec3 face = glm::cross(glm::dvec3(file.positions[b.position]) - origin,
                                       glm::dvec3(file.positions[c.position]) - origin);
    const glm::dvec3 sum(file.normals[a.normal] + file.normals[b.normal] + file.normals[c.normal]);
    if (glm::dot(face, sum) < 0) std::swap(b, c);
  }
}

/// Gives corners without a normal one, smooth within a smoothing group, flat outside any.
void addMissingNormals(ObjFile& file) {
  const auto has_all = [](const Triangle& triangle) {
    return std::all_of(triangle.corners.begin(), triangle.corners.end(),
                       [](const Corner& c) { return c.normal >= 0; });
  };
  if (std::all_of(file.triangles.begin(), file.triangles.end(), has_all)) return;

  // A joint is a position as one smoothing group sees it; a flat triangle has three of its own.
  std::unordered_map<std::uint64_t, std::uint32_t> joints;
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (const Triangle& triangle : file.triangles) {
    glm::uvec3 corners;
    for (int i = 0; i < 3; ++i) {
      const int position = triangle.corners[i].position;
      const std::uint64_t key =
          std::uint64_t{triangle.smoothing} << 32 | static_cast<std::uint32_t>(position);
      const std::uint32_t fresh = static_cast<std::uint32_t>(positions.size());
      corners[i] = triangle.smoothing == 0 ? fresh : joints.emplace(key, fresh).first->second;
      if (corners[i] == fresh) positions.push_back(file.positions[position]);
    }
    triangles.push_back(corners);
  }
  const std::vector<glm::vec3> normals = angleWeightedNormals(positions, triangles);
  const int first = static_cast<int>(file.normals.size());
  file.normals.insert(file.normals.end(), normals.begin(), normals.end());
  for (std::size_t i = 0; i < file.triangles.size(); ++i) {
    for (int j = 0; j < 3; ++j) {
      int& normal = file.triangles[i].corners[j].normal;
      if (normal < 0) normal = first + static_cast<int>(triangles[i][j]);
    }
  }
}

/// Hands out one vertex for each different (position, normal, uv).
class VertexMaker {
 public:
  VertexMaker(const ObjFile& file, Mesh& mesh)
      : file_(file), mesh_(mesh), first_(file.positions.size(), -1) {}

  std::uint32_t vertex(const Corner& corner) {
    int* link = &first_[corner.position];
    for (; *link >= 0; link = &made_[*link].next) {
      const Corner& other = made_[*link].corner;
      if (other.normal == corner.normal && other.uv == corner.uv) return *link;
    }
    const int index = *link = static_cast<int>(made_.size());
    made_.push_back({corner, -1});
    mesh_.positions.push_back(file_.positions[corner.position]);
    mesh_.normals.push_back(file_.normals[corner.normal]);
    if (!file_.uvs.empty()) {
      const glm::vec2 uv = corner.uv < 0 ? glm::vec2(0) : file_.uvs[corner.uv];
      mesh_.uvs.emplace_back(uv.x, 1 - uv.y);
    }
    if (!file_.colors.empty())
      mesh_.colors.emplace_back(glm::max(file_.colors[corner.position], glm::vec3(0)), 1.0f);
    return index;
  }

 private:
  struct Made {
    Corner corner;
    int next;  ///< the next vertex at the same position, or -1
  };
  const ObjFile& file_;
  Mesh& mesh_;
  std::vector<int> first_;  ///< the first vertex of each position, or -1
  std::vector<Made> made_;
};

/// The index in the scene of the material of each entry that a triangle uses; key -1: the default material.
std::map<int, std::uint32_t> addMaterials(const ObjFile& file, Scene& scene) {
  std::map<int, std::uint32_t> materials;
  for (const Triangle& triangle : file.triangles) {
    if (materials.count(triangle.entry)) continue;
    materials[triangle.entry] = static_cast<std::uint32_t>(scene.materials.size());
    Material material;
    material.name = "default";
    material.double_sided = true;
    if (triangle.entry >= 0) material = readMaterial(file.entries[triangle.entry], scene);
    scene.materials.push_back(material);
  }
  decodeTextures(scene);
  for (const auto& [entry, material] : materials) cutHoles(scene.materials[material], scene);
  return materials;
}

}  // namespace

std::uint32_t loadObj(const std::string& path, Scene& scene) {
  ObjFile file = parse(path);
  normalize(file);
  windByNormals(file);
  addMissingNormals(file);

  const std::map<int, std::uint32_t> materials = addMaterials(file, scene);
  Mesh mesh;
  mesh.name = path;
  VertexMaker maker(file, mesh);
  for (const Triangle& triangle : file.triangles) {
    glm::uvec3 vertices;
    for (int i = 0; i < 3; ++i) vertices[i] = maker.vertex(triangle.corners[i]);
    mesh.triangles.push_back(vertices);
    mesh.triangle_materials.push_back(materials.at(triangle.entry));
  }
  const std::uint32_t index = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(std::move(mesh));
  scene.objects.push_back({index, glm::dmat4(1.0), -1});
  return index;
}

}  // namespace luciole
