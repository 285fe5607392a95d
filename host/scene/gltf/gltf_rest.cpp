#include "scene/gltf/gltf_rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/gltf/gltf_accessor.hpp"

namespace luciole {
namespace {

/// How far a target moves an attribute's vertices; 0 where it says nothing of it.
std::vector<glm::vec3> readShifts(const GltfModel& model, const GltfAttributes& target, const char* name,
                                  std::size_t vertices, const std::string& place) {
  const auto found = target.find(name);
  if (found == target.end()) return std::vector<glm::vec3>(vertices, glm::vec3(0));
  const std::string here = fmt::format("{}.{}", place, name);
  std::vector<glm::vec3> shifts = readVectors<glm::vec3>(model, found->second, here);
  if (shifts.size() != vertices)
    failGltf(model, here, fmt::format("has {} elements for {} vertices", shifts.size(), vertices));
  checkFinite(model, shifts, here);
  return shifts;
}

/// Appends what a target does to a primitive whose first vertex is `first`.
void appendTarget(const GltfModel& model, const GltfAttributes& source, std::size_t first,
                  std::size_t vertices, const std::string& place, MorphTarget& target) {
  const auto read = [&](const char* name) { return readShifts(model, source, name, vertices, place); };
  const std::vector<glm::vec3> positions = read("POSITION"), normals = read("NORMAL"),
                               tangents = read("TANGENT");
  for (std::size_t i = 0; i < vertices; ++i) {
    if (positions[i] == glm::vec3(0) && normals[i] == glm::vec3(0) && tangents[i] == glm::vec3(0)) continue;
    target.vertices.push_back(static_cast<std::uint32_t>(first + i));
    target.positions.push_back(positions[i]);
    target.normals.push_back(normals[i]);
    target.tangents.push_back(tangents[i]);
  }
}

/// The joints and weights of one set of four influences a vertex.
struct InfluenceSet {
  std::vector<glm::vec4> joints, weights;
};

std::vector<InfluenceSet> readInfluenceSets(const GltfModel& model, const GltfPrimitive& primitive,
                                            std::size_t vertices, const std::string& place) {
  std::vector<InfluenceSet> sets;
  for (;;) {
    const std::string joints_name = fmt::format("JOINTS_{}", sets.size()),
                      weights_name = fmt::format("WEIGHTS_{}", sets.size());
    const auto joints = primitive.attributes.find(joints_name),
               weights = primitive.attributes.find(weights_name);
    if (joints == primitive.attributes.end() && weights == primitive.attributes.end()) return sets;
    if (joints == primitive.attributes.end() || weights == primitive.attributes.end())
      failGltf(model, place, fmt::format("has one of {} and {}", joints_name, weights_name));
    InfluenceSet set;
    set.joints = readVectors<glm::vec4>(model, joints->second, fmt::format("{}.{}", place, joints_name));
    set.weights = readVectors<glm::vec4>(model, weights->second, fmt::format("{}.{}", place, weights_name));
    for (const std::size_t count : {set.joints.size(), set.weights.size()})
      if (count != vertices)
        failGltf(model, place, fmt::format("its attributes have {} and {} elements", vertices, count));
    std::size_t negative = 0, first_negative = 0;
    for (std::size_t i = 0; i < vertices; ++i)
      for (int c = 0; c < 4; ++c) {
        const float joint = set.joints[i][c], weight = set.weights[i][c];
        if (!(joint >= 0 && joint <= 65535 && joint == std::floor(joint)))
          failGltf(model, place, fmt::format("{}: element {} is no joint's number", joints_name, i));
        if (!std::isfinite(weight))
          failGltf(model, place, fmt::format("{}: element {} is not finite", weights_name, i));
        if (weight < 0) {
          set.weights[i][c] = 0;
          if (negative++ == 0) first_negative = i;
        }
      }
    if (negative > 0)
      warnRepaired(
          model, fmt::format("{}.{}", place, weights_name),
          fmt::format("{} are negative, the first of element {}; taken for 0", negative, first_negative),
          "negative weights");
    sets.push_back(std::move(set));
  }
}

}  // namespace

GltfSkin readGltfSkin(const GltfModel& model, int skin, const std::string& place) {
  const GltfSkinEntry& source = element(model, model.file.skins, skin, place, "skin");
  const std::string here = fmt::format("skins[{}]", skin);
  if (source.joints.empty()) failGltf(model, here, "has no joints");
  GltfSkin result;
  result.joints = source.joints;
  for (const int joint : result.joints) element(model, model.file.nodes, joint, here, "node");
  result.inverse_binds.assign(result.joints.size(), glm::dmat4(1.0));
  if (source.inverse_binds < 0) return result;
  const std::vector<float> numbers =
      readFloats(model, source.inverse_binds, 16, here + ".inverseBindMatrices");
  if (numbers.size() < 16 * result.joints.size())
    failGltf(
        model, here,
        fmt::format("has {} joints, but {} inverseBindMatrices", result.joints.size(), numbers.size() / 16));
  for (std::size_t i = 0; i < result.joints.size(); ++i)
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row) {  // its last row is 0 0 0 1
        const float number = numbers[16 * i + std::size_t(4 * column + row)];
        if (!std::isfinite(number))
          failGltf(model, here, "a number of its inverseBindMatrices is not finite");
        result.inverse_binds[i][column][row] = number;
      }
  return result;
}

