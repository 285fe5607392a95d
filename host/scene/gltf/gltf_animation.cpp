#include "scene/gltf/gltf_animation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/text_file.hpp"
#include "scene/gltf/gltf_accessor.hpp"

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

/// Reads a sampler (glTF 2.0, 3.11 and appendix C). Times become frames, and slopes become changes per frame.
Curve readSampler(const GltfModel& model, const tinygltf::AnimationSampler& sampler, bool is_rotation,
                  double frame_rate, const std::string& place) {
  Curve curve;
  curve.interpolation = interpolationOf(model, sampler.interpolation, is_rotation, place);
  const std::vector<float> times = readTimes(model, sampler.input, place);
  const std::size_t components = is_rotation ? 4 : 3;
  const std::vector<float> values =
      readFloats(model, sampler.output, static_cast<int>(components), place + ".output");
  const bool is_cubic = curve.interpolation == Interpolation::kCubic;
  const std::size_t expected = times.size() * components * (is_cubic ? 3 : 1);
  if (values.size() != expected)
    failGltf(
        model, place,
        fmt::format("{} times and {} numbers of output, expected {}", times.size(), values.size(), expected));
  const auto vectorAt = [&](std::size_t element) {
    glm::dvec4 vector(0);
    for (std::size_t i = 0; i < components; ++i) {
      vector[static_cast<int>(i)] = values[element * components + i];
      if (!std::isfinite(values[element * components + i]))
        failGltf(model, place, "a number of its output is not finite");
    }
    return vector;
  };
  curve.keys.reserve(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    CurveKey key;
    key.frame = 1 + times[i] * frame_rate;
    key.value = vectorAt(is_cubic ? 3 * i + 1 : i);
    if (is_cubic) {
      key.slope_in = vectorAt(3 * i) / frame_rate;
      key.slope_out = vectorAt(3 * i + 2) / frame_rate;
    }
    if (is_rotation && !(glm::length(key.value) > 0))
      failGltf(model, place, "a rotation is 0, expected unit quaternions");
    if (curve.interpolation == Interpolation::kSlerp) key.value = glm::normalize(key.value);
    curve.keys.push_back(key);
  }
  return curve;
}

}  // namespace

std::map<int, NodeCurves> readGltfAnimations(const GltfModel& model, Animation& animation) {
  std::map<int, NodeCurves> nodes;
  for (std::size_t a = 0; a < model.file.animations.size(); ++a) {
    const tinygltf::Animation& source = model.file.animations[a];
    std::map<std::pair<int, bool>, int> curves;  // sampler, whether of rotations -> Animation::curves
    for (std::size_t c = 0; c < source.channels.size(); ++c) {
      const tinygltf::AnimationChannel& channel = source.channels[c];
      const std::string& path = channel.target_path;
      if (path == "weights") continue;
      const std::string place = fmt::format("animations[{}].channels[{}]", a, c);
      element(model, model.file.nodes, channel.target_node, place, "node");
      int NodeCurves::*part = path == "translation" ? &NodeCurves::translation
                              : path == "rotation"  ? &NodeCurves::rotation
                              : path == "scale"     ? &NodeCurves::scale
                                                    : nullptr;
      if (!part)
        failGltf(model, place,
                 fmt::format("path '{}' is none of translation, rotation, scale, weights", forMessage(path)));
      const tinygltf::AnimationSampler& sampler =
          element(model, source.samplers, channel.sampler, place, "sampler");
      const auto [known, is_new] = curves.try_emplace({channel.sampler, path == "rotation"}, -1);
      if (is_new) {
        known->second = static_cast<int>(animation.curves.size());
        animation.curves.push_back(
            readSampler(model, sampler, path == "rotation", animation.frame_rate,
                        fmt::format("animations[{}].samplers[{}]", a, channel.sampler)));
      }
      int& index = nodes[channel.target_node].*part;
      if (index < 0) index = known->second;
    }
  }
  return nodes;
}

}  // namespace luciole
