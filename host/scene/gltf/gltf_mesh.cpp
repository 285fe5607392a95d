#include "scene/gltf/gltf_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

#include "scene/gltf/gltf_accessor.hpp"
#include "scene/gltf/gltf_rest.hpp"
#include "scene/gltf/gltf_uvs.hpp"
#include "scene/normals.hpp"

namespace luciole {
namespace {

/// The three vertices of a strip's triangle i; every other one is wound the other way round.
glm::uvec3 stripTriangle(std::uint32_t i) { return {i, i + 1 + i % 2, i + 2 - i % 2}; }

/// Appends the triangles of a run of vertices, by a primitive's mode.
void appendTriangles(int mode, std::span<const std::uint32_t> order, std::vector<glm::uvec3>& triangles) {
  const std::uint32_t count = static_cast<std::uint32_t>(order.size());
  const std::size_t before = triangles.size();
  if (mode == kGltfTriangles) {
    for (std::uint32_t i = 0; i + 2 < count; i += 3) triangles.emplace_back(i, i + 1, i + 2);
  } else if (mode == kGltfStrip) {
    for (std::uint32_t i = 0; i + 2 < count; ++i) triangles.push_back(stripTriangle(i));
  } else {
    for (std::uint32_t i = 0; i + 2 < count; ++i) triangles.emplace_back(i + 1, i + 2, 0);
  }
  for (std::size_t i = before; i < triangles.size(); ++i) {
    glm::uvec3& triangle = triangles[i];
    triangle = {order[triangle.x], order[triangle.y], order[triangle.z]};
  }
}

/// The index that WebGL takes for the end of a run of vertices: a type's greatest, which glTF forbids.
std::uint32_t restartIndex(const GltfModel& model, int accessor) {
  const int type = model.file.accessors[std::size_t(accessor)].type;
  return type == kGltfUnsignedByte ? 0xff : type == kGltfUnsignedShort ? 0xffff : 0xffffffff;
}

/// Triangles of vertex numbers, by the primitive's mode and indices.
std::vector<glm::uvec3> readTriangles(const GltfModel& model, const GltfPrimitive& primitive,
                                      std::size_t vertices, const std::string& place) {
  std::vector<std::uint32_t> order(vertices);
  std::iota(order.begin(), order.end(), 0);
  std::uint32_t restart = 0;
  if (primitive.indices >= 0) {
    order = readIndices(model, primitive.indices, place + ".indices");
    restart = restartIndex(model, primitive.indices);
  }
  std::size_t restarts = 0;
  for (const std::uint32_t index : order) {
    if (index < vertices) continue;
    if (index != restart)
      failGltf(model, place, fmt::format("index {}, but it has only {} vertices", index, vertices));
    ++restarts;
  }
  if (restarts > 0)
    warnRepaired(model, place,
                 fmt::format("{} of its indices are {}, but it has only {} vertices; taken for ends of runs",
                             restarts, restart, vertices),
                 "restart");
  else if (primitive.mode == kGltfTriangles && order.size() % 3 != 0)
    warnRepaired(model, place, fmt::format("{} corners, expected a multiple of 3", order.size()), "corners");
  std::vector<glm::uvec3> triangles;
  auto begin = order.begin();
  while (restarts > 0) {
    const auto end = std::find(begin, order.end(), restart);
    appendTriangles(primitive.mode, {begin, end}, triangles);
    if (end == order.end()) return triangles;
    begin = end + 1;
  }
  appendTriangles(primitive.mode, order, triangles);
  return triangles;
}

/// An attribute's values as vectors, one a vertex; empty where the primitive doesn't have it, or too few.
template <typename Vector>
std::vector<Vector> readAttribute(const GltfModel& model, const GltfPrimitive& primitive,
                                  const std::string& name, std::size_t vertices, const std::string& place) {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) return {};
  std::vector<Vector> values = readVectors<Vector>(model, found->second, place + "." + name);
  if (values.empty() || values.size() == vertices) return values;
  const bool is_longer = values.size() > vertices;
  warnRepaired(model, place,
               fmt::format("{} has {} elements for {} vertices; {}", name, values.size(), vertices,
                           is_longer ? "the last are left out" : "drawn as if without"),
               "elements");
  values.resize(is_longer ? vertices : 0);
  return values;
}

std::vector<glm::vec4> readColors(const GltfModel& model, const GltfPrimitive& primitive,
                                  std::size_t vertices, const std::string& place) {
  const auto found = primitive.attributes.find("COLOR_0");
  if (found == primitive.attributes.end()) return {};
  if (accessorComponents(model, found->second, place) == 4) {
    return readAttribute<glm::vec4>(model, primitive, "COLOR_0", vertices, place);
  }
  std::vector<glm::vec4> colors;
  for (const glm::vec3& rgb : readAttribute<glm::vec3>(model, primitive, "COLOR_0", vertices, place)) {
    colors.emplace_back(rgb, 1.0f);
  }
  return colors;
}

template <typename T>
std::vector<T> unshared(const std::vector<T>& values, const std::vector<glm::uvec3>& triangles) {
  std::vector<T> result;
  if (values.empty()) return result;
  for (const glm::uvec3& triangle : triangles) {
    for (int i = 0; i < 3; ++i) result.push_back(values[triangle[i]]);
  }
  return result;
}

/// Gives each triangle vertices of its own, with the flat normals that glTF prescribes where there are none.
void makeFlat(Mesh& mesh) {
  mesh.positions = unshared(mesh.positions, mesh.triangles);
  mesh.uvs = unshared(mesh.uvs, mesh.triangles);
  mesh.emission_uvs = unshared(mesh.emission_uvs, mesh.triangles);
  mesh.normal_uvs = unshared(mesh.normal_uvs, mesh.triangles);
  mesh.lightmap_uvs = unshared(mesh.lightmap_uvs, mesh.triangles);
  mesh.tangents.clear();  // glTF: those of a file without normals are to be ignored
  mesh.colors = unshared(mesh.colors, mesh.triangles);
  mesh.sources = unshared(mesh.sources, mesh.triangles);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) mesh.triangles[i] = {3 * i, 3 * i + 1, 3 * i + 2};
  mesh.normals = angleWeightedNormals(mesh.positions, mesh.triangles);
}

