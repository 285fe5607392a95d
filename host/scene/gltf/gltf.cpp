#include "scene/gltf/gltf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "scene/gltf/gltf_accessor.hpp"
#include "scene/gltf/gltf_animation.hpp"
#include "scene/gltf/gltf_material.hpp"
#include "scene/gltf/gltf_mesh.hpp"
#include "scene/gltf/gltf_model.hpp"
#include "scene/light_groups.hpp"
#include "scene/pose.hpp"

namespace luciole {
namespace {

constexpr const char* kLights = "KHR_lights_punctual";
constexpr double kPi = 3.14159265358979323846;

struct PlacedNode {
  int node;
  glm::dmat4 to_world;    ///< without animation
  int moving = -1;        ///< the node of Animation::nodes that it is attached to; -1: none
  glm::dmat4 since{1.0};  ///< from the node's space to that of `moving`, or to world space
};

std::string nodePlace(int node) { return fmt::format("nodes[{}]", node); }

/// A node's own transform: given as a matrix, or as its three parts.
struct LocalTransform {
  bool is_matrix = false;
  glm::dmat4 matrix{1.0};
  glm::dvec3 translate{0.0}, scale{1.0};
  glm::dvec4 rotation{0.0, 0.0, 0.0, 1.0};
};

LocalTransform localTransform(const GltfModel& model, int index) {
  const tinygltf::Node& node = model.file.nodes[index];
  const auto has = [&](const std::vector<double>& values, std::size_t count, const char* name) {
    if (values.empty() || values.size() == count) return !values.empty();
    failGltf(model, nodePlace(index),
             fmt::format("{} has {} numbers, expected {}", name, values.size(), count));
  };
  LocalTransform local;
  if (has(node.matrix, 16, "matrix")) {
    local.is_matrix = true;
    for (int i = 0; i < 16; ++i) local.matrix[i / 4][i % 4] = node.matrix[i];
    const glm::dvec4 last_row(local.matrix[0].w, local.matrix[1].w, local.matrix[2].w, local.matrix[3].w);
    if (last_row != glm::dvec4(0, 0, 0, 1))
      failGltf(model, nodePlace(index), "matrix must have 0 0 0 1 as last row");
    return local;
  }
  for (int i = 0; has(node.translation, 3, "translation") && i < 3; ++i)
    local.translate[i] = node.translation[i];
  for (int i = 0; has(node.rotation, 4, "rotation") && i < 4; ++i) local.rotation[i] = node.rotation[i];
  for (int i = 0; has(node.scale, 3, "scale") && i < 3; ++i) local.scale[i] = node.scale[i];
  if (!(glm::length(local.rotation) > 0))
    failGltf(model, nodePlace(index), "rotation must be a unit quaternion");
  local.matrix = placementByQuaternion(local.translate, local.rotation, local.scale);
  return local;
}

/// The MovingNode of an animated node. Parts that no curve moves keep the node's own value.
MovingNode movingNode(const LocalTransform& local, const NodeCurves& curves, Animation& animation) {
  const auto orConstant = [&](int curve, const glm::dvec4& value) {
    if (curve >= 0) return curve;
    animation.curves.push_back(constantCurve(value));
    return static_cast<int>(animation.curves.size()) - 1;
  };
  MovingNode moving;
  moving.quaternion = true;
  moving.translate = orConstant(curves.translation, glm::dvec4(local.translate, 0));
  moving.rotate = orConstant(curves.rotation, local.rotation);
  moving.scale = orConstant(curves.scale, glm::dvec4(local.scale, 0));
  return moving;
}

/// The nodes at the top of the scene to show: the default one, else the first, else every node without a
/// parent.
std::vector<int> rootNodes(const GltfModel& model) {
  const tinygltf::Model& file = model.file;
  if (!file.scenes.empty()) {
    return element(model, file.scenes, std::max(file.defaultScene, 0), "scene", "scene").nodes;
  }
  std::vector<bool> is_child(file.nodes.size(), false);
  for (const tinygltf::Node& node : file.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<std::size_t>(child) < is_child.size()) is_child[child] = true;
    }
  }
  std::vector<int> roots;
  for (std::size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

/// Whether a node hides itself and all below it (KHR_node_visibility).
bool isHidden(const tinygltf::Node& node) {
  const auto found = node.extensions.find("KHR_node_visibility");
  if (found == node.extensions.end()) return false;
  const tinygltf::Value& visible = memberOf(found->second, "visible");
  return visible.IsBool() && !visible.Get<bool>();
}

/// Every node of the scene that isn't hidden with its transform, parents first. Animated nodes are added to
/// the animation. Throws InputError unless the nodes form trees (roots without a parent, other nodes with at
/// most one), so that the walk down from the roots ends.
std::vector<PlacedNode> placedNodes(const GltfModel& model, Animation& animation) {
  const std::map<int, NodeCurves> curves = readGltfAnimations(model, animation);
  const std::vector<tinygltf::Node>& nodes = model.file.nodes;
  const std::vector<int> roots = rootNodes(model);
  std::vector<int> parents(nodes.size(), 0);
  const auto addParent = [&](int child, const std::string& place) {
    element(model, nodes, child, place, "node");
    if (++parents[child] > 1)
      failGltf(model, nodePlace(child), "has two parents or contains itself, expected a tree");
  };
  for (const int root : roots) addParent(root, "scene");
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const int child : nodes[i].children) addParent(child, nodePlace(static_cast<int>(i)));
  }

