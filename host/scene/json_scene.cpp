#include "scene/json_scene.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <vector>

#include "error.hpp"
#include "scene/frame.hpp"
#include "scene/json_fields.hpp"
#include "scene/json_light.hpp"
#include "scene/json_object.hpp"
#include "scene/text_file.hpp"

namespace luciole {
namespace {

constexpr int kLongestSide = 65536;
constexpr std::int64_t kMostPixels = std::int64_t{1} << 30;

std::string readWhole(const std::string& path) {
  if (path == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  return readFile(path);
}

Camera readCamera(const JsonNode& node) {
  allowKeys(node, {"eye", "target", "up", "fov_y", "orthographic", "near", "far"});
  Camera camera;
  const glm::dvec3 eye = readVector(need(node, "eye"));
  const glm::dvec3 target = readVector(need(node, "target"));
  glm::dvec3 up{0, 1, 0};
  if (const auto n = find(node, "up")) up = readDirection(*n);
  const double distance = glm::length(target - eye);
  if (!(distance >= 1 / kLargestNumber)) refuse(node, "eye and target are the same point");
  // Closer to parallel, rounding would decide what is up: 10⁻⁸ leaves half of a double's digits.
  constexpr double kLeastSine = 1e-8;
  if (glm::length(glm::cross((target - eye) / distance, up)) < kLeastSine) {
    refuse(node, "up is parallel to the view from eye to target");
  }
  camera.camera_to_world = cameraToWorld(eye, target, up);
  if (const auto n = find(node, "fov_y")) {
    refuseKeys(node, {"orthographic"}, "beside fov_y");
    const double degrees = readNumber(*n);
    if (!(degrees > 0 && degrees < 180)) {
      refuse(*n, fmt::format("expected degrees above 0 and below 180, got {}", degrees));
    }
    camera.fov_y = glm::radians(degrees);
  }
  if (const auto n = find(node, "orthographic")) {
    camera.orthographic = true;
    camera.half_height = readPositive(*n);
  }
  if (const auto n = find(node, "near")) camera.near = readPositive(*n);
  if (const auto n = find(node, "far")) camera.far = readPositive(*n);
  if (camera.far <= camera.near) {
    refuse(node, fmt::format("far {} isn't beyond near {}", camera.far, camera.near));
  }
  return camera;
}

Fog readFog(const JsonNode& node) {
  allowKeys(node, {"mode", "density", "start", "end", "color", "distance"});
  Fog fog;
  const JsonNode mode = need(node, "mode");
  const std::string name = readText(mode);
  if (name == "linear") {
    fog.mode = FogMode::kLinear;
    refuseKeys(node, {"density"}, "for linear fog");
    if (const auto n = find(node, "start")) fog.start = static_cast<float>(readNumber(*n));
    if (const auto n = find(node, "end")) fog.end = static_cast<float>(readNumber(*n));
    if (fog.start == fog.end) refuse(node, "start and end are the same distance");
  } else if (name == "exp" || name == "exp2") {
    fog.mode = name == "exp" ? FogMode::kExp : FogMode::kExp2;
    refuseKeys(node, {"start", "end"}, "for exponential fog");
    if (const auto n = find(node, "density")) fog.density = readColor(*n);
  } else {
    refuse(mode, fmt::format("expected \"linear\", \"exp\" or \"exp2\", got {}", mode.json->dump()));
  }
  if (const auto n = find(node, "color")) fog.color = readColor(*n);
  if (const auto n = find(node, "distance")) {
    const std::string distance = readText(*n);
    if (distance != "depth" && distance != "radial") {
      refuse(*n, fmt::format("expected \"depth\" or \"radial\", got {}", n->json->dump()));
    }
    fog.radial = distance == "radial";
  }
  return fog;
}

glm::ivec2 readSize(const JsonNode& node) {
  needArray(node);
  if (node.json->size() != 2) refuse(node, "expected [width, height]");
  glm::ivec2 size;
  for (int i = 0; i < 2; ++i) {
    size[i] = static_cast<int>(readCount(element(node, static_cast<std::size_t>(i)), kLongestSide));
  }
  checkPictureSize(size, fmt::format("{}: size", node.parent->key));
  return size;
}

void readLightFields(const JsonNode& node, std::vector<Light>& lights) {
  needArray(node);
  std::vector<LightField> fields;
  std::uint64_t total = lights.size();
  for (std::size_t i = 0; i < node.json->size(); ++i) {
    const JsonNode field = element(node, i);
    fields.push_back(readLightField(field));
    total += fields.back().count;
    if (total > kMostLights) {
      refuse(field, fmt::format("{} lights up to here; a scene may have {} at most", total, kMostLights));
    }
  }
  for (const LightField& field : fields) expandLightField(field, lights);
}

}  // namespace

void checkPictureSize(glm::ivec2 size, const std::string& where) {
  const bool sides_fit = size.x >= 1 && size.y >= 1 && size.x <= kLongestSide && size.y <= kLongestSide;
  if (!sides_fit || std::int64_t{size.x} * size.y > kMostPixels) {
    throw InputError(fmt::format("{}: {}x{} pixels; expected 1 to {} a side and {} in all at most", where,
                                 size.x, size.y, kLongestSide, kMostPixels));
  }
}

Scene loadJsonScene(const std::string& path) {
  Scene scene;
  const std::string file = path == "-" ? "standard input" : path;
  // Lights and cameras refer to nothing else in the file, so they are read while it is parsed: lights because
  // there may be a million, cameras because their order counts and a JSON object has none.
  const auto take = [&scene](const JsonNode& node) {
    const bool in_array = node.index != JsonNode::kNoIndex;
    if (in_array && node.parent->key == "lights") {
      if (const auto light = readLight(node)) scene.lights.push_back(*light);
      return true;
    }
    if (!in_array && node.parent->key == "cameras") {
      scene.cameras.push_back(readCamera(node));
      scene.cameras.back().name = node.key;
      return true;
    }
    return false;
  };
  const Json json = parseJson(readWhole(path), file, take);

  const JsonNode top{&json, nullptr, file, JsonNode::kNoIndex};
  allowKeys(top, {"camera", "cameras", "size", "background", "ambient", "fog", "materials", "objects",
                  "lights", "light_fields", "lighting"});
  if (const auto n = find(top, "lights")) needArray(*n);
  if (const auto n = find(top, "cameras")) {
    refuseKeys(top, {"camera"}, "beside cameras");
    needObject(*n);
    if (scene.cameras.empty()) refuse(*n, "expected one camera or more");
  }
  if (const auto n = find(top, "camera")) scene.cameras.push_back(readCamera(*n));
  if (const auto n = find(top, "size")) scene.size = readSize(*n);
  if (const auto n = find(top, "background")) scene.background = readColor(*n);
  if (const auto n = find(top, "ambient")) scene.ambient = readColor(*n);
  if (const auto n = find(top, "fog")) scene.fog = readFog(*n);
  if (const auto n = find(top, "lighting")) scene.lighting = readBool(*n);
  if (const auto n = find(top, "light_fields")) readLightFields(*n, scene.lights);
  const std::string folder = path == "-" ? "" : std::filesystem::path(path).parent_path().string();
  readObjects(top, folder, scene);
  scene.name = file;
  return scene;
}

}  // namespace luciole
