#include "scene/obj/obj.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <unordered_map>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "scene/load_textures.hpp"
#include "scene/normals.hpp"
#include "scene/obj/mtl.hpp"
#include "scene/obj/obj_file.hpp"
#include "scene/triangulate.hpp"

namespace luciole {
namespace {

struct Triangle {
  std::array<ObjCorner, 3> corners;
  int entry;           ///< index of its material among the entries, -1: none or unknown
  unsigned smoothing;  ///< group; 0: flat
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

/// The paths that the arguments of an mtllib statement name: one file whose name may contain blanks, or else
/// several names separated by blanks. Files that don't exist are left out; their materials become the default
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

/// The materials of all files that the statements name, each file once.
std::vector<MtlEntry> readEntries(const std::string& path, const std::vector<std::string>& material_files) {
  std::vector<MtlEntry> entries;
  std::set<std::string> read;
  for (const std::string& arguments : material_files) {
    for (const std::string& file : materialPaths(std::filesystem::path(path).parent_path(), arguments)) {
      if (!read.insert(file).second) continue;
      for (MtlEntry& entry : readMtl(file)) entries.push_back(std::move(entry));
    }
  }
  return entries;
}

/// Cuts the file's faces into triangles. Of materials with one name the first counts.
std::vector<Triangle> cutFaces(const ObjFile& file, const std::vector<MtlEntry>& entries) {
  std::unordered_map<std::string, int> entry_of_name;
  for (const MtlEntry& entry : entries)
    entry_of_name.emplace(entry.name, static_cast<int>(&entry - entries.data()));
  std::vector<int> entry_of_material;
  for (const std::string& name : file.material_names) {
    const auto found = entry_of_name.find(name);
    entry_of_material.push_back(found == entry_of_name.end() ? -1 : found->second);
  }
  std::vector<Triangle> triangles;
  triangles.reserve(file.faces.size());
  std::vector<glm::dvec3> polygon;
  for (const ObjFace& face : file.faces) {
    if (face.corner_count < 3) continue;
    const ObjCorner* corners = &file.corners[face.first_corner];
    const int entry = face.material < 0 ? -1 : entry_of_material[face.material];
    if (face.corner_count == 3) {
      triangles.push_back({{corners[0], corners[1], corners[2]}, entry, face.smoothing});
      continue;
    }
    polygon.clear();
    for (int i = 0; i < face.corner_count; ++i) polygon.emplace_back(file.positions[corners[i].position]);
    for (const auto& [a, b, c] : triangulate(polygon))
      triangles.push_back({{corners[a], corners[b], corners[c]}, entry, face.smoothing});
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

/// Makes one vertex for each distinct (position, normal, uv).
class VertexMaker {
 public:
  VertexMaker(const ObjFile& file, Mesh& mesh)
      : file_(file), mesh_(mesh), first_(file.positions.size(), -1) {}

  std::uint32_t vertex(const ObjCorner& corner) {
    int* link = &first_[corner.position];
    for (; *link >= 0; link = &made_[*link].next) {
      const ObjCorner& other = made_[*link].corner;
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
    ObjCorner corner;
    int next;  ///< the next vertex at the same position, or -1
  };
  const ObjFile& file_;
  Mesh& mesh_;
  std::vector<int> first_;  ///< the first vertex of each position, or -1
  std::vector<Made> made_;
};

/// Adds the materials that triangles use, their textures not decoded yet. Returns their indices in the scene
/// by entry + 1; 0: the default material.
std::vector<std::optional<std::uint32_t>> addMaterials(const std::vector<MtlEntry>& entries,
                                                       const std::vector<Triangle>& triangles, Scene& scene) {
  std::vector<std::optional<std::uint32_t>> materials(entries.size() + 1);
  for (const Triangle& triangle : triangles) {
    std::optional<std::uint32_t>& index = materials[triangle.entry + 1];
    if (index) continue;
    index = static_cast<std::uint32_t>(scene.materials.size());
    Material material;
    material.name = "default";
    material.double_sided = true;
    if (triangle.entry >= 0) material = readMaterial(entries[triangle.entry], scene);
    scene.materials.push_back(material);
  }
  return materials;
}

/// Everything of the mesh but its materials.
Mesh makeMesh(ObjFile& file, std::vector<Triangle>& triangles) {
  normalize(file, triangles);
  windByNormals(file, triangles);
  addMissingNormals(file, triangles);
  Mesh mesh;
  mesh.triangles.reserve(triangles.size());
  VertexMaker maker(file, mesh);
  for (const Triangle& triangle : triangles) {
    glm::uvec3 vertices;
    for (int i = 0; i < 3; ++i) vertices[i] = maker.vertex(triangle.corners[i]);
    mesh.triangles.push_back(vertices);
  }
  return mesh;
}

}  // namespace

std::uint32_t loadObj(const std::string& path, Scene& scene, const std::vector<std::string>& /*search*/) {
  ObjFile file = readObjFile(path);
  const std::vector<MtlEntry> entries = readEntries(path, file.material_files);
  std::vector<Triangle> triangles = cutFaces(file, entries);
  if (triangles.empty()) throw InputError(path + ": has no faces, expected an OBJ file with at least one");

  const std::size_t first_material = scene.materials.size();
  const auto materials = addMaterials(entries, triangles, scene);
  Mesh mesh;
  const auto make = [&] { mesh = makeMesh(file, triangles); };
  if (allDecoded(scene))
    make();  // in this thread, whose memory is warm
  else
    tbb::parallel_invoke([&] { decodeTextures(scene); }, make);
  for (std::size_t i = first_material; i < scene.materials.size(); ++i) cutHoles(scene.materials[i], scene);
  mesh.name = path;
  mesh.triangle_materials.reserve(triangles.size());
  for (const Triangle& triangle : triangles)
    mesh.triangle_materials.push_back(*materials[triangle.entry + 1]);
  const std::uint32_t index = static_cast<std::uint32_t>(scene.meshes.size());
  scene.meshes.push_back(std::move(mesh));
  scene.objects.push_back({index, glm::dmat4(1.0), -1});
  return index;
}

}  // namespace luciole