  std::vector<PlacedNode> placed, stack;
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) stack.push_back({*root, glm::dmat4(1.0)});
  while (!stack.empty()) {
    PlacedNode next = stack.back();
    stack.pop_back();
    if (isHidden(nodes[next.node])) continue;
    const LocalTransform local = localTransform(model, next.node);
    next.to_world = next.to_world * local.matrix;
    if (!isFinite(next.to_world)) failGltf(model, nodePlace(next.node), "transform is not finite");
    if (const auto animated = curves.find(next.node); animated != curves.end()) {
      if (local.is_matrix) failGltf(model, nodePlace(next.node), "is animated, so it must have no matrix");
      MovingNode moving = movingNode(local, animated->second, animation);
      moving.parent = next.moving;
      moving.before = next.since;
      next.moving = static_cast<int>(animation.nodes.size());
      next.since = glm::dmat4(1.0);
      animation.nodes.push_back(moving);
    } else {
      next.since = next.since * local.matrix;
    }
    placed.push_back(next);
    const std::vector<int>& children = nodes[next.node].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      stack.push_back({*child, next.to_world, next.moving, next.since});
  }
  return placed;
}

/// The transforms of a node's instances (EXT_mesh_gpu_instancing) to the node's space; one of nothing where
/// it has none.
std::vector<glm::dmat4> instancesOf(const GltfModel& model, int index) {
  constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
  const tinygltf::Node& node = model.file.nodes[index];
  const auto found = node.extensions.find(kInstancing);
  if (found == node.extensions.end()) return {glm::dmat4(1.0)};
  const tinygltf::Value& attributes = memberOf(found->second, "attributes");
  const std::string place = fmt::format("{}.{}", nodePlace(index), kInstancing);
  std::size_t count = 0;
  const auto read = [&](const char* name, int components) {
    std::vector<float> values;
    if (!attributes.IsObject() || !attributes.Has(name)) return values;
    const tinygltf::Value& accessor = attributes.Get(name);
    const double number = accessor.IsNumber() ? accessor.GetNumberAsDouble() : -1;
    values = readFloats(model, number >= 0 && number < 1e9 ? static_cast<int>(number) : -1, components,
                        fmt::format("{}.{}", place, name));
    const std::size_t instances = values.size() / static_cast<std::size_t>(components);
    if (count != 0 && count != instances)
      failGltf(model, place, fmt::format("its attributes have {} and {} elements", count, instances));
    count = instances;
    return values;
  };
  const std::vector<float> translations = read("TRANSLATION", 3), rotations = read("ROTATION", 4),
                           scales = read("SCALE", 3);
  if (count == 0) failGltf(model, place, "has none of TRANSLATION, ROTATION, SCALE");
  std::vector<glm::dmat4> instances;
  for (std::size_t i = 0; i < count; ++i) {
    glm::dvec3 translate(0), scale(1);
    glm::dvec4 rotation(0, 0, 0, 1);
    for (int c = 0; c < 3 && !translations.empty(); ++c) translate[c] = translations[3 * i + std::size_t(c)];
    for (int c = 0; c < 4 && !rotations.empty(); ++c) rotation[c] = rotations[4 * i + std::size_t(c)];
    for (int c = 0; c < 3 && !scales.empty(); ++c) scale[c] = scales[3 * i + std::size_t(c)];
    instances.push_back(placementByQuaternion(translate, rotation, scale));
    if (!(glm::length(rotation) > 0) || !isFinite(instances.back()))
      failGltf(model, place, fmt::format("instance {} has no finite transform", i));
  }
  return instances;
}

