#pragma once

#include <cctype>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "shared_files.hpp"

// Scenes whose files the tests of the schema change and judge.
namespace luciole::test {

using nlohmann::json;

/// Scenes that between them use every key.
inline constexpr std::pair<const char*, const char*> kOwnScenes[]{
    {"Cameras",
     R"({"$schema": "scene.schema.json", "size": [64, 36], "background": [0.1, 0.2, 0.3], "ambient": 0.5,
      "lighting": true, "frame_rate": 25,
      "cameras": {
        "still": {"eye": [1, 2, 5], "target": [0, 1, 0], "up": [0.1, 1, 0], "fov_y": 40, "near": 0.5, "far": 60,
                  "shift": [0.25, -0.5], "pixel_aspect": 1.25},
        "flat": {"eye": [1, 2, 5], "target": [0, 1, 0], "orthographic": 3,
                 "keys": [{"frame": 1, "eye": [1, 2, 6]}, {"frame": 9.5, "target": [0, 0, 1]}]},
        "turning": {"orbit": [0, 15, 6], "target": [0, 1, 0], "up": [0, 1, 0.2], "interpolation": "smooth",
                    "keys": [{"frame": 1, "orbit": [0, 15, 6], "fov_y": 30}, {"frame": 25, "orbit": [360, 15, 6]}]}}})"},
    {"OneCameraInFog", R"({"ambient": [0.1, 0.1, 0.2],
      "camera": {"eye": [1, 2, 5], "target": [0, 1, 0], "keys": [{"frame": 1, "eye": [3, 2, 5], "fov_y": 50}]},
      "fog": {"mode": "linear", "start": 2, "end": 30, "color": [0.4, 0.5, 0.6], "distance": "radial"}})"},
    {"Fog",
     R"({"ambient": 1, "fog": {"mode": "exp2", "density": [0.1, 0.2, 0.3], "color": 0.5, "distance": "depth"}})"},
    {"LinearFog", R"({"ambient": 1, "fog": {"mode": "linear"}})"},
    {"Defaults",
     R"({"fog": {"mode": "exp"}, "objects": [{"name": "a name", "primitive": "torus", "segments": 4}],
      "lights": [{"type": "spot", "position": [0, 4, 0], "target": [0, 0, 0]}],
      "light_fields": [{"count": 2, "shape": "surface"}]})"},
    {"Materials", R"({"ambient": 1, "materials": {
      "all": {"ambient": 0.1, "diffuse": [0.5, 0.6, 0.7], "specular": 0.3, "emission": [0, 0, 0.5], "shininess": 32,
              "diffuse_map": "gone.png", "emission_map": "gone.png", "alpha_map": "gone.png", "alpha": 0.75,
              "alpha_cutoff": 0.5, "double_sided": true, "normal_map": "gone.png", "normal_scale": -2, "model": "toon"},
      "bumpy": {"bump_map": "gone.png", "blend": true, "alpha_cutoff": 0.25},
      "none": {}}})"},
    {"Objects", R"({"ambient": 1, "materials": {"red": {"diffuse": [1, 0, 0]}}, "objects": [
      {"primitive": "torus", "segments": 4, "minor_radius": 0.5, "uv_scale": 2, "material": "red", "scale": [1, -2, 3]},
      {"primitive": "plane", "segments": 1, "rotate": [0, 90, 0], "scale": 2},
      {"primitive": "cylinder", "segments": 3, "translate": [1, 2, 3], "interpolation": "linear",
       "keys": [{"frame": 1, "rotate": [0, 0, 0], "scale": 2}, {"frame": 9, "rotate": [0, 360, 0]},
                {"frame": 12, "translate": [0, 1, 0], "scale": [1, 2, 1]}]},
      {"primitive": "box"}, {"primitive": "cone", "segments": 3}, {"primitive": "sphere", "segments": 3},
      {"mesh": "t.gltf", "variant": "new", "animation": "spin", "lights": true, "cameras": true}, {"mesh": "t.gltf"},
      {"mesh": "t.obj", "material": "red", "translate": [1, 0, 0], "keys": [{"frame": 1, "translate": [2, 0, 0]}]}]})"},
    {"PointLights", R"({"lights": [
      {"type": "point", "position": [1, 2, 3], "color": [1, 0.8, 0.5], "intensity": 2, "attenuation": [1, 0, 0.5],
       "range": 8, "window": "khr", "shadow": true, "radius": 0.1, "enabled": false, "group": "key", "name": "lamp"},
      {"type": "point", "position": [1, 2, 3], "ambient": 0.1, "diffuse": [1, 0, 0], "specular": 0.5,
       "keys": [{"frame": 1, "position": [0, 0, 0], "intensity": 1}]},
      {"type": "point", "position": [1, 2, 3], "interpolation": "smooth",
       "keys": [{"frame": 1, "range": 3}, {"frame": 5, "color": [1, 1, 0.5], "range": 4}]}]})"},
    {"Suns", R"({"lights": [
      {"type": "directional", "direction": [0, -1, 0.5], "angle": 0.5, "shadow": true, "diffuse": 1},
      {"type": "directional", "direction": [0, -2, 0], "color": 0.5,
       "keys": [{"frame": 1, "direction": [0, -1, 0]}, {"frame": 9, "direction": [1, 0, 0], "color": 2}]}]})"},
    {"Spots", R"({"lights": [
      {"type": "spot", "position": [0, 4, 0], "direction": [0, -1, 0], "cutoff": 30, "exponent": 8,
       "keys": [{"frame": 1, "direction": [0, -1, 1]}]},
      {"type": "spot", "position": [0, 4, 0], "target": [0, 0, 0], "inner_cone": 10, "outer_cone": 20, "radius": 0.2,
       "keys": [{"frame": 1, "target": [1, 0, 0]}, {"frame": 2, "position": [0, 5, 0]}]},
      {"type": "spot", "position": [0, 4, 0], "target": [0, 0, 0], "cutoff": 180},
      {"type": "spot", "position": [0, 4, 0], "target": [0, 0, 0], "inner_cone": 10},
      {"type": "spot", "position": [0, 4, 0], "direction": [0, 0, 1], "outer_cone": 90}]})"},
    {"Skies", R"({"lights": [
      {"type": "environment", "image": "sky.ppm", "rotate": 30, "intensity": 2, "color": [1, 0.9, 0.8], "count": 16,
       "shadow": true, "group": "sky", "name": "sky",
       "keys": [{"frame": 1, "rotate": 0}, {"frame": 9, "rotate": 360, "intensity": 3, "color": 0.5}]}]})"},
    {"PlainSky", R"({"lights": [{"type": "environment", "image": "sky.ppm"}]})"},
    {"Faces", R"({"lights": [
      {"type": "rectangle", "position": [0, 3, 0], "direction": [0, -1, 0], "up": [1, 0, 0], "width": 2, "height": 0.5,
       "color": 4, "intensity": 2, "count": 8, "shadow": true, "group": "lamp", "name": "panel",
       "keys": [{"frame": 1, "position": [0, 2, 0]}, {"frame": 2, "direction": [0.1, -1, 0]}]},
      {"type": "disc", "position": [0, 3, 0], "direction": [0, -1, 0], "interpolation": "smooth",
       "keys": [{"frame": 1, "intensity": 0}, {"frame": 5, "color": 2}]},
      {"type": "disc", "position": [0, 3, 0], "direction": [1, 0, 0], "enabled": false}]})"},
    {"Glow",
     R"({"materials": {"lamp": {"emission": 3, "emits": 4}, "screen": {"emission": [1, 2, 3], "emits": false}},
      "objects": [{"primitive": "plane", "segments": 1, "material": "lamp"},
                  {"primitive": "box", "material": "screen", "emits": true}]})"},
    {"Profiles", R"({"lights": [
      {"type": "point", "position": [0, 4, 0], "profile": "lamp.ies", "up": [0, 0, 1], "lumens": 900, "intensity": 0.5,
       "keys": [{"frame": 1, "intensity": 1}]},
      {"type": "point", "position": [0, 4, 0], "profile": "lamp.ies", "direction": [0, -1, 1], "candela": 2,
       "keys": [{"frame": 1, "direction": [0, -1, 0]}]},
      {"type": "spot", "position": [0, 4, 0], "profile": "lamp.ies", "target": [0, 0, 0], "cutoff": 60},
      {"type": "point", "position": [0, 4, 0], "lumens": 800}]})"},
    {"LightFields", R"({"objects": [{"primitive": "plane", "segments": 1}], "light_fields": [
      {"count": 3, "seed": 7, "min": [0, 0, 0], "max": [1, 2, 3], "color": [1, 0.5, 0.2], "intensity": [1, 2], "range": [0.5, 1]},
      {"count": 3, "shape": "box", "min": [0, 0, 0], "max": [1, 1, 1], "colors": [1, [1, 0, 0]], "intensity": 2, "range": 2},
      {"count": 3, "shape": "ball", "center": [0, 1, 0], "radius": 2, "attenuation": [1, 1, 0], "shadow": true},
      {"count": 3, "shape": "sphere", "center": [0, 1, 0], "radius": 2},
      {"count": 3, "shape": "surface", "offset": -0.5, "cutoff": 0.01},
      {"count": 3, "min": [0, 0, 0], "max": [1, 1, 1], "no_range": true, "group": "key"},
      {"count": 3, "shape": "clusters", "clusters": 2, "min": [0, 0, 0], "max": [1, 1, 1], "radius": 0.5},
      {"count": 3, "shape": "curve", "points": [[0, 0, 0], [1, 1, 1], [2, 0, 0]], "radius": 0},
      {"csv": "lamps.csv", "count": 2, "seed": 1, "intensity": 3, "range": [1, 2], "attenuation": [0, 0, 1]},
      {"csv": "lamps.csv", "cutoff": 0.5}]})"},
};