/// Counts the repaired elements of an attribute, for one warning.
class RepairCounter {
 public:
  void add(std::size_t element) {
    if (count_++ == 0) first_ = element;
  }
  /// Warns if any element was repaired. what: the elements' fault, and what was done.
  void warn(const GltfModel& model, const std::string& place, const char* what) const {
    if (count_ > 0)
      warnRepaired(model, place, fmt::format("{} elements, {} the first, {}", count_, first_, what), what);
  }

 private:
  std::size_t count_ = 0, first_ = 0;
};

/// Replaces vectors with a number that isn't finite by `otherwise`, the value of a missing one. Warns.
template <typename Vector>
void repairNumbers(const GltfModel& model, const Vector& otherwise, const std::string& place,
                   std::vector<Vector>& vectors) {
  RepairCounter not_finite;
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    bool is_finite = true;
    for (int c = 0; c < Vector::length(); ++c) is_finite = is_finite && std::isfinite(vectors[i][c]);
    if (is_finite) continue;
    vectors[i] = otherwise;
    not_finite.add(i);
  }
  not_finite.warn(model, place, "with a number that is not finite; drawn as if without");
}

/// Normalizes normals. Those without a direction become the angle-weighted mean of the faces around them.
void repairNormals(const GltfModel& model, const std::string& place, Mesh& mesh) {
  // Those of 8 bits are as long as 1 ± √3 / 254.
  constexpr double kMostOff = 0.01;
  RepairCounter not_unit, without_direction;
  std::vector<glm::vec3> from_faces;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    const double length = glm::length(glm::dvec3(mesh.normals[i]));
    if (length > 0 && std::isfinite(length)) {
      if (std::abs(length - 1) > kMostOff) not_unit.add(i);
      mesh.normals[i] = glm::vec3(glm::dvec3(mesh.normals[i]) / length);
    } else {
      if (from_faces.empty()) from_faces = angleWeightedNormals(mesh.positions, mesh.triangles);
      mesh.normals[i] = from_faces[i];
      without_direction.add(i);
    }
  }
  not_unit.warn(model, place, "not of length 1; made so");
  without_direction.warn(model, place, "without a direction; taken from the faces");
}

/// The material of a primitive in the chosen variant.
int materialOf(const GltfModel& model, const GltfPrimitive& primitive) {
  if (model.variant < 0) return primitive.material;
  const GltfJson& mappings = memberOf(memberOf(primitive.extensions, "KHR_materials_variants"), "mappings");
  if (!mappings.is_array()) return primitive.material;
  for (const GltfJson& mapping : mappings) {
    const GltfJson& variants = memberOf(mapping, "variants");
    if (!variants.is_array()) continue;
    for (const GltfJson& variant : variants) {
      if (!variant.is_number() || variant.get<double>() != model.variant) continue;
      const int material = indexOf(memberOf(mapping, "material"));
      // One that the file can't have is refused where it is looked up.
      return material >= 0 ? material : 1'000'000'000;
    }
  }
  return primitive.material;
}