/// Adds the mesh of each node as an object; a mesh of several nodes becomes one mesh and several objects.
void addObjects(const GltfModel& model, const std::vector<PlacedNode>& nodes, Scene& scene) {
  const std::uint32_t first_material = static_cast<std::uint32_t>(scene.materials.size());
  std::vector<int> materials;
  std::map<int, int> meshes;  // glTF's index -> ours, -1: nothing to draw
  for (const PlacedNode& placed : nodes) {
    const int index = model.file.nodes[placed.node].mesh;
    if (index < 0) continue;
    element(model, model.file.meshes, index, nodePlace(placed.node), "mesh");
    if (!meshes.count(index)) {
      Mesh mesh = readGltfMesh(model, index, materials, first_material);
      meshes[index] = mesh.triangles.empty() ? -1 : static_cast<int>(scene.meshes.size());
      if (!mesh.triangles.empty()) scene.meshes.push_back(std::move(mesh));
    }
    if (meshes[index] < 0) continue;
    const std::uint32_t mesh = static_cast<std::uint32_t>(meshes[index]);
    for (const glm::dmat4& instance : instancesOf(model, placed.node)) {
      const glm::dmat4 to_world = placed.to_world * instance;
      if (!isFinite(to_world)) failGltf(model, nodePlace(placed.node), "transform is not finite");
      // A scale of 0 hides an object. What moves may have it for a while, and is kept.
      if (placed.moving < 0 && isFlat(to_world)) continue;
      scene.objects.push_back({mesh, to_world, -1, model.file.nodes[placed.node].name});
      if (placed.moving < 0) continue;
      attach(scene, {static_cast<std::uint32_t>(scene.objects.size()) - 1,
                     static_cast<std::uint32_t>(placed.moving), placed.since * instance, mesh});
    }
  }
  addGltfMaterials(model, materials, scene);
}

void addCamera(const GltfModel& model, const PlacedNode& placed, Scene& scene) {
  const tinygltf::Node& node = model.file.nodes[placed.node];
  const tinygltf::Camera& source =
      element(model, model.file.cameras, node.camera, nodePlace(placed.node), "camera");
  const std::string place = fmt::format("cameras[{}]", node.camera);
  Camera camera;
  camera.name = source.name.empty() ? node.name : source.name;
  const std::string fault = attachCamera(placed.to_world, camera);
  if (!fault.empty()) failGltf(model, nodePlace(placed.node), fault);
  camera.orthographic = source.type == "orthographic";
  if (camera.orthographic) {
    camera.half_height = std::abs(source.orthographic.ymag);
    camera.far = source.orthographic.zfar;
    // glTF allows 0 here; Camera::near must be above 0.
    camera.near = source.orthographic.znear == 0 ? 1e-6 * camera.far : source.orthographic.znear;
    if (!(camera.half_height > 0)) failGltf(model, place, "ymag is 0");
  } else {
    camera.fov_y = source.perspective.yfov;
    camera.near = source.perspective.znear;
    // Without zfar glTF's projection is infinite.
    camera.far = source.perspective.zfar == 0 ? 1e6 * camera.near : source.perspective.zfar;
    if (!(camera.fov_y > 0 && camera.fov_y < kPi)) failGltf(model, place, "yfov must be between 0 and pi");
  }
  if (!(camera.near > 0 && camera.far > camera.near)) failGltf(model, place, "expected 0 < znear < zfar");
  if (placed.moving >= 0)
    scene.animation.attached_cameras.push_back({static_cast<std::uint32_t>(scene.cameras.size()),
                                                static_cast<std::uint32_t>(placed.moving), placed.since});
  scene.cameras.push_back(camera);
}

/// The group that a light's node, or else the light, names: a text "group" in its extras. Extras are
/// anybody's, so one that can't be a group's name is told and left out.
std::uint32_t groupOf(const GltfModel& model, int node, const tinygltf::Light& light,
                      LightGroupNumbers& groups, Scene& scene) {
  for (const tinygltf::Value* extras : {&model.file.nodes[node].extras, &light.extras}) {
    if (!extras->IsObject() || !extras->Get("group").IsString()) continue;
    const std::string name = extras->Get("group").Get<std::string>();
    const std::string fault = faultOfGroupName(name);
    if (fault.empty()) return lightGroupNumber(name, groups, scene);
    scene.warnings.push_back(
        fmt::format("{}: {}: extras.group: {}; left out", model.path, nodePlace(node), fault));
  }
  return 0;
}

