#include "scene/json_object.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <utility>
#include <vector>

#include "scene/load_textures.hpp"
#include "scene/mesh_file.hpp"
#include "scene/primitives.hpp"

namespace luciole {
namespace {

constexpr std::size_t kMostObjects = 10'000'000;

/// What has been loaded so far, by what would make it the same.
struct Loaded {
  std::uint32_t plain_material = 0;                       ///< of primitives that name none
  std::map<std::string, int> materials;                   ///< name -> index in Scene::materials
  std::map<std::string, std::vector<Object>> mesh_files;  ///< path -> its objects, placed as the file says
  std::map<Primitive, std::uint32_t> primitives;          ///< -> index in Scene::meshes
};

std::string readPath(const JsonNode& node, const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / readText(node)).lexically_normal().string();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) refuse(node, fmt::format("there is no file {}", path));
  if (std::filesystem::is_directory(path, ignored))
    refuse(node, fmt::format("{} is a folder; expected a file", path));
  return path;
}

TextureUse readMap(const JsonNode& node, const std::string& folder, Scene& scene) {
  TextureUse use;
  use.texture = addTexture(scene, readPath(node, folder));
  return use;
}

Material readMaterial(const JsonNode& node, const std::string& folder, Scene& scene) {
  allowKeys(node, {"ambient", "diffuse", "specular", "emission", "shininess", "diffuse_map", "emission_map",
                   "alpha_map", "alpha", "alpha_cutoff", "double_sided"});
  Material material;
  material.name = node.key;
  if (const auto n = find(node, "diffuse")) material.diffuse = readColor(*n);
  material.ambient = material.diffuse;
  if (const auto n = find(node, "ambient")) material.ambient = readColor(*n);
  if (const auto n = find(node, "specular")) material.specular = readColor(*n);
  if (const auto n = find(node, "shininess")) {
    material.shininess = static_cast<float>(readNumber(*n, 0, kLargestNumber));
  }
  if (const auto n = find(node, "diffuse_map")) material.diffuse_map = readMap(*n, folder, scene);
  if (const auto n = find(node, "emission_map")) {
    material.emission_map = readMap(*n, folder, scene);
    material.emission = glm::vec3(1);  // the map's factor: black would hide it
  }
  if (const auto n = find(node, "emission")) material.emission = readColor(*n);
  if (const auto n = find(node, "alpha_map")) {
    material.alpha_map = readMap(*n, folder, scene);
    material.alpha_cutoff = 0.5f;
  }
  if (const auto n = find(node, "alpha")) material.alpha = static_cast<float>(readNumber(*n, 0, 1));
  if (const auto n = find(node, "alpha_cutoff"))
    material.alpha_cutoff = static_cast<float>(readNumber(*n, 0, 1));
  if (const auto n = find(node, "double_sided")) material.double_sided = readBool(*n);
  return material;
}

Primitive readPrimitive(const JsonNode& object) {
  static const std::map<std::string, PrimitiveKind> kKinds{
      {"plane", PrimitiveKind::kPlane},   {"box", PrimitiveKind::kBox},
      {"sphere", PrimitiveKind::kSphere}, {"cylinder", PrimitiveKind::kCylinder},
      {"cone", PrimitiveKind::kCone},     {"torus", PrimitiveKind::kTorus}};
  const JsonNode node = need(object, "primitive");
  const auto kind = kKinds.find(readText(node));
  if (kind == kKinds.end()) {
    refuse(node,
           fmt::format("expected \"plane\", \"box\", \"sphere\", \"cylinder\", \"cone\" or \"torus\", got {}",
                       node.json->dump()));
  }
  Primitive primitive;
  primitive.kind = kind->second;
  const bool is_plane = primitive.kind == PrimitiveKind::kPlane;
  const bool is_box = primitive.kind == PrimitiveKind::kBox;
  if (is_box) refuseKeys(object, {"segments"}, "for a box");
  if (!is_plane && !is_box) primitive.segments = 64;
  if (const auto n = find(object, "segments")) {
    primitive.segments = static_cast<int>(readCount(*n, kMostSegments));
    const int fewest = is_plane ? 1 : 3;
    if (primitive.segments < fewest) refuse(*n, fmt::format("expected {} or more", fewest));
  }
  if (primitive.kind != PrimitiveKind::kTorus)
    refuseKeys(object, {"minor_radius"}, "for anything but a torus");
  if (const auto n = find(object, "minor_radius")) {
    primitive.minor_radius = static_cast<float>(readPositive(*n));
    if (primitive.minor_radius >= 1) refuse(*n, "expected less than 1, the major radius");
  }
  if (const auto n = find(object, "uv_scale")) primitive.uv_scale = static_cast<float>(readPositive(*n));
  return primitive;
}

