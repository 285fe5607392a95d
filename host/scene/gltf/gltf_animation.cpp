#include "scene/gltf/gltf_animation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/text_file.hpp"
#include "scene/gltf/gltf_accessor.hpp"
#include "scene/gltf/gltf_nodes.hpp"
#include "scene/gltf/gltf_rest.hpp"

namespace luciole {
namespace {

Interpolation interpolationOf(const GltfModel& model, const std::string& name, bool is_rotation,
                              const std::string& place) {
  const Interpolation linear = is_rotation ? Interpolation::kSlerp : Interpolation::kLinear;
  if (name == "STEP") return Interpolation::kStep;
  if (name == "LINEAR") return linear;
  if (name == "CUBICSPLINE") return Interpolation::kCubic;
  warnRepaired(model, place,
               fmt::format("interpolation '{}' is none of LINEAR, STEP, CUBICSPLINE", forMessage(name)),
               "interpolation");
  if (equalIgnoringCase(name, "STEP")) return Interpolation::kStep;
  return equalIgnoringCase(name, "CUBICSPLINE") ? Interpolation::kCubic : linear;
}

/// The times of keys, and which key of the file is first, second … Those before 0 count for what they tell of
/// later ones, those of equal times are a jump, and those out of order are sorted.
std::vector<std::size_t> orderOfTimes(const GltfModel& model, const std::vector<float>& times,
                                      const std::string& place) {
  float before = -1;
  bool is_fine = true;
  for (const float time : times) {
    if (!std::isfinite(time)) failGltf(model, place, "a time is not finite");
    if (is_fine && !(time >= 0 && time > before)) {
      is_fine = false;
      warnRepaired(model, place,
                   before < 0
                       ? fmt::format("time {}: expected rising times from 0 on", time)
                       : fmt::format("time {} after {}: expected rising times from 0 on", time, before),
                   "times");
    }
    before = time;
  }
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
  return order;
}

/// Makes no turn of a quaternion that is 0. Warns of the first one of a sampler whose length isn't 1.
void repairRotation(const GltfModel& model, const std::string& place, std::size_t key, bool& is_unit,
                    glm::dvec4& quaternion) {
  const double length = glm::length(quaternion);
  if (is_unit && !isUnitLength(length)) {
    is_unit = false;
    warnRepaired(model, place,
                 fmt::format("output {}: a rotation of length {}, expected unit quaternions", key, length),
                 "rotation");
  }
  if (!(length > 0)) quaternion = {0, 0, 0, 1};
}

/// What a channel changes.
struct Target {
  bool is_rotation = false, is_weights = false;
  std::size_t count = 3;  ///< of its numbers
};

/// Reads a sampler (glTF 2.0, 3.11 and appendix C) into curves of four of the target's numbers each. Times
/// become frames, and slopes become changes per frame.
std::vector<Curve> readSampler(const GltfModel& model, const GltfKeys& sampler, const Target& target,
                               double frame_rate, const std::string& place) {
  const Interpolation interpolation =
      interpolationOf(model, sampler.interpolation, target.is_rotation, place);
  const std::vector<float> times = readFloats(model, sampler.input, 1, place + ".input");
  const std::vector<std::size_t> order = orderOfTimes(model, times, place);
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
  if (times.empty()) return curves;
  bool is_unit = true;
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
    for (const std::size_t i : order) {
      CurveKey key;
      key.frame = 1 + times[i] * frame_rate;
      key.value = vectorAt(is_cubic ? 3 * i + 1 : i);
      if (is_cubic) {
        key.slope_in = vectorAt(3 * i) / frame_rate;
        key.slope_out = vectorAt(3 * i + 2) / frame_rate;
      }
      if (target.is_rotation) repairRotation(model, place, i, is_unit, key.value);
      if (interpolation == Interpolation::kSlerp) key.value = glm::normalize(key.value);
      curve.keys.push_back(key);
    }
  }
  return curves;
}

/// What a channel moves; nothing, with a warning, where it moves nothing that there is.
std::optional<Target> targetOf(const GltfModel& model, const GltfChannel& channel, const std::string& place) {
  const std::string& path = channel.path;
  if (path == "translation" || path == "scale") return Target{};
  if (path == "rotation") return Target{.is_rotation = true, .count = 4};
  if (path != "weights") {
    warnRepaired(
        model, place,
        fmt::format("path '{}' is none of translation, rotation, scale, weights; left out", forMessage(path)),
        "path");
    return {};
  }
  const int mesh = model.file.nodes[std::size_t(channel.node)].mesh;
  const std::size_t count = mesh < 0 ? 0 : targetCount(model, mesh);
  if (count == 0) {
    warnRepaired(model, place, "moves weights of a node without morph targets; left out", "weights");
    return {};
  }
  return Target{.is_weights = true, .count = count};
}

/// Reads an animation into the curves of nodes. What others move already they keep.
void readAnimation(const GltfModel& model, std::size_t index, Animation& animation,
                   std::map<int, NodeCurves>& nodes) {
  const GltfAnimationEntry& source = model.file.animations[index];
  std::map<std::pair<int, std::string>, std::vector<int>> known;  // sampler, path -> Animation::curves
  for (std::size_t c = 0; c < source.channels.size(); ++c) {
    const GltfChannel& channel = source.channels[c];
    const std::string place = fmt::format("animations[{}].channels[{}]", index, c);
    if (channel.node < 0) continue;  // an extension says what it moves
    element(model, model.file.nodes, channel.node, place, "node");
    const std::optional<Target> target = targetOf(model, channel, place);
    if (!target) continue;
    const GltfKeys& sampler = element(model, source.samplers, channel.sampler, place, "sampler");
    std::vector<int>& curves = known[{channel.sampler, channel.path}];
    if (curves.empty())
      for (Curve& curve : readSampler(model, sampler, *target, animation.frame_rate,
                                      fmt::format("animations[{}].samplers[{}]", index, channel.sampler))) {
        curves.push_back(static_cast<int>(animation.curves.size()));
        animation.curves.push_back(std::move(curve));
      }
    if (curves.empty()) continue;
    NodeCurves& node = nodes[channel.node];
    if (target->is_weights) {
      if (node.weights.empty()) node.weights = curves;
      continue;
    }
    int& part = target->is_rotation             ? node.rotation
                : channel.path == "translation" ? node.translation
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
