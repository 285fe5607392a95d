#include "scene/json/json_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/picture_size.hpp"
#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/json/json_fields.hpp"
#include "scene/json/json_keys.hpp"
#include "scene/json/json_light.hpp"
#include "scene/json/json_object.hpp"
#include "scene/json/plain_lights.hpp"
#include "scene/posing.hpp"

namespace luciole {
namespace {

std::string readWhole(const std::string& path) {
  if (path == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  return readFile(path);
}

glm::dvec4 readVectorValue(const JsonNode& node) { return {readVector(node), 0}; }

double readFovY(const JsonNode& node) {
  const double degrees = readNumber(node);
  if (!(degrees > 0 && degrees < 180))
    refuse(node, fmt::format("expected degrees above 0 and below 180, got {}", degrees));
  return degrees;
}

/// [x, y].
glm::dvec2 readShift(const JsonNode& node) {
  if (!node.json->is_array() || node.json->size() != 2) refuse(node, "expected an array of 2 numbers");
  const auto at = [&](std::size_t i) {
    return readNumber(element(node, i), -kMostLensShift, kMostLensShift);
  };
  return {at(0), at(1)};
}

/// [azimuth, elevation, distance].
glm::dvec3 readOrbit(const JsonNode& node) {
  const glm::dvec3 orbit = readVector(node);
  if (!(std::abs(orbit.y) <= 90)) refuse(element(node, 1), "expected an elevation from -90 to 90 degrees");
  readPositive(element(node, 2));
  return orbit;
}

/// How a camera with keys moves; `still` holds the camera's own values.
void readCameraMotion(const JsonNode& node, const CameraMotion& still, Camera& camera, Scene& scene) {
  if (!hasKeys(node, {still.orbits ? "orbit" : "eye", "target", "fov_y"})) return;
  CameraMotion motion = still;
  motion.camera = static_cast<std::uint32_t>(scene.cameras.size());
  Curve place = readMotion(node, still.orbits ? "orbit" : "eye", [&](const JsonNode& value) {
    return glm::dvec4(still.orbits ? readOrbit(value) : readVector(value), 0);
  });
  if (!place.keys.empty()) motion.eye = std::move(place);
  Curve target = readMotion(node, "target", readVectorValue);
  if (!target.keys.empty()) motion.target = std::move(target);
  motion.fov_y = readMotion(node, "fov_y", [&](const JsonNode& value) {
    if (camera.orthographic) refuse(value, "means nothing beside orthographic");
    return glm::dvec4(readFovY(value), 0, 0, 0);
  });
  checkPoses(node, [&](double frame) { return poseCamera(motion, frame, camera); });
  scene.animation.cameras.push_back(std::move(motion));
}

/// Reads a camera and how it moves.
void readCamera(const JsonNode& node, const std::string& name, Scene& scene) {
  allowKeys(node, {"eye", "orbit", "target", "up", "fov_y", "orthographic", "shift", "pixel_aspect", "near",
                   "far", "keys", "interpolation"});
  Camera camera;
  camera.name = name;
  CameraMotion still;
  glm::dvec3 eye;
  const glm::dvec3 target = readVector(need(node, "target"));
  if (const auto n = find(node, "orbit")) {
    refuseKeys(node, {"eye"}, "beside orbit");
    still.orbits = true;
    still.eye = constantCurve(glm::dvec4(readOrbit(*n), 0));
    eye = orbitEye(readOrbit(*n), target);
  } else {
    eye = readVector(need(node, "eye"));
    still.eye = constantCurve(glm::dvec4(eye, 0));
  }
  still.target = constantCurve(glm::dvec4(target, 0));
  if (const auto n = find(node, "up")) still.up = readDirection(*n);
  const std::string fault = aimCamera(eye, target, still.up, camera);
  if (!fault.empty()) refuse(node, fault);
  if (const auto n = find(node, "fov_y")) {
    refuseKeys(node, {"orthographic"}, "beside fov_y");
    camera.fov_y = glm::radians(readFovY(*n));
  }
  if (const auto n = find(node, "orthographic")) {
    camera.orthographic = true;
    camera.half_height = readPositive(*n);
  }
  if (const auto n = find(node, "shift")) camera.shift = readShift(*n);
  if (const auto n = find(node, "pixel_aspect"))
    camera.pixel_aspect = readNumber(*n, 1 / kMostPixelAspect, kMostPixelAspect);
  if (const auto n = find(node, "near")) camera.near = readPositive(*n);
  if (const auto n = find(node, "far")) camera.far = readPositive(*n);
  if (camera.far <= camera.near) {
    refuse(node, fmt::format("far {} isn't beyond near {}", camera.far, camera.near));
  }
  readCameraMotion(node, still, camera, scene);
  scene.cameras.push_back(std::move(camera));
}

Fog readFog(const JsonNode& node) {
  allowKeys(node, {"mode", "density", "start", "end", "color", "distance"});
  Fog fog;
  const JsonNode mode = need(node, "mode");
  const std::string name = readText(mode);
  if (name == "linear") {
    fog.mode = FogMode::kLinear;
    refuseKeys(node, {"density"}, "for linear fog, only for the modes exp and exp2");
    if (const auto n = find(node, "start")) fog.start = static_cast<float>(readNumber(*n));
    if (const auto n = find(node, "end")) fog.end = static_cast<float>(readNumber(*n));
    if (fog.start == fog.end) refuse(node, "start and end are the same distance");
  } else if (name == "exp" || name == "exp2") {
    fog.mode = name == "exp" ? FogMode::kExp : FogMode::kExp2;
    refuseKeys(node, {"start", "end"}, fmt::format("for {} fog, only for the mode linear", name));
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

/// Whether a scene file says anything about light: lights, ambient, lighting, or emission of a material.
bool saysLight(const JsonNode& top) {
  for (const char* key : {"lights", "light_fields", "ambient", "lighting"})
    if (find(top, key)) return true;
  const auto materials = find(top, "materials");
  return materials && std::any_of(materials->json->begin(), materials->json->end(), [](const Json& material) {
           return material.contains("emission") || material.contains("emission_map");
         });
}

glm::ivec2 readSize(const JsonNode& node) {
  needArray(node);
  if (node.json->size() != 2) refuse(node, "expected [width, height]");
  glm::ivec2 size;
  for (int i = 0; i < 2; ++i) {
    size[i] = static_cast<int>(readCount(element(node, static_cast<std::size_t>(i)), kLargestSide));
  }
  checkPictureSize(size, fmt::format("{}: size", node.parent->key));
  return size;
}

std::vector<LightField> readLightFields(const JsonNode& node, const SearchFolders& where,
                                        LightGroupNumbers& groups, Scene& scene) {
  needArray(node);
  std::uint64_t lights = scene.lights.size();
  std::vector<LightField> fields;
  for (std::size_t i = 0; i < node.json->size(); ++i) {
    const JsonNode field = element(node, i);
    fields.push_back(readLightField(field, where, groups, scene));
    lights += fields.back().count;
    if (lights > kMostLights) {
      refuse(field, fmt::format("{} lights up to here; a scene may have {} at most", lights, kMostLights));
    }
  }
  return fields;
}

/// Whether all of a list gets another value.
bool isReplaced(const std::vector<SceneChange>& changes, std::string_view list) {
  return std::any_of(changes.begin(), changes.end(), [&](const SceneChange& change) {
    return change.place.size() == 1 && change.place[0].key == list;
  });
}

/// Throws InputError for a change of a light or a camera that the file doesn't have.
void refuseUnmade(const std::vector<SceneChange>& changes, const Scene& scene, std::size_t light_count) {
  for (const SceneChange& change : changes) {
    if (change.is_made) continue;
    std::vector<std::string> known;
    if (change.place[0].key == "cameras")
      for (const Camera& camera : scene.cameras) known.push_back(camera.name);
    else if (light_count > 0)
      known.push_back(fmt::format("lights[0] to lights[{}]", light_count - 1));
    refuseChange(change, scene.name, known);
  }
}

}  // namespace

void checkPictureSize(glm::ivec2 size, const std::string& where) {
  if (size.x < 1 || size.y < 1 || size.x > kLargestSide || size.y > kLargestSide) {
    throw InputError(
        fmt::format("{}: {}x{} pixels, expected 1 to {} a side", where, size.x, size.y, kLargestSide));
  }
}

SceneFile loadJsonScene(const std::string& path, const std::vector<std::string>& search,
                        std::vector<SceneChange> changes) {
  if (path == "-") return parseJsonScene(readWhole(path), "standard input", {"", search}, std::move(changes));
  return parseJsonScene(readWhole(path), path, {std::filesystem::path(path).parent_path().string(), search},
                        std::move(changes));
}

void readSurroundings(const JsonNode& top, Scene& scene) {
  if (const auto n = find(top, "background")) scene.background = readColor(*n);
  if (const auto n = find(top, "ambient")) scene.ambient = readColor(*n);
  if (const auto n = find(top, "fog")) scene.fog = readFog(*n);
  if (const auto n = find(top, "lighting")) scene.lighting = readBool(*n);
}

namespace {

/// Reads a scene from its text, to which the lights `read` has already belong.
SceneFile readScene(SceneFile read, const std::string& text, const std::string& file,
                    const SearchFolders& where, std::vector<SceneChange> changes) {
  Scene& scene = read.scene;
  // Lights and cameras refer to nothing else in the file, so they are read while it is parsed: lights because
  // there may be a million, cameras because their order counts and a JSON object has none.
  LightGroupNumbers groups = lightGroupNumbers(scene);
  LightFiles light_files{where};
  std::size_t light_count = 0;
  const auto read_member = [&](const JsonNode& node) {
    if (node.parent->key == "lights")
      readLight(node, groups, light_files, scene);
    else
      readCamera(node, std::string(node.key), scene);
  };
  const auto take = [&](const JsonNode& node) {
    const bool in_array = node.index != JsonNode::kNoIndex;
    if (node.parent->key != (in_array ? "lights" : "cameras")) return false;
    light_count += in_array;
    if (changes.empty()) {
      read_member(node);
    } else if (!isReplaced(changes, node.parent->key)) {
      const Json changed = changedMember(node, changes);
      read_member({&changed, node.parent, node.key, node.index});
    }
    return true;
  };
  Json json = parseJson(text, file, take);
  changeScene(json, file, changes);

  const JsonNode top{&json, nullptr, file, JsonNode::kNoIndex};
  allowKeys(top, {"$schema", "camera", "cameras", "size", "background", "ambient", "fog", "materials",
                  "objects", "lights", "light_fields", "lighting", "frame_rate"});
  if (const auto n = find(top, "$schema")) readText(*n);  // it is the editors'
  // What is left of these two was set in their place.
  if (const auto n = find(top, "lights")) {
    needArray(*n);
    for (std::size_t i = 0; i < n->json->size(); ++i) read_member(element(*n, i));
  }
  if (const auto n = find(top, "cameras")) {
    refuseKeys(top, {"camera"}, "beside cameras");
    needObject(*n);
    for (const auto& [name, value] : n->json->items()) read_member(*find(*n, name));
    if (scene.cameras.empty()) refuse(*n, "expected one camera or more");
  }
  if (const auto n = find(top, "camera")) readCamera(*n, "", scene);
  if (const auto n = find(top, "size")) scene.size = readSize(*n);
  readSurroundings(top, scene);
  if (const auto n = find(top, "frame_rate")) scene.animation.frame_rate = readPositive(*n);
  scene.name = file;
  if (const auto n = find(top, "light_fields")) read.light_fields = readLightFields(*n, where, groups, scene);
  readObjects(top, where, scene);
  changeMaterials(changes, where, scene);
  refuseUnmade(changes, scene, light_count);
  scene.says_light = saysLight(top);
  return read;
}

}  // namespace

SceneFile parseJsonScene(const std::string& text, const std::string& file, const SearchFolders& where,
                         std::vector<SceneChange> changes) {
  std::optional<PlainLights> plain = changes.empty() ? readPlainLights(text) : std::nullopt;
  if (plain) {
    try {
      SceneFile read;
      read.scene.lights = std::move(plain->lights);
      return readScene(std::move(read), plain->rest, file, where, {});
    } catch (const InputError&) {
      // Places in the whole text are told below.
    }
  }
  return readScene({}, text, file, where, std::move(changes));
}

}  // namespace luciole
