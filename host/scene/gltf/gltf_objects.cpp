#include "scene/gltf/gltf_objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "base/machine_memory.hpp"
#include "scene/deform.hpp"
#include "scene/gltf/gltf_accessor.hpp"
#include "scene/gltf/gltf_material.hpp"
#include "scene/gltf/gltf_mesh.hpp"
#include "scene/gltf/gltf_rest.hpp"
#include "scene/posing.hpp"

namespace luciole {
namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

/// The transforms of a node's instances (EXT_mesh_gpu_instancing) to the node's space; one of nothing where
/// it has none.
std::vector<glm::dmat4> instancesOf(const GltfModel& model, int index) {
  const GltfJson& extension = memberOf(model.file.nodes[std::size_t(index)].extensions, kInstancing);
  if (extension.is_null()) return {glm::dmat4(1.0)};
  const GltfJson& attributes = memberOf(extension, "attributes");
  const std::string place = fmt::format("{}.{}", nodePlace(index), kInstancing);
  std::size_t count = 0;
  const auto read = [&](const char* name, int components) {
    std::vector<float> values;
    const GltfJson& accessor = memberOf(attributes, name);
    if (accessor.is_null()) return values;
    values = readFloats(model, indexOf(accessor), components, fmt::format("{}.{}", place, name));
    const std::size_t instances = values.size() / static_cast<std::size_t>(components);
    if (count != 0 && count != instances)
      failGltf(model, place, fmt::format("its attributes have {} and {} elements", count, instances));
    count = instances;
    return values;
  };
  const std::vector<float> translations = read("TRANSLATION", 3), rotations = read("ROTATION", 4),
                           scales = read("SCALE", 3);
  if (count == 0) {
    warnRepaired(model, place, "has none of TRANSLATION, ROTATION, SCALE; drawn once", "no instances");
    return {glm::dmat4(1.0)};
  }
  std::vector<glm::dmat4> instances;
  bool is_unit = true;
  for (std::size_t i = 0; i < count; ++i) {
    glm::dvec3 translate(0), scale(1);
    glm::dvec4 rotation(0, 0, 0, 1);
    for (int c = 0; c < 3 && !translations.empty(); ++c) translate[c] = translations[3 * i + std::size_t(c)];
    for (int c = 0; c < 4 && !rotations.empty(); ++c) rotation[c] = rotations[4 * i + std::size_t(c)];
    for (int c = 0; c < 3 && !scales.empty(); ++c) scale[c] = scales[3 * i + std::size_t(c)];
    if (const double length = glm::length(rotation); !isUnitLength(length)) {
      if (is_unit)
        warnRepaired(
            model, place,
            fmt::format("instance {}: rotation is of length {}, expected unit quaternions", i, length),
            "rotation");
      is_unit = false;
      if (!(length > 0)) rotation = {0, 0, 0, 1};
    }
    instances.push_back(placementByQuaternion(translate, rotation, scale));
    if (!isFinite(instances.back()))
      failGltf(model, place, fmt::format("instance {} has no finite transform", i));
  }
  return instances;
}

/// A mesh that deforms, as it is at rest, for all nodes that show it.
struct RestMesh {
  Mesh mesh;
  std::shared_ptr<const RestShape> rest;
};

/// What objects are made from.
struct Source {
  const GltfModel& model;
  const std::vector<PlacedNode>& nodes;
  const std::map<int, NodeCurves>& curves;
  std::uint32_t first_material;
  std::vector<int> materials{};           ///< glTF's, in the order of the scene's
  std::map<int, int> meshes{};            ///< glTF's index -> Scene::meshes; -1: nothing to draw
  std::map<int, RestMesh> rest_meshes{};  ///< by glTF's index
  std::vector<std::size_t> places{};      ///< of each node of the file that is placed: in `nodes`
};

/// A transform to near the deformed mesh, so that its vertices are small numbers: by whole metres, and
/// mirrored where most joints mirror, so that the fronts of most triangles are counter-clockwise in the mesh.
/// pose: where the mesh's space is the world.
glm::dmat4 frameOf(const RestShape& rest, std::span<const double> pose, std::size_t joints) {
  std::size_t mirrored = 0;
  for (std::size_t i = 0; i < joints; ++i) mirrored += glm::determinant(glm::dmat3(jointMatrix(pose, i))) < 0;
  glm::dmat4 frame(1.0);
  if (2 * mirrored > joints) frame[0][0] = -1;
  const glm::dvec4 first = meanOfJoints(rest, 0, pose) * glm::dvec4(rest.positions[0], 1);
  frame[3] = glm::dvec4(glm::round(glm::dvec3(first)), 1);
  return frame;
}

/// The skin of a node; -1 where it has none, or no primitive of its mesh follows joints.
int skinOf(const GltfModel& model, int node) {
  const GltfNode& source = model.file.nodes[std::size_t(node)];
  const auto followsJoints = [](const GltfPrimitive& primitive) {
    return primitive.attributes.count("JOINTS_0") + primitive.attributes.count("WEIGHTS_0") > 0;
  };
  const std::vector<GltfPrimitive>& primitives = model.file.meshes[std::size_t(source.mesh)].primitives;
  return std::ranges::any_of(primitives, followsJoints) ? source.skin : -1;
}

/// The joints of a node's skin. still: where they are without animation.
std::vector<Joint> jointsOf(const Source& source, const PlacedNode& placed, bool still) {
  const int index = skinOf(source.model, placed.node);
  if (index < 0) return {};
  const GltfSkin skin = readGltfSkin(source.model, index, nodePlace(placed.node));
  std::vector<Joint> joints;
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    const PlacedNode& node = source.nodes[source.places[std::size_t(skin.joints[i])]];
    joints.push_back(still ? Joint{-1, node.to_world * skin.inverse_binds[i]}
                           : Joint{node.moving, node.since * skin.inverse_binds[i]});
  }
  return joints;
}