/// Texture coordinates with the texture's transform applied; all of 0 0 where the primitive doesn't have
/// them, as in WebGL.
std::vector<glm::vec2> uvsOf(const GltfModel& model, const GltfPrimitive& primitive, const GltfUvs& use,
                             std::size_t vertices, const std::string& place) {
  const std::string name = fmt::format("TEXCOORD_{}", use.set);
  auto uvs = readAttribute<glm::vec2>(model, primitive, name, vertices, place);
  if (!primitive.attributes.count(name))
    warnRepaired(model, place,
                 fmt::format("has no {}, which a texture of its material wants; drawn with 0 0", name),
                 "no uvs");
  uvs.resize(vertices, glm::vec2(0));
  repairNumbers(model, glm::vec2(0), place + "." + name, uvs);
  if (use.matrix != glm::dmat2(1) || use.offset != glm::dvec2(0))
    for (glm::vec2& uv : uvs) uv = glm::vec2(use.matrix * glm::dvec2(uv) + use.offset);
  return uvs;
}

/// A primitive has one material, so the transforms of its textures can be applied to its vertices'
/// coordinates.
void readUvs(const GltfModel& model, const GltfPrimitive& primitive, const std::string& place, Mesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  // No picture needs these, so others than glTF's are none.
  const auto lightmapUvs = [&](const char* name) {
    const auto found = primitive.attributes.find(name);
    const bool has = found != primitive.attributes.end() &&
                     accessorComponents(model, found->second, place + "." + name) == 2;
    return has ? readAttribute<glm::vec2>(model, primitive, name, vertices, place) : std::vector<glm::vec2>();
  };
  const GltfUvs base = baseColorUvs(model, materialOf(model, primitive)),
                emission = emissionUvs(model, materialOf(model, primitive)),
                bent = normalUvs(model, materialOf(model, primitive));
  if (bent.set >= 0 && base.set < 0) mesh.uvs = uvsOf(model, primitive, bent, vertices, place);
  if (bent.set >= 0 && base.set >= 0 && bent != base)
    mesh.normal_uvs = uvsOf(model, primitive, bent, vertices, place);
  if (base.set >= 0) mesh.uvs = uvsOf(model, primitive, base, vertices, place);
  const bool has_uvs = base.set >= 0 || bent.set >= 0;
  mesh.lightmap_uvs = lightmapUvs("TEXCOORD_1");
  if (mesh.lightmap_uvs.empty() && !has_uvs && emission.set < 0)
    mesh.lightmap_uvs = lightmapUvs("TEXCOORD_0");
  if (emission.set < 0 || emission == (base.set >= 0 ? base : bent)) return;
  std::vector<glm::vec2>& uvs = has_uvs ? mesh.emission_uvs : mesh.uvs;
  uvs = uvsOf(model, primitive, emission, vertices, place);
}

/// rest: null, or what its shape at rest is appended to.
Mesh readPrimitive(const GltfModel& model, const GltfPrimitive& primitive, const std::string& place,
                   RestShape* rest) {
  Mesh mesh;
  if (primitive.mode > kGltfFan || primitive.mode < 0) {
    warnRepaired(model, place, fmt::format("mode {} is not one of glTF's; left out", primitive.mode), "mode");
    return mesh;
  }
  if (primitive.mode < kGltfTriangles) {
    warnRepaired(model, place,
                 fmt::format("mode {} is of {}, which are not drawn; left out", primitive.mode,
                             primitive.mode == 0 ? "points" : "lines"),
                 "points and lines");
    return mesh;
  }
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) {
    warnLeftOut(model, place, "has no POSITION; left out", "no positions");  // glTF permits it
    return mesh;
  }
  mesh.positions = readVectors<glm::vec3>(model, position->second, place + ".POSITION");
  const std::size_t vertices = mesh.positions.size();
  if (vertices == 0) return mesh;
  readUvs(model, primitive, place, mesh);
  mesh.normals = readAttribute<glm::vec3>(model, primitive, "NORMAL", vertices, place);
  mesh.colors = readColors(model, primitive, vertices, place);
  if (normalUvs(model, materialOf(model, primitive)).set >= 0)
    mesh.tangents = readAttribute<glm::vec4>(model, primitive, "TANGENT", vertices, place);
  checkFinite(model, mesh.positions, place + ".POSITION");
  // A transform of textures may overflow.
  checkFinite(model, mesh.uvs, place + ".TEXCOORD");
  checkFinite(model, mesh.emission_uvs, place + ".TEXCOORD");
  checkFinite(model, mesh.normal_uvs, place + ".TEXCOORD");
  repairNumbers(model, glm::vec4(0), place + ".TANGENT", mesh.tangents);
  repairNumbers(model, glm::vec4(1), place + ".COLOR_0", mesh.colors);
  for (glm::vec4& color : mesh.colors) color = glm::max(color, glm::vec4(0));

  mesh.triangles = readTriangles(model, primitive, mesh.positions.size(), place);
  const bool is_flat = mesh.normals.empty();
  if (!is_flat) repairNormals(model, place + ".NORMAL", mesh);
  if (rest) {
    mesh.sources.resize(mesh.positions.size());
    std::iota(mesh.sources.begin(), mesh.sources.end(), static_cast<std::uint32_t>(rest->positions.size()));
    appendRest(model, primitive, mesh, place, *rest);
  }
  if (is_flat) makeFlat(mesh);
  return mesh;
}