void appendRest(const GltfModel& model, const GltfPrimitive& primitive, const Mesh& part,
                const std::string& place, RestShape& rest) {
  const std::size_t first = rest.positions.size(), vertices = part.positions.size();
  rest.positions.insert(rest.positions.end(), part.positions.begin(), part.positions.end());
  rest.normals.insert(rest.normals.end(), part.normals.begin(), part.normals.end());
  rest.normals.resize(rest.positions.size(), glm::vec3(0));
  if (rest.targets.size() < primitive.targets.size()) rest.targets.resize(primitive.targets.size());
  for (std::size_t t = 0; t < primitive.targets.size(); ++t)
    appendTarget(model, primitive.targets[t], first, vertices, fmt::format("{}.targets[{}]", place, t),
                 rest.targets[t]);
  const std::vector<InfluenceSet> sets = readInfluenceSets(model, primitive, vertices, place);
  constexpr double kMostOff = 0.02;  // four of 8 bits are off by half of that at most
  std::size_t off = 0;
  std::string first_off;
  for (std::size_t i = 0; i < vertices; ++i) {
    const std::size_t before = rest.influence_joints.size();
    double sum = 0;
    const auto add = [&](float joint, float weight) {
      rest.influence_joints.push_back(static_cast<std::uint32_t>(joint));
      rest.influence_weights.push_back(weight);
    };
    for (const InfluenceSet& set : sets)
      for (int c = 0; c < 4; ++c)
        if (set.weights[i][c] > 0) {
          add(set.joints[i][c], set.weights[i][c]);
          sum += double(set.weights[i][c]);
        }
    if (!sets.empty() && !(std::abs(sum - 1) <= kMostOff) && off++ == 0)
      first_off = fmt::format("{:.6g} of element {}", sum, i);
    if (rest.influence_joints.size() == before && !sets.empty()) add(sets[0].joints[i][0], 1);
    rest.first_influence.push_back(static_cast<std::uint32_t>(rest.influence_joints.size()));
  }
  if (off > 0)
    warnRepaired(
        model, place + ".WEIGHTS_0",
        fmt::format("{} elements have another sum than 1, {} the first; scaled to it", off, first_off),
        "sums of weights");
}

void checkInfluences(const GltfModel& model, const RestShape& rest, std::size_t joints,
                     const std::string& place) {
  for (std::size_t i = 0; i < rest.positions.size(); ++i)
    if (rest.first_influence[i] == rest.first_influence[i + 1])
      failGltf(model, place, "has a skin, but its mesh has a primitive without JOINTS_0 and WEIGHTS_0");
  for (const std::uint32_t joint : rest.influence_joints)
    if (joint >= joints)
      failGltf(model, place, fmt::format("a vertex follows joint {}, but its skin has {}", joint, joints));
}

std::size_t targetCount(const GltfModel& model, int mesh) {
  std::size_t count = 0;
  for (const GltfPrimitive& primitive :
       element(model, model.file.meshes, mesh, fmt::format("meshes[{}]", mesh), "mesh").primitives)
    count = std::max(count, primitive.targets.size());
  return count;
}

std::vector<double> targetWeights(const GltfModel& model, int node) {
  const GltfNode& source = model.file.nodes[std::size_t(node)];
  std::vector<double> weights = source.weights;
  if (weights.empty()) weights = model.file.meshes[std::size_t(source.mesh)].weights;
  weights.resize(targetCount(model, source.mesh), 0.0);
  return weights;
}

void checkWeights(const GltfModel& model) {
  const auto check = [&](const std::vector<double>& weights, int mesh, const char* list, std::size_t index) {
    const std::size_t count = weights.empty() ? 0 : targetCount(model, mesh);
    if (!weights.empty() && weights.size() != count)
      warnRepaired(model, fmt::format("{}[{}]", list, index),
                   fmt::format("has {} weights for {} morph targets", weights.size(), count), "weights");
  };
  for (std::size_t i = 0; i < model.file.meshes.size(); ++i) {
    const GltfMesh& mesh = model.file.meshes[i];
    check(mesh.weights, static_cast<int>(i), "meshes", i);
    const std::size_t count = targetCount(model, static_cast<int>(i));
    for (const GltfPrimitive& primitive : mesh.primitives) {
      if (primitive.targets.size() == count) continue;
      warnRepaired(
          model, fmt::format("meshes[{}]", i),
          fmt::format("its primitives have {} and {} morph targets", count, primitive.targets.size()),
          "targets");
      break;
    }
  }
  for (std::size_t i = 0; i < model.file.nodes.size(); ++i)
    if (model.file.nodes[i].mesh >= 0)
      check(model.file.nodes[i].weights, model.file.nodes[i].mesh, "nodes", i);
}

}  // namespace luciole
