#include "scene/gltf/gltf_animation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/text_file.hpp"
#include "scene/gltf/gltf_accessor.hpp"
#include "scene/gltf/gltf_rest.hpp"

namespace luciole {
namespace {

Interpolation interpolationOf(const GltfModel& model, const std::string& name, bool is_rotation,
                              const std::string& place) {
  if (name == "STEP") return Interpolation::kStep;
  if (name == "LINEAR") return is_rotation ? Interpolation::kSlerp : Interpolation::kLinear;
  if (name == "CUBICSPLINE") return Interpolation::kCubic;
  failGltf(model, place,
           fmt::format("interpolation '{}' is none of LINEAR, STEP, CUBICSPLINE", forMessage(name)));
}

std::vector<float> readTimes(const GltfModel& model, int input, const std::string& place) {
  const std::vector<float> times = readFloats(model, input, 1, place + ".input");
  float before = -1;
  for (const float time : times) {
    if (!(time >= 0 && time > before && std::isfinite(time)))
      failGltf(model, place, fmt::format("time {} after {}: expected rising times from 0 on", time, before));
    before = time;
  }
  return times;
}

/// What a channel changes.
struct Target {
  bool is_rotation = false, is_weights = false;
  std::size_t count = 3;  ///< of its numbers
};

/// Reads a sampler (glTF 2.0, 3.11 and appendix C) into curves of four of the target's numbers each. Times
/// become frames, and slopes become changes per frame.
std::vector<Curve> readSampler(const GltfModel& model, const tinygltf::AnimationSampler& sampler,
                               const Target& target, double frame_rate, const std::string& place) {
  const Interpolation interpolation =
      interpolationOf(model, sampler.interpolation, target.is_rotation, place);
  const std::vector<float> times = readTimes(model, sampler.input, place);
  const std::vector<float> values = readFloats(
      model, sampler.output, target.is_weights ? 1 : static_cast<int>(target.count), place + ".output");
  const bool is_cubic = interpolation == Interpolation::kCubic;
  const std::size_t expected = times.size() * target.count * (is_cubic ? 3 : 1);
  if (values.size() != expected)
    failGltf(
        model, place,
        fmt::format("{} times and {} numbers of output, expected {}", times.size(), values.size(), expected));
  for (const float value : values)
    if (!std::isfinite(value)) failGltf(model, place, "a number of its output is not finite");
  std::vector<Curve> curves;
  for (std::size_t first = 0; first < target.count; first += 4) {
    const auto vectorAt = [&](std::size_t element) {
      glm::dvec4 vector(0);
      for (std::size_t i = first; i < std::min(first + 4, target.count); ++i)
        vector[static_cast<int>(i - first)] = values[element * target.count + i];
      return vector;
    };
    Curve& curve = curves.emplace_back();
    curve.interpolation = interpolation;
    curve.keys.reserve(times.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
      CurveKey key;
      key.frame = 1 + times[i] * frame_rate;
      key.value = vectorAt(is_cubic ? 3 * i + 1 : i);
      if (is_cubic) {
        key.slope_in = vectorAt(3 * i) / frame_rate;
        key.slope_out = vectorAt(3 * i + 2) / frame_rate;
      }
      if (target.is_rotation && !(glm::length(key.value) > 0))
        failGltf(model, place, "a rotation is 0, expected unit quaternions");
      if (interpolation == Interpolation::kSlerp) key.value = glm::normalize(key.value);
      curve.keys.push_back(key);
    }
  }
  return curves;
}

Target targetOf(const GltfModel& model, const tinygltf::AnimationChannel& channel, const std::string& place) {
  const std::string& path = channel.target_path;
  if (path == "translation" || path == "scale") return {};
  if (path == "rotation") return {.is_rotation = true, .count = 4};
  if (path != "weights")
    failGltf(model, place,
             fmt::format("path '{}' is none of translation, rotation, scale, weights", forMessage(path)));
  const int mesh = model.file.nodes[channel.target_node].mesh;
  const std::size_t count = mesh < 0 ? 0 : targetCount(model, mesh);
  if (count == 0) failGltf(model, place, "moves weights of a node without morph targets");
  return {.is_weights = true, .count = count};
}

/// Reads an animation into the curves of nodes. What others move already they keep.
void readAnimation(const GltfModel& model, std::size_t index, Animation& animation,
                   std::map<int, NodeCurves>& nodes) {
  const tinygltf::Animation& source = model.file.animations[index];
  std::map<std::pair<int, std::string>, std::vector<int>> known;  // sampler, path -> Animation::curves
  for (std::size_t c = 0; c < source.channels.size(); ++c) {
    const tinygltf::AnimationChannel& channel = source.channels[c];
    const std::string place = fmt::format("animations[{}].channels[{}]", index, c);
    element(model, model.file.nodes, channel.target_node, place, "node");
    const Target target = targetOf(model, channel, place);
    const tinygltf::AnimationSampler& sampler =
        element(model, source.samplers, channel.sampler, place, "sampler");
    std::vector<int>& curves = known[{channel.sampler, channel.target_path}];
    if (curves.empty())
      for (Curve& curve : readSampler(model, sampler, target, animation.frame_rate,
                                      fmt::format("animations[{}].samplers[{}]", index, channel.sampler))) {
        curves.push_back(static_cast<int>(animation.curves.size()));
        animation.curves.push_back(std::move(curve));
      }
    NodeCurves& node = nodes[channel.target_node];
    if (target.is_weights) {
      if (node.weights.empty()) node.weights = curves;
      continue;
    }
    int& part = target.is_rotation                     ? node.rotation
                : channel.target_path == "translation" ? node.translation
                                                       : node.scale;
    if (part < 0) part = curves.front();
  }
}

}  // namespace

std::map<int, NodeCurves> readGltfAnimations(const GltfModel& model, Animation& animation) {
  std::map<int, NodeCurves> nodes;
  for (std::size_t i = 0; i < model.file.animations.size(); ++i)
    if (model.animation < 0 || i == static_cast<std::size_t>(model.animation))
      readAnimation(model, i, animation, nodes);
  return nodes;
}

}  // namespace luciole