/// Appends an optional attribute; where only one side has it, the other's vertices get `missing`.
template <typename T>
void appendOptional(std::vector<T>& all, std::size_t count_before, const std::vector<T>& more,
                    std::size_t count_more, const T& missing) {
  if (all.empty() && more.empty()) return;
  all.resize(count_before, missing);
  all.insert(all.end(), more.begin(), more.end());
  all.resize(count_before + count_more, missing);
}

/// Appends coordinates of one use; a part without such takes its `uvs` for that use, too.
void appendUvs(std::vector<glm::vec2> Mesh::*uvs, Mesh& mesh, const Mesh& more) {
  if ((mesh.*uvs).empty() && (more.*uvs).empty()) return;
  if ((mesh.*uvs).empty()) mesh.*uvs = mesh.uvs;
  appendOptional(mesh.*uvs, mesh.positions.size(), (more.*uvs).empty() ? more.uvs : more.*uvs,
                 more.positions.size(), glm::vec2(0));
}

void append(Mesh& mesh, const Mesh& more, std::uint32_t material) {
  const std::size_t before = mesh.positions.size(), added = more.positions.size();
  appendUvs(&Mesh::emission_uvs, mesh, more);
  appendUvs(&Mesh::normal_uvs, mesh, more);
  appendUvs(&Mesh::lightmap_uvs, mesh, more);
  appendOptional(mesh.tangents, before, more.tangents, added, glm::vec4(0));
  appendOptional(mesh.uvs, before, more.uvs, added, glm::vec2(0));
  appendOptional(mesh.colors, before, more.colors, added, glm::vec4(1));
  mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
  mesh.normals.insert(mesh.normals.end(), more.normals.begin(), more.normals.end());
  mesh.sources.insert(mesh.sources.end(), more.sources.begin(), more.sources.end());
  for (const glm::uvec3& triangle : more.triangles) {
    mesh.triangles.push_back(triangle + static_cast<std::uint32_t>(before));
    mesh.triangle_materials.push_back(material);
  }
}

}  // namespace

Mesh readGltfMesh(const GltfModel& model, int index, std::vector<int>& materials,
                  std::uint32_t first_material, RestShape* rest) {
  const GltfMesh& source = model.file.meshes[std::size_t(index)];
  Mesh mesh;
  mesh.name = source.name;
  const std::string place = fmt::format("meshes[{}]", index);
  if (source.primitives.empty())
    warnRepaired(model, place, "has no primitives, expected at least one", "no primitives");
  for (std::size_t i = 0; i < source.primitives.size(); ++i) {
    const GltfPrimitive& primitive = source.primitives[i];
    const std::string here = fmt::format("{}.primitives[{}]", place, i);
    const int material = materialOf(model, primitive);
    if (material >= 0) element(model, model.file.materials, material, here, "material");
    const Mesh part = readPrimitive(model, primitive, here, rest);
    if (part.triangles.empty()) continue;
    auto known = std::find(materials.begin(), materials.end(), material);
    if (known == materials.end()) known = materials.insert(known, material);
    append(mesh, part, first_material + static_cast<std::uint32_t>(known - materials.begin()));
  }
  return mesh;
}

}  // namespace luciole