/// KHR_lights_punctual. Its intensities are candela and lux, and its Lambertian surface reflects base colour
/// / π; our diffuse term has no 1/π, so the light carries it: diffuse = specular = colour · intensity / π. A
/// surface then has the radiance in cd/m² that glTF gives it. Lights cast no shadow, as glTF says nothing of
/// shadows.
void addLight(const GltfModel& model, const PlacedNode& placed, double index, LightGroupNumbers& groups,
              Scene& scene) {
  const int number = index >= 0 && index < 1e9 ? static_cast<int>(index) : -1;
  const tinygltf::Light& source = element(model, model.file.lights, number, nodePlace(placed.node), "light");
  const std::string place = fmt::format("extensions.{}.lights[{}]", kLights, number);
  Light light;
  glm::vec3 color(1);
  for (std::size_t i = 0; i < std::min<std::size_t>(source.color.size(), 3); ++i) {
    color[static_cast<int>(i)] = static_cast<float>(source.color[i]);
  }
  light.diffuse = light.specular = color * static_cast<float>(source.intensity / kPi);
  for (int i = 0; i < 3; ++i) {
    if (!(light.diffuse[i] >= 0 && std::isfinite(light.diffuse[i]))) {
      failGltf(model, place, "color and intensity must be at least 0 and finite");
    }
  }
  if (source.type == "directional") {
    light.kind = LightKind::kDirectional;
  } else {
    light.attenuation = {0, 0, 1};
    light.window = RangeWindow::kKhr;
    if (source.range != 0) light.range = static_cast<float>(source.range);
    if (!(light.range > 0)) failGltf(model, place, "range must be above 0");
  }
  if (source.type == "spot") {
    light.kind = LightKind::kSpot;
    light.falloff = SpotFalloff::kCone;
    light.cutoff = source.spot.outerConeAngle;
    // Programs write inner = outer for a sharp edge; Light::inner_cone must be below the cutoff.
    light.inner_cone = std::min(source.spot.innerConeAngle, light.cutoff * (1 - 1e-6));
    // π/2 as a decimal may have been rounded up.
    if (light.cutoff > kPi / 2 && light.cutoff < kPi / 2 + 1e-5) light.cutoff = kPi / 2;
    if (!(light.cutoff > 0 && light.cutoff <= kPi / 2 && source.spot.innerConeAngle >= 0 &&
          source.spot.innerConeAngle <= source.spot.outerConeAngle)) {
      failGltf(model, place, "expected 0 <= innerConeAngle < outerConeAngle <= pi/2");
    }
  } else if (source.type != "point" && source.type != "directional") {
    failGltf(model, place, "type must be point, directional or spot");
  }
  const std::string fault = attachLight(placed.to_world, light);
  if (!fault.empty()) failGltf(model, nodePlace(placed.node), fault);
  light.group = groupOf(model, placed.node, source, groups, scene);
  if (placed.moving >= 0)
    scene.animation.attached_lights.push_back({static_cast<std::uint32_t>(scene.lights.size()),
                                               static_cast<std::uint32_t>(placed.moving), placed.since});
  scene.lights.push_back(light);
}

}  // namespace

void loadGltf(const std::string& path, Scene& scene, const std::string& variant) {
  GltfModel model = readGltfModel(path);
  scene.variants = variantNames(model);
  if (!variant.empty()) {
    const auto found = std::find(scene.variants.begin(), scene.variants.end(), variant);
    if (found == scene.variants.end())
      throw InputError(fmt::format(
          "{}: has no variant '{}'; it has {}", path, forMessage(variant),
          scene.variants.empty() ? "none" : forMessage(fmt::format("{}", fmt::join(scene.variants, ", ")))));
    model.variant = static_cast<int>(found - scene.variants.begin());
  }
  for (const std::string& extension : ignoredExtensions(model)) {
    scene.warnings.push_back(
        fmt::format("{}: extensionsUsed: '{}' is not supported and left out", path, forMessage(extension)));
    std::vector<std::string>& all = scene.ignored_extensions;
    if (std::find(all.begin(), all.end(), extension) == all.end()) all.push_back(extension);
  }
  const std::vector<PlacedNode> nodes = placedNodes(model, scene.animation);
  const std::size_t before = scene.objects.size() + scene.cameras.size() + scene.lights.size();
  addObjects(model, nodes, scene);
  LightGroupNumbers groups = lightGroupNumbers(scene);
  for (const PlacedNode& placed : nodes) {
    const tinygltf::Node& node = model.file.nodes[placed.node];
    if (node.camera >= 0) addCamera(model, placed, scene);
    if (node.extensions.count(kLights)) {
      addLight(model, placed, extensionNumber(node.extensions, kLights, "light", -1), groups, scene);
    }
  }
  if (scene.objects.size() + scene.cameras.size() + scene.lights.size() == before) {
    failGltf(model, "scene", "shows nothing, expected a mesh, a light or a camera");
  }
}

}  // namespace luciole