/// The mesh of a node that deforms it, as it is at rest. Read at its first use.
const RestMesh& restMesh(Source& source, const PlacedNode& placed) {
  const int index = source.model.file.nodes[std::size_t(placed.node)].mesh;
  const auto [known, is_new] = source.rest_meshes.try_emplace(index);
  if (is_new) {
    auto rest = std::make_shared<RestShape>();
    known->second.mesh =
        readGltfMesh(source.model, index, source.materials, source.first_material, rest.get());
    known->second.rest = std::move(rest);
  }
  return known->second;
}

/// At most what a mesh takes.
double bytesOf(const Mesh& mesh) {
  constexpr std::size_t kVertex =
      2 * sizeof(glm::vec3) + 4 * sizeof(glm::vec2) + 2 * sizeof(glm::vec4) + sizeof(std::uint32_t);
  return double(mesh.positions.size() * kVertex) +
         double(mesh.triangles.size() * (sizeof(glm::uvec3) + sizeof(std::uint32_t)));
}

/// Adds a mesh of its own for a node that deforms it. Returns its index, or -1 where it has no triangle, and
/// sets `frame`, of a skinned one its place in the world.
int addDeforming(Source& source, const PlacedNode& placed, Scene& scene, glm::dmat4& frame) {
  const RestMesh& known = restMesh(source, placed);
  if (known.mesh.triangles.empty()) return -1;
  const std::string place = nodePlace(placed.node);
  Deformation still;
  still.mesh = static_cast<std::uint32_t>(scene.meshes.size());
  still.rest = known.rest;
  still.tangents = known.mesh.tangents;
  still.weights = targetWeights(source.model, placed.node);
  still.joints = jointsOf(source, placed, true);
  if (!still.joints.empty()) {
    checkInfluences(source.model, *still.rest, still.joints.size(), place);
    frame = frameOf(*still.rest, poseNumbers(still, {}, {}), still.joints.size());
    still.world_to_mesh = glm::inverse(frame);
    if (!isFinite(still.world_to_mesh)) failGltf(source.model, place, "its skin's transform is not finite");
  }
  requireMemory(bytesOf(known.mesh),
                fmt::format("{}: {}: its own copy of a mesh that deforms", source.model.path, place));
  scene.meshes.push_back(known.mesh);
  Mesh& mesh = scene.meshes.back();
  Deformation moving = still;
  moving.joints = jointsOf(source, placed, false);
  if (const auto found = source.curves.find(placed.node); found != source.curves.end())
    moving.weight_curves = found->second.weights;
  const bool moves = !moving.weight_curves.empty() ||
                     std::ranges::any_of(moving.joints, [](const Joint& joint) { return joint.node >= 0; });
  if (moves) {
    scene.animation.deformations.push_back(std::move(moving));
  } else {
    const std::string fault = deform(still, poseNumbers(still, {}, still.weights), mesh);
    if (!fault.empty()) failGltf(source.model, place, fault);
    mesh.sources.clear();
  }
  return static_cast<int>(still.mesh);
}

