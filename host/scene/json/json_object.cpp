#include "scene/json/json_object.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "luciole/primitives.hpp"
#include "scene/glowing_patches.hpp"
#include "scene/json/json_keys.hpp"
#include "scene/json/json_source.hpp"
#include "scene/json/mesh_file.hpp"
#include "scene/lights/light_field.hpp"
#include "scene/load_textures.hpp"
#include "scene/models.hpp"
#include "scene/posing.hpp"

namespace luciole {
namespace {

constexpr std::size_t kMostObjects = 10'000'000;

/// What a mesh file holds of one kind, and what of it is attached to the file's nodes.
template <class T>
struct Attached {
  std::vector<T> items;
  std::vector<Attachment> attachments;
};

/// The objects, lights and cameras of a mesh file, as the file places them. Indices of its nodes and of what
/// is attached to them count from 0.
struct LoadedFile {
  Attached<Object> objects;
  Attached<Light> lights;
  Attached<Camera> cameras;
  std::vector<MovingNode> nodes;
};

/// What of a mesh file an object is made of beside its geometry.
struct FileParts {
  bool lights = false, cameras = false;
};

/// What has been loaded so far, by its key, so that nothing is loaded twice.
struct Loaded {
  std::uint32_t plain_material = 0;                             ///< of primitives that name none
  std::map<std::string, int> materials;                         ///< name -> index in Scene::materials
  std::map<std::array<std::string, 3>, LoadedFile> mesh_files;  ///< by path, variant and animation
  std::map<Primitive, std::uint32_t> primitives;                ///< -> index in Scene::meshes
};

/// No texture where the file is missing.
TextureUse readMap(const JsonNode& node, const SearchFolders& where, Scene& scene,
                   TextureKind kind = TextureKind::kColor) {
  TextureUse use;
  const std::string path = pathOf(node, where), fault = faultOfPath(path);
  if (fault.empty())
    use.texture = addTexture(scene, path, kind);
  else
    scene.missing_textures.push_back(messageAt(node, fault));
  return use;
}

Model readModel(const JsonNode& node, const SearchFolders& where, Scene& scene) {
  const std::string name = readText(node);
  if (name.ends_with(kShaderExtension)) {
    const std::string path = pathOf(node, where);
    if (const std::string fault = faultOfPath(path); !fault.empty()) refuse(node, fault);
    return addUserModel(path, scene);
  }
  for (const Model model : kAllModels)
    if (name == modelName(model)) return model;
  refuse(node, fmt::format("no model \"{}\"; expected \"{}\", or a file *{}", name,
                           fmt::join(kModelNames, "\", \""), kShaderExtension));
}

}  // namespace

void readMaterial(const JsonNode& node, const SearchFolders& where, Scene& scene, Material& material) {
  allowKeys(node, {"ambient", "diffuse", "specular", "emission", "shininess", "diffuse_map", "emission_map",
                   "normal_map", "bump_map", "normal_scale", "alpha_map", "alpha", "alpha_cutoff", "blend",
                   "double_sided", "model", "emits"});
  const bool is_alike = material.ambient == material.diffuse;
  if (const auto n = find(node, "diffuse")) material.diffuse = readColor(*n);
  if (is_alike) material.ambient = material.diffuse;
  if (const auto n = find(node, "ambient")) material.ambient = readColor(*n);
  if (const auto n = find(node, "specular")) material.specular = readColor(*n);
  if (const auto n = find(node, "shininess")) {
    material.shininess = static_cast<float>(readNumber(*n, 0, kLargestNumber));
  }
  if (const auto n = find(node, "diffuse_map")) material.diffuse_map = readMap(*n, where, scene);
  if (const auto n = find(node, "emission_map")) {
    material.emission_map = readMap(*n, where, scene);
    material.emission = glm::vec3(1);  // the map's factor: black would hide it
  }
  if (const auto n = find(node, "emission")) material.emission = readColor(*n);
  // Where the picture of the emission is missing, there is no emission.
  if (find(node, "emission_map") && material.emission_map.texture < 0) material.emission = glm::vec3(0);
  if (const auto n = find(node, "normal_map")) {
    refuseKeys(node, {"bump_map"}, "beside normal_map");
    material.normal_map = readMap(*n, where, scene, TextureKind::kNormals);
  }
  if (const auto n = find(node, "bump_map"))
    material.normal_map = readMap(*n, where, scene, TextureKind::kBump);
  if (const auto n = find(node, "normal_scale"))
    material.normal_scale = static_cast<float>(readNumber(*n, -kMostNormalScale, kMostNormalScale));
  if (const auto n = find(node, "alpha_map")) {
    material.alpha_map = readMap(*n, where, scene);
    if (material.alpha_map.texture >= 0) material.alpha_cutoff = 0.5f;
  }
  if (const auto n = find(node, "blend")) material.blended = readBool(*n);
  if (material.blended) material.alpha_cutoff = 0.5f;
  if (const auto n = find(node, "alpha")) material.alpha = static_cast<float>(readNumber(*n, 0, 1));
  if (const auto n = find(node, "alpha_cutoff"))
    material.alpha_cutoff = static_cast<float>(readNumber(*n, 0, 1));
  if (const auto n = find(node, "double_sided")) material.double_sided = readBool(*n);
  if (const auto n = find(node, "emits")) material.emits = readEmits(*n);
  if (const auto n = find(node, "model")) material.model = readModel(*n, where, scene);
  // They are another surface's than the file's facets.
  if (find(node, "specular") || find(node, "shininess")) material.facets.reset();
}

namespace {

std::string readName(const JsonNode& node) {
  const std::string name = readText(node);
  if (name.empty()) refuse(node, "expected a name, got \"\"");
  return name;
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
  // Flat sides need few triangles, except where colours are lit at vertices. A box has a quarter of 64
  // squares a side, since a side goes a quarter of the way around.
  if (is_plane && !find(object, "segments")) primitive.lit_segments = 64;
  if (is_box) primitive.lit_segments = 16;
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

glm::dvec3 readScale(const JsonNode& node) {
  const glm::dvec3 scale = node.json->is_array() ? readVector(node) : glm::dvec3(readNumber(node));
  for (int i = 0; i < 3; ++i) {
    if (std::abs(scale[i]) < 1 / kLargestNumber) refuse(node, "a factor is 0; expected 1e-18 or more");
  }
  return scale;
}

/// An object's transform and, if it has keys, the node that it is attached to.
struct Placement {
  glm::dmat4 still{1.0};
  int node = -1;  ///< in Animation::nodes
};

Placement readPlacement(const JsonNode& node, Animation& animation) {
  glm::dvec3 translate{0.0}, rotate{0.0}, scale{1.0};
  if (const auto n = find(node, "translate")) translate = readVector(*n);
  if (const auto n = find(node, "rotate")) rotate = readVector(*n);
  if (const auto n = find(node, "scale")) scale = readScale(*n);
  Placement result{placement(translate, rotate, scale)};
  if (!hasKeys(node, {"translate", "rotate", "scale"})) return result;
  /// A member's curve, which is constant where no key names it.
  const auto addCurve = [&](const char* member, glm::dvec3 (*read)(const JsonNode&), const glm::dvec3& own) {
    Curve curve = readMotion(node, member, [&](const JsonNode& n) { return glm::dvec4(read(n), 0); });
    if (curve.keys.empty()) curve = constantCurve(glm::dvec4(own, 0));
    animation.curves.push_back(std::move(curve));
    return static_cast<int>(animation.curves.size()) - 1;
  };
  MovingNode moving;
  moving.translate = addCurve("translate", readVector, translate);
  moving.rotate = addCurve("rotate", readVector, rotate);
  moving.scale = addCurve("scale", readScale, scale);
  result.node = static_cast<int>(animation.nodes.size());
  animation.nodes.push_back(moving);
  return result;
}

/// Removes the elements of a list from `first` on, and returns them.
template <class T>
std::vector<T> cutFrom(std::vector<T>& list, std::size_t first) {
  std::vector<T> end(std::make_move_iterator(list.begin() + static_cast<std::ptrdiff_t>(first)),
                     std::make_move_iterator(list.end()));
  list.resize(first);
  return end;
}

/// Removes from the scene what a file has added: things from number `first` on, and their attachments.
template <class T>
Attached<T> cutAttached(std::vector<T>& things, std::size_t first, std::vector<Attachment>& attachments,
                        std::size_t first_attached, std::size_t first_node) {
  Attached<T> cut{cutFrom(things, first), cutFrom(attachments, first_attached)};
  for (Attachment& attachment : cut.attachments) {
    attachment.index -= static_cast<std::uint32_t>(first);
    attachment.node -= static_cast<std::uint32_t>(first_node);
  }
  return cut;
}

/// What a mesh file holds. At its first use it is loaded into the scene, which keeps its meshes and
/// materials.
const LoadedFile& loadedFile(const std::string& path, const GltfChoice& choice,
                             const std::vector<std::string>& search, Loaded& loaded, Scene& scene) {
  const auto [it, is_new] = loaded.mesh_files.try_emplace({path, choice.variant, choice.animation});
  if (!is_new) return it->second;
  Animation& animation = scene.animation;
  const std::size_t first_object = scene.objects.size(), first_node = animation.nodes.size();
  const std::size_t first_light = scene.lights.size(), first_camera = scene.cameras.size();
  const std::size_t objects_attached = animation.objects.size(),
                    lights_attached = animation.attached_lights.size(),
                    cameras_attached = animation.attached_cameras.size();
  const std::size_t deformations = animation.deformations.size();
  loadMeshFile(path, scene, choice, search);
  LoadedFile& file = it->second;
  file.objects = cutAttached(scene.objects, first_object, animation.objects, objects_attached, first_node);
  file.lights =
      cutAttached(scene.lights, first_light, animation.attached_lights, lights_attached, first_node);
  file.cameras =
      cutAttached(scene.cameras, first_camera, animation.attached_cameras, cameras_attached, first_node);
  file.nodes = cutFrom(animation.nodes, first_node);
  // All placements show meshes of one shape, which joints give it where the file itself has them.
  if (animation.deformations.size() > deformations)
    animation.nodes.insert(animation.nodes.end(), file.nodes.begin(), file.nodes.end());
  for (MovingNode& node : file.nodes) node.parent -= node.parent < 0 ? 0 : static_cast<int>(first_node);
  return file;
}

/// The name of a part of an object: the object's, and that of the part where there are several.
std::string nameOf(const std::string& name, const std::string& part, std::size_t parts) {
  if (name.empty()) return part;
  return parts == 1 || part.empty() ? name : fmt::format("{}/{}", name, part);
}

/// A transform that attachLight() takes to the light's own place: it looks along −z.
glm::dmat4 frameOf(const Light& light, const Scene& scene) {
  glm::dmat4 frame(1.0);
  if (light.luminaire >= 0) frame[0] = glm::dvec4(scene.luminaires[std::size_t(light.luminaire)].up, 0);
  if (light.kind != LightKind::kPoint || light.luminaire >= 0) frame[2] = glm::dvec4(-light.direction, 0);
  if (light.kind != LightKind::kDirectional) frame[3] = glm::dvec4(light.position, 1);
  return frame;
}

glm::dmat4 frameOf(const Camera& camera, const Scene&) { return camera.camera_to_world; }

/// Gives a copy of a file's light a luminaire of its own.
void separate(Light& light, Scene& scene) {
  if (light.luminaire < 0) return;
  const Luminaire copy = scene.luminaires[std::size_t(light.luminaire)];
  light.luminaire = static_cast<std::int32_t>(scene.luminaires.size());
  scene.luminaires.push_back(copy);
}
void separate(Camera&, Scene&) {}

std::string place(const glm::dmat4& to_world, Scene& scene, Light& light) {
  return attachLight(to_world, scene.luminaires, light);
}
std::string place(const glm::dmat4& to_world, Scene&, Camera& camera) {
  return attachCamera(to_world, camera);
}

/// Appends a file's attachments: of things that are numbered from `first` on, to nodes from first_node on.
/// Returns which of the file's things are attached.
std::vector<bool> attachAgain(const std::vector<Attachment>& of_file, std::size_t things, std::size_t first,
                              std::size_t first_node, std::vector<Attachment>& attachments) {
  std::vector<bool> attached(things, false);
  for (Attachment attachment : of_file) {
    attached[attachment.index] = true;
    attachment.index += static_cast<std::uint32_t>(first);
    attachment.node += static_cast<std::uint32_t>(first_node);
    attachments.push_back(attachment);
  }
  return attached;
}

/// Places a file's lights or cameras, which take of a transform its motion and turn alone. things: of the
/// scene. `object`: for errors.
template <class T>
void placeThings(const JsonNode& object, const Attached<T>& of_file, const Placement& placement,
                 std::size_t first_node, Scene& scene, std::vector<T>& things,
                 std::vector<Attachment>& attachments) {
  const std::size_t first = things.size();
  const std::vector<bool> attached =
      attachAgain(of_file.attachments, of_file.items.size(), first, first_node, attachments);
  for (std::size_t i = 0; i < of_file.items.size(); ++i) {
    const glm::dmat4 frame = frameOf(of_file.items[i], scene);
    things.push_back(of_file.items[i]);
    separate(things.back(), scene);
    if (attached[i]) continue;
    const std::string fault = place(placement.still * frame, scene, things.back());
    if (!fault.empty()) refuse(object, fault);
    if (placement.node >= 0)
      attachments.push_back(
          {static_cast<std::uint32_t>(first + i), static_cast<std::uint32_t>(placement.node), frame});
  }
}

/// Places what a file holds. What moves in the file moves relative to that place.
void placeFile(const JsonNode& object, const LoadedFile& file, const FileParts& parts,
               const Placement& placement, int material, const std::string& name, Scene& scene) {
  Animation& animation = scene.animation;
  const std::size_t first = scene.objects.size(), first_node = animation.nodes.size();
  for (MovingNode node : file.nodes) {
    if (node.parent < 0 && placement.node < 0) node.before = placement.still * node.before;
    node.parent = node.parent < 0 ? placement.node : static_cast<int>(first_node) + node.parent;
    animation.nodes.push_back(node);
  }
  const std::vector<Object>& objects = file.objects.items;
  const std::vector<bool> attached =
      attachAgain(file.objects.attachments, objects.size(), first, first_node, animation.objects);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Object& part = objects[i];
    scene.objects.push_back({part.mesh, placement.still * part.object_to_world,
                             material == -1 ? part.material : material,
                             nameOf(name, part.name, objects.size())});
    if (placement.node >= 0 && !attached[i])
      attach(scene, {static_cast<std::uint32_t>(first + i), static_cast<std::uint32_t>(placement.node),
                     part.object_to_world, part.mesh});
  }
  if (parts.lights)
    placeThings(object, file.lights, placement, first_node, scene, scene.lights, animation.attached_lights);
  if (!parts.cameras) return;
  const std::size_t first_camera = scene.cameras.size();
  placeThings(object, file.cameras, placement, first_node, scene, scene.cameras, animation.attached_cameras);
  for (std::size_t i = first_camera; i < scene.cameras.size(); ++i)
    scene.cameras[i].name = nameOf(name, scene.cameras[i].name, file.cameras.items.size());
}

/// Whether an object takes what `key` names of its mesh file, which only glTF files have.
bool takes(const JsonNode& object, const char* key, const std::string& path) {
  const auto n = find(object, key);
  if (n && extensionOf(path) == ".obj")
    refuse(*n, fmt::format("an .obj file has no {}, only glTF files have", key));
  return n && readBool(*n);
}

/// Lets those of the scene's objects from number `first` on emit that glow: together as much as the node
/// says.
void letGlow(const JsonNode& node, std::size_t first, Scene& scene) {
  const std::uint32_t count = readEmits(node);
  std::vector<Object*> glowing;
  for (std::size_t i = first; i < scene.objects.size(); ++i)
    if (glows(scene, scene.objects[i])) glowing.push_back(&scene.objects[i]);
  if (glowing.empty() && count > 0) refuse(node, "nothing of the object has an emission");
  for (Object* object : glowing)
    object->emits = std::max(count / std::uint32_t(glowing.size()), std::min(count, 1u));
}

void readObject(const JsonNode& node, const SearchFolders& where, Loaded& loaded, Scene& scene) {
  allowKeys(node, {"mesh", "variant", "animation", "primitive", "translate", "rotate", "scale", "material",
                   "segments", "minor_radius", "uv_scale", "keys", "interpolation", "name", "lights",
                   "cameras", "emits"});
  const Placement placement = readPlacement(node, scene.animation);
  int material = -1;
  if (const auto n = find(node, "material")) {
    const auto it = loaded.materials.find(readText(*n));
    if (it == loaded.materials.end()) refuse(*n, fmt::format("no material is called {}", n->json->dump()));
    material = it->second;
  }
  LoadedFile single;
  const LoadedFile* file = &single;
  FileParts parts;
  if (const auto n = find(node, "mesh")) {
    refuseKeys(node, {"primitive", "segments", "minor_radius", "uv_scale"}, "beside mesh");
    const std::string path = readPath(*n, where);
    if (!isMeshFile(path)) refuse(*n, fmt::format("expected a .obj, .gltf or .glb file, got {}", path));
    GltfChoice choice;
    if (const auto variant = find(node, "variant")) choice.variant = readName(*variant);
    if (const auto animation = find(node, "animation")) choice.animation = readName(*animation);
    parts = {takes(node, "lights", path), takes(node, "cameras", path)};
    file = &loadedFile(path, choice, where.others, loaded, scene);
  } else if (find(node, "primitive")) {
    refuseKeys(node, {"variant", "animation", "lights", "cameras"}, "beside primitive");
    const Primitive primitive = readPrimitive(node);
    const auto [it, is_new] =
        loaded.primitives.try_emplace(primitive, static_cast<std::uint32_t>(scene.meshes.size()));
    if (is_new) {
      // The material is the object's, since other objects may share the mesh.
      scene.meshes.push_back(makePrimitive(primitive, loaded.plain_material));
    }
    single.objects.items.push_back({it->second, glm::dmat4(1.0), -1});
  } else {
    refuse(node, "\"mesh\" or \"primitive\" is missing");
  }
  if (scene.objects.size() + file->objects.items.size() > kMostObjects) {
    refuse(node, fmt::format("a scene may have {} objects at most", kMostObjects));
  }
  if (scene.animation.nodes.size() + file->nodes.size() > kMostObjects) {
    refuse(node, fmt::format("a scene may have {} moving nodes at most", kMostObjects));
  }
  if (parts.lights && scene.lights.size() + file->lights.items.size() > kMostLights)
    refuse(node, fmt::format("a scene may have {} lights at most", kMostLights));
  if (parts.cameras && scene.cameras.size() + file->cameras.items.size() > kMostObjects)
    refuse(node, fmt::format("a scene may have {} cameras at most", kMostObjects));
  std::string name;
  if (const auto n = find(node, "name")) name = readText(*n);
  const std::size_t first = scene.objects.size();
  placeFile(node, *file, parts, placement, material, name, scene);
  if (const auto n = find(node, "emits")) letGlow(*n, first, scene);
}

}  // namespace

void readObjects(const JsonNode& top, const SearchFolders& where, Scene& scene) {
  Loaded loaded;
  Material plain;
  plain.ambient = plain.diffuse;
  loaded.plain_material = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(plain);
  if (const auto materials = find(top, "materials")) {
    needObject(*materials);
    for (const auto& [name, value] : materials->json->items()) {
      loaded.materials[name] = static_cast<int>(scene.materials.size());
      Material material = plain;
      material.name = name;
      readMaterial(*find(*materials, name), where, scene, material);
      scene.materials.push_back(std::move(material));
    }
  }
  decodeTextures(scene);
  if (const auto objects = find(top, "objects")) {
    needArray(*objects);
    for (std::size_t i = 0; i < objects->json->size(); ++i)
      readObject(element(*objects, i), where, loaded, scene);
  }
}

}  // namespace luciole