glm::dmat4 readPlacement(const JsonNode& node) {
  glm::dmat4 placement{1.0};
  if (const auto n = find(node, "translate")) placement = glm::translate(placement, readVector(*n));
  if (const auto n = find(node, "rotate")) {
    const glm::dvec3 angles = glm::radians(readVector(*n));
    placement = glm::rotate(placement, angles.z, {0, 0, 1});
    placement = glm::rotate(placement, angles.y, {0, 1, 0});
    placement = glm::rotate(placement, angles.x, {1, 0, 0});
  }
  if (const auto n = find(node, "scale")) {
    const glm::dvec3 scale = n->json->is_array() ? readVector(*n) : glm::dvec3(readNumber(*n));
    for (int i = 0; i < 3; ++i) {
      if (std::abs(scale[i]) < 1 / kLargestNumber) refuse(*n, "a factor is 0; expected 1e-18 or more");
    }
    placement = glm::scale(placement, scale);
  }
  return placement;
}

/// The objects of a mesh file, which on its first use is loaded into the scene without its lights and
/// cameras.
const std::vector<Object>& meshFileObjects(const std::string& path, Loaded& loaded, Scene& scene) {
  const auto [it, is_new] = loaded.mesh_files.try_emplace(path);
  if (is_new) {
    const std::size_t first = scene.objects.size();
    const std::size_t light_count = scene.lights.size();
    const std::size_t camera_count = scene.cameras.size();
    loadMeshFile(path, scene);
    it->second.assign(scene.objects.begin() + static_cast<std::ptrdiff_t>(first), scene.objects.end());
    scene.objects.resize(first);
    scene.lights.resize(light_count);
    scene.cameras.resize(camera_count);
  }
  return it->second;
}

void readObject(const JsonNode& node, const std::string& folder, Loaded& loaded, Scene& scene) {
  allowKeys(node, {"mesh", "primitive", "translate", "rotate", "scale", "material", "segments",
                   "minor_radius", "uv_scale"});
  const glm::dmat4 placement = readPlacement(node);
  int material = -1;
  if (const auto n = find(node, "material")) {
    const auto it = loaded.materials.find(readText(*n));
    if (it == loaded.materials.end()) refuse(*n, fmt::format("no material is called {}", n->json->dump()));
    material = it->second;
  }
  std::vector<Object> parts;
  if (const auto n = find(node, "mesh")) {
    refuseKeys(node, {"primitive", "segments", "minor_radius", "uv_scale"}, "beside mesh");
    const std::string path = readPath(*n, folder);
    if (!isMeshFile(path)) refuse(*n, fmt::format("expected a .obj, .gltf or .glb file, got {}", path));
    parts = meshFileObjects(path, loaded, scene);
  } else if (find(node, "primitive")) {
    const Primitive primitive = readPrimitive(node);
    const auto [it, is_new] =
        loaded.primitives.try_emplace(primitive, static_cast<std::uint32_t>(scene.meshes.size()));
    if (is_new) {
      // The object says which material it shows: others may share the mesh.
      scene.meshes.push_back(makePrimitive(primitive, loaded.plain_material));
    }
    parts.push_back({it->second, glm::dmat4(1.0), -1});
  } else {
    refuse(node, "\"mesh\" or \"primitive\" is missing");
  }
  if (scene.objects.size() + parts.size() > kMostObjects) {
    refuse(node, fmt::format("a scene may have {} objects at most", kMostObjects));
  }
  for (const Object& part : parts) {
    scene.objects.push_back(
        {part.mesh, placement * part.object_to_world, material == -1 ? part.material : material});
  }
}

}  // namespace

void readObjects(const JsonNode& top, const std::string& folder, Scene& scene) {
  Loaded loaded;
  Material plain;
  plain.ambient = plain.diffuse;
  loaded.plain_material = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(plain);
  if (const auto materials = find(top, "materials")) {
    needObject(*materials);
    for (const auto& [name, value] : materials->json->items()) {
      loaded.materials[name] = static_cast<int>(scene.materials.size());
      scene.materials.push_back(readMaterial(*find(*materials, name), folder, scene));
    }
  }
  decodeTextures(scene);
  if (const auto objects = find(top, "objects")) {
    needArray(*objects);
    for (std::size_t i = 0; i < objects->json->size(); ++i)
      readObject(element(*objects, i), folder, loaded, scene);
  }
}

}  // namespace luciole