/// Whether a node shows its mesh in another shape than that at rest.
bool isDeformed(const Source& source, int node) {
  if (skinOf(source.model, node) >= 0) return true;
  const auto curves = source.curves.find(node);
  if (curves != source.curves.end() && !curves->second.weights.empty()) return true;
  return std::ranges::any_of(targetWeights(source.model, node), [](double weight) { return weight != 0; });
}

/// Adds the mesh of a node, unless that is known. Returns its index, or -1 where it has no triangle.
int addRigid(Source& source, int mesh, Scene& scene) {
  const auto [known, is_new] = source.meshes.try_emplace(mesh, -1);
  if (!is_new) return known->second;
  Mesh read = readGltfMesh(source.model, mesh, source.materials, source.first_material);
  if (read.triangles.empty()) return -1;
  known->second = static_cast<int>(scene.meshes.size());
  scene.meshes.push_back(std::move(read));
  return known->second;
}

/// Places a mesh with the node that it belongs to, once for each of its instances.
void placeWithNode(const Source& source, const PlacedNode& placed, std::uint32_t mesh, Scene& scene) {
  for (const glm::dmat4& instance : instancesOf(source.model, placed.node)) {
    const glm::dmat4 to_world = placed.to_world * instance;
    if (!isFinite(to_world)) failGltf(source.model, nodePlace(placed.node), "transform is not finite");
    // A scale of 0 along two axes hides an object. What moves may have it for a while, and is kept.
    if (placed.moving < 0 && hidesObjects(to_world)) continue;
    scene.objects.push_back({mesh, to_world, -1, source.model.file.nodes[std::size_t(placed.node)].name});
    if (placed.moving < 0) continue;
    attach(scene, {static_cast<std::uint32_t>(scene.objects.size()) - 1,
                   static_cast<std::uint32_t>(placed.moving), placed.since * instance, mesh});
  }
}

}  // namespace

void addGltfObjects(const GltfModel& model, const std::vector<PlacedNode>& nodes,
                    const std::map<int, NodeCurves>& curves, Scene& scene) {
  checkWeights(model);
  Source source{model, nodes, curves, static_cast<std::uint32_t>(scene.materials.size())};
  source.places.resize(model.file.nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) source.places[std::size_t(nodes[i].node)] = i;
  for (const PlacedNode& placed : nodes) {
    const GltfNode& node = model.file.nodes[std::size_t(placed.node)];
    if (node.mesh < 0 || !placed.shown) continue;
    element(model, model.file.meshes, node.mesh, nodePlace(placed.node), "mesh");
    const bool has_skin = skinOf(model, placed.node) >= 0;
    if (node.skin >= 0 && !has_skin)
      warnRepaired(model, nodePlace(placed.node),
                   "has a skin, but its mesh no JOINTS_0 and WEIGHTS_0; drawn without", "no joints");
    glm::dmat4 frame(1.0);
    const int mesh = isDeformed(source, placed.node) ? addDeforming(source, placed, scene, frame)
                                                     : addRigid(source, node.mesh, scene);
    if (mesh < 0) continue;
    if (!has_skin) {
      placeWithNode(source, placed, static_cast<std::uint32_t>(mesh), scene);
    } else {
      if (!memberOf(node.extensions, kInstancing).is_null())
        failGltf(model, nodePlace(placed.node), "has a skin, which has no instances");
      scene.objects.push_back({static_cast<std::uint32_t>(mesh), frame, -1, node.name});
    }
  }
  addGltfMaterials(model, source.materials, scene);
}

}  // namespace luciole