inline const std::filesystem::path kScenesFolder = LUCIOLE_SOURCE_DIR "/scenes";

/// The project's scene files, by a name that fits a test's.
inline std::map<std::string, std::filesystem::path> sceneFiles() {
  std::map<std::string, std::filesystem::path> files;
  for (const auto& folder : {kScenesFolder, kScenesFolder / "lesson"}) {
    if (!std::filesystem::is_directory(folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const std::filesystem::path& path = entry.path();
      if (path.extension() != ".json" || path.stem().has_extension()) continue;  // scene.schema.json
      std::string name = folder == kScenesFolder ? "" : "lesson_";
      for (const char c : path.stem().string()) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
      files[name] = path;
    }
  }
  return files;
}

inline json parsedWithComments(const std::string& text) { return json::parse(text, nullptr, true, true); }

/// The first four of an array's elements that have each their own set of keys, or kind: a scene says nothing
/// new by hundreds of lights that are alike.
inline json fewOf(const json& array) {
  json few = json::array();
  std::set<std::string> seen;
  for (const json& element : array) {
    std::string kind;
    for (const auto& [key, value] : element.items()) kind += key + " ";
    for (const char* key : {"type", "primitive", "shape"})
      if (element.contains(key)) kind += element.at(key).dump();
    if (few.size() < 4 && seen.insert(kind).second) few.push_back(element);
  }
  return few;
}

/// A scene file with few lights, objects and keys, of meshes that cost no time.
inline json smallVersion(const std::filesystem::path& path) {
  json scene = parsedWithComments(test::readText(path.string()));
  for (const char* key : {"objects", "lights", "light_fields"})
    if (scene.contains(key)) scene[key] = fewOf(scene[key]);
  std::set<std::string> used;
  std::vector<json*> moving;
  for (const char* key : {"objects", "lights"})
    if (scene.contains(key))
      for (json& element : scene[key]) moving.push_back(&element);
  if (scene.contains("camera")) moving.push_back(&scene["camera"]);
  for (json* element : moving)
    if (element->contains("keys") && (*element)["keys"].size() > 2)
      (*element)["keys"].erase((*element)["keys"].begin() + 2, (*element)["keys"].end());
  for (json& object : scene.value("objects", json::array())) used.insert(object.value("material", ""));
  if (scene.contains("objects")) {
    for (json& object : scene["objects"]) {
      if (object.contains("mesh")) object["mesh"] = "t.obj";
      if (object.contains("primitive") && object["primitive"] != "box") object["segments"] = 4;
    }
  }
  if (scene.contains("light_fields"))
    for (json& field : scene["light_fields"])
      if (field.contains("csv")) field["csv"] = "lamps.csv";
  if (scene.contains("lights"))
    for (json& light : scene["lights"])
      for (const auto& [key, file] : {std::pair("image", "sky.ppm"), {"profile", "lamp.ies"}})
        if (light.contains(key)) light[key] = file;
  if (scene.contains("materials")) {
    json materials = json::object();
    for (const auto& [name, material] : scene["materials"].items()) {
      if (!used.contains(name)) continue;
      materials[name] = material;
      for (const char* map : {"diffuse_map", "emission_map", "normal_map", "bump_map", "alpha_map"})
        if (material.contains(map)) materials[name][map] = "gone.png";
    }
    scene["materials"] = materials;
  }
  return scene;
}

/// All of them by name: those above, and the project's, small.
inline const std::map<std::string, json>& smallScenes() {
  static const std::map<std::string, json> scenes = [] {
    std::map<std::string, json> all;
    for (const auto& [name, text] : kOwnScenes) all[name] = json::parse(text);
    for (const auto& [name, path] : sceneFiles()) all[name] = smallVersion(path);
    return all;
  }();
  return scenes;
}

inline std::vector<std::string> smallSceneNames() {
  std::vector<std::string> names;
  for (const auto& [name, text] : kOwnScenes) names.push_back(name);
  for (const auto& [name, path] : sceneFiles()) names.push_back(name);
  return names;
}
}  // namespace luciole::test
