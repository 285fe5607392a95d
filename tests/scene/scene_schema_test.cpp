// scenes/scene.schema.json and the program agree on which scene files are right, and on what is there by
// default.
#include <gtest/gtest.h>

#include "shared_files.hpp"

#if !__has_include(<valijson/adapters/nlohmann_json_adapter.hpp>)

TEST(SceneSchema, AgreesWithTheLoader) {
  if (std::getenv("LUCIOLE_SHARED") && !luciole::test::packageIsUnavailable("libvalijson-dev"))
    FAIL() << "built without valijson (apt install libvalijson-dev)";
  GTEST_SKIP() << "needs valijson when it is built (apt install libvalijson-dev)";
}

#else

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include "base/error.hpp"
#include "scene/json/json_scene.hpp"
#include "scene/lights/light_field.hpp"
#include "scene/scene_digest.hpp"

namespace luciole {
namespace {

using nlohmann::json;
using Place = json::json_pointer;

/// A rule that only the program knows: what its message says, why a schema can't, and a scene that the schema
/// lets pass.
struct LoadersRule {
  const char* message;
  const char* why;
  const char* scene;
};

/// What compares two values of a file, or looks beyond it. Changed scenes may break these.
constexpr LoadersRule kLoadersRules[]{
    {"isn't beyond near", "compares two numbers",
     R"({"camera": {"eye": [0,0,5], "target": [0,0,0], "near": 5, "far": 4}})"},
    {"eye and target are the same point", "compares two points",
     R"({"camera": {"eye": [0,0,5], "target": [0,0,5]}})"},
    {"up is parallel to the view", "compares two directions",
     R"({"camera": {"eye": [0,0,5], "target": [0,0,0], "up": [0,0,1]}})"},
    {"expected a frame after", "compares two numbers",
     R"({"objects": [{"primitive": "box", "keys": [{"frame": 2, "scale": 1}, {"frame": 2, "scale": 2}]}]})"},
    {"isn't smaller than outer_cone", "compares two numbers",
     R"({"lights": [{"type": "spot", "position": [0,0,0], "direction": [0,-1,0], "inner_cone": 50}]})"},
    {"is the light's position", "compares two points",
     R"({"lights": [{"type": "spot", "position": [1,2,3], "target": [1,2,3]}]})"},
    {"is above that of \"max\"", "compares two points",
     R"({"light_fields": [{"count": 1, "min": [0,0,2], "max": [1,1,1]}]})"},
    {"is above the highest", "compares two numbers",
     R"({"light_fields": [{"count": 1, "min": [0,0,0], "max": [1,1,1], "range": [3,2]}]})"},
    {"start and end are the same distance", "compares two numbers",
     R"({"fog": {"mode": "linear", "end": 0}})"},
    {"shorter than 1e-18", "adds squares up",
     R"({"lights": [{"type": "directional", "direction": [1e-19,0,0]}]})"},
    {"lights up to here", "adds numbers up",
     R"({"light_fields": [{"count": 100000000, "shape": "surface"}, {"count": 1, "shape": "surface"}]})"},
    {"no material is called", "looks a name up",
     R"({"objects": [{"primitive": "box", "material": "gold"}]})"},
    {"there is no file", "looks at the disk", R"({"objects": [{"mesh": "gone.obj"}]})"},
    {"is a folder; expected a file", "looks at the disk", R"({"light_fields": [{"csv": "."}]})"},
    {"lights, expected", "reads another file", R"({"light_fields": [{"csv": "lamps.csv", "count": 4}]})"},
};

/// What is lost where a number becomes a float. Changed scenes keep away from these
/// numbers, and so from the bounds themselves by a millionth.
constexpr LoadersRule kRoundings[]{
    {"all 0", "a float has no number above 0 that is as small",
     R"({"lights": [{"type": "point", "position": [0,0,0], "attenuation": [0,0,1e-60]}]})"},
    {"expected less than 1, the major radius", "as a float it is 1",
     R"({"objects": [{"primitive": "torus", "minor_radius": 0.99999999}]})"},
};

/// Scenes that between them use every key.
constexpr std::pair<const char*, const char*> kOwnScenes[]{
    {"Cameras",
     R"({"$schema": "scene.schema.json", "size": [64, 36], "background": [0.1, 0.2, 0.3], "ambient": 0.5,
      "lighting": true, "frame_rate": 25,
      "cameras": {
        "still": {"eye": [1, 2, 5], "target": [0, 1, 0], "up": [0.1, 1, 0], "fov_y": 40, "near": 0.5, "far": 60},
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
    {"Defaults", R"({"fog": {"mode": "exp"}, "objects": [{"primitive": "torus", "segments": 4}],
      "lights": [{"type": "spot", "position": [0, 4, 0], "target": [0, 0, 0]}],
      "light_fields": [{"count": 2, "shape": "surface"}]})"},
    {"Materials", R"({"ambient": 1, "materials": {
      "all": {"ambient": 0.1, "diffuse": [0.5, 0.6, 0.7], "specular": 0.3, "emission": [0, 0, 0.5], "shininess": 32,
              "diffuse_map": "gone.png", "emission_map": "gone.png", "alpha_map": "gone.png", "alpha": 0.75,
              "alpha_cutoff": 0.5, "double_sided": true},
      "none": {}}})"},
    {"Objects", R"({"ambient": 1, "materials": {"red": {"diffuse": [1, 0, 0]}}, "objects": [
      {"primitive": "torus", "segments": 4, "minor_radius": 0.5, "uv_scale": 2, "material": "red", "scale": [1, -2, 3]},
      {"primitive": "plane", "segments": 1, "rotate": [0, 90, 0], "scale": 2},
      {"primitive": "cylinder", "segments": 3, "translate": [1, 2, 3], "interpolation": "linear",
       "keys": [{"frame": 1, "rotate": [0, 0, 0], "scale": 2}, {"frame": 9, "rotate": [0, 360, 0]},
                {"frame": 12, "translate": [0, 1, 0], "scale": [1, 2, 1]}]},
      {"primitive": "box"}, {"primitive": "cone", "segments": 3}, {"primitive": "sphere", "segments": 3},
      {"mesh": "t.obj", "material": "red", "translate": [1, 0, 0], "keys": [{"frame": 1, "translate": [2, 0, 0]}]}]})"},
    {"PointLights", R"({"lights": [
      {"type": "point", "position": [1, 2, 3], "color": [1, 0.8, 0.5], "intensity": 2, "attenuation": [1, 0, 0.5],
       "range": 8, "shadow": true, "radius": 0.1, "enabled": false},
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
    {"LightFields", R"({"objects": [{"primitive": "plane", "segments": 1}], "light_fields": [
      {"count": 3, "seed": 7, "min": [0, 0, 0], "max": [1, 2, 3], "color": [1, 0.5, 0.2], "intensity": [1, 2], "range": [0.5, 1]},
      {"count": 3, "shape": "box", "min": [0, 0, 0], "max": [1, 1, 1], "colors": [1, [1, 0, 0]], "intensity": 2, "range": 2},
      {"count": 3, "shape": "ball", "center": [0, 1, 0], "radius": 2, "attenuation": [1, 1, 0], "shadow": true},
      {"count": 3, "shape": "sphere", "center": [0, 1, 0], "radius": 2},
      {"count": 3, "shape": "surface", "offset": -0.5, "cutoff": 0.01},
      {"count": 3, "shape": "clusters", "clusters": 2, "min": [0, 0, 0], "max": [1, 1, 1], "radius": 0.5},
      {"count": 3, "shape": "curve", "points": [[0, 0, 0], [1, 1, 1], [2, 0, 0]], "radius": 0},
      {"csv": "lamps.csv", "count": 2, "seed": 1, "intensity": 3, "range": [1, 2], "attenuation": [0, 0, 1]},
      {"csv": "lamps.csv", "cutoff": 0.5}]})"},
};

const std::filesystem::path kScenesFolder = LUCIOLE_SOURCE_DIR "/scenes";

/// The project's scene files, by a name that fits a test's.
std::map<std::string, std::filesystem::path> sceneFiles() {
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

json parsedWithComments(const std::string& text) { return json::parse(text, nullptr, true, true); }

/// The first four of an array's elements that have each their own set of keys, or kind: a scene says nothing
/// new by hundreds of lights that are alike.
json fewOf(const json& array) {
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
json smallVersion(const std::filesystem::path& path) {
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
  if (scene.contains("materials")) {
    json materials = json::object();
    for (const auto& [name, material] : scene["materials"].items()) {
      if (!used.contains(name)) continue;
      materials[name] = material;
      for (const char* map : {"diffuse_map", "emission_map", "alpha_map"})
        if (material.contains(map)) materials[name][map] = "gone.png";
    }
    scene["materials"] = materials;
  }
  return scene;
}

const std::map<std::string, json>& smallScenes() {
  static const std::map<std::string, json> scenes = [] {
    std::map<std::string, json> all;
    for (const auto& [name, text] : kOwnScenes) all[name] = json::parse(text);
    for (const auto& [name, path] : sceneFiles()) all[name] = smallVersion(path);
    return all;
  }();
  return scenes;
}

std::vector<std::string> smallSceneNames() {
  std::vector<std::string> names;
  for (const auto& [name, text] : kOwnScenes) names.push_back(name);
  for (const auto& [name, path] : sceneFiles()) names.push_back(name);
  return names;
}

const json& schemaText() {
  static const json text = json::parse(test::readText((kScenesFolder / "scene.schema.json").string()));
  return text;
}

/// The value as a JSON Schema sees numbers: 8.0 is an integer. Valijson takes what was written with a point
/// or an exponent for no integer, and integers from 2^63 on for negative ones, so they become doubles.
json asSchemasSeeIt(json value) {
  if (value.is_structured()) {
    for (json& member : value) member = asSchemasSeeIt(std::move(member));
  } else if (value.is_number_unsigned() && value.get<std::uint64_t>() > std::uint64_t{INT64_MAX}) {
    value = value.get<double>();
  } else if (value.is_number_float()) {
    const double number = value.get<double>();
    if (std::abs(number) <= 0x1p53 && number == std::floor(number)) value = static_cast<std::int64_t>(number);
  }
  return value;
}

class Judges {
 public:
  Judges() {
    for (const char* name : {"t.obj", "t.OBJ", ".obj", "t.obj.txt"})
      std::ofstream(folder_ / name) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::ofstream(folder_ / "lamps.csv") << "1,2,3,1,1,1,4\n5,6,7,1,1,1,\n8,9,10,1,1,1,\n";
    const json text = asSchemasSeeIt(schemaText());
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(valijson::adapters::NlohmannJsonAdapter(text), schema_);
  }

  /// `scene` must have passed asSchemasSeeIt().
  bool schemaAccepts(const json& scene) {
    return validator_.validate(schema_, valijson::adapters::NlohmannJsonAdapter(scene), nullptr);
  }
  SceneFile load(const std::string& text) const {
    return parseJsonScene(text, "scene.json", folder_.path().string());
  }
  /// What the loader says against a text; empty: nothing.
  std::string refusal(const std::string& text) const {
    try {
      load(text);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }

 private:
  test::TemporaryFolder folder_;
  valijson::Schema schema_;
  valijson::Validator validator_;
};

/// Takes both verdicts on texts, and fails where they differ.
class Court {
 public:
  /// `seen`: what the text says, by asSchemasSeeIt().
  void hear(const json& seen, const std::string& text) {
    ++heard_;
    const bool schema_accepts = judges_.schemaAccepts(seen);
    const std::string refusal = judges_.refusal(text);
    const bool is_loaders_rule =
        std::any_of(std::begin(kLoadersRules), std::end(kLoadersRules),
                    [&](const LoadersRule& rule) { return refusal.find(rule.message) != std::string::npos; });
    accepted_ += refusal.empty();
    if (schema_accepts == refusal.empty() || (schema_accepts && is_loaders_rule)) return;
    if (++differences_ <= 10)
      ADD_FAILURE() << "the schema " << (schema_accepts ? "accepts" : "refuses") << " and the loader "
                    << (refusal.empty() ? "accepts" : "refuses: " + refusal) << "\n"
                    << text.substr(0, 3000);
  }

  /// Fails if nothing was at stake: of many changes some are fine and most are not.
  void close(int fewest) const {
    EXPECT_GE(heard_, fewest);
    EXPECT_GE(accepted_, heard_ / 100);
    EXPECT_LE(accepted_, heard_ - heard_ / 4);
    EXPECT_EQ(differences_, 0) << "of " << heard_;
    testing::Test::RecordProperty("verdicts", heard_);
  }

 private:
  Judges judges_;
  int heard_ = 0, accepted_ = 0, differences_ = 0;
};

/// Calls visit(node) for every object and array of the schema, the schema included.
void eachSchemaNode(const json& node, const std::function<void(const json&)>& visit) {
  visit(node);
  for (const json& member : node)
    if (member.is_structured()) eachSchemaNode(member, visit);
}

/// A new value: what it is by asSchemasSeeIt(), and its text, if that isn't what the value is written as.
struct NewValue {
  json seen;
  std::string text;
};

/// What values are changed into.
struct Pool {
  std::vector<NewValue> numbers, texts, others;
  std::map<std::string, std::vector<json> > members;  ///< for each key of the schema some of its values
};

void addNumber(Pool& pool, double number) { pool.numbers.push_back({asSchemasSeeIt(number), ""}); }

const Pool& pool() {
  static const Pool filled = [] {
    Pool result;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    result.numbers = {
        {kInfinity, "1e999"}, {-kInfinity, "-1e999"}, {100, "100.0"}, {100, "1e2"}, {3, "3.0"}, {0, "-0"},
        {0, "-0.0"}};
    for (const double number : {0.5, 2.0, 45.0, -7.0, 1e9, 1e30}) addNumber(result, number);
    std::set<double> bounds;
    std::set<std::string> texts{"", "red", "still", "gone.gltf", "sub/gone.obj"};
    eachSchemaNode(schemaText(), [&](const json& node) {
      if (!node.is_object()) return;
      for (const char* key : {"minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"})
        if (node.contains(key) && node[key].is_number()) bounds.insert(node[key].get<double>());
      if (!node.contains("const")) return;
      if (node["const"].is_number()) bounds.insert(node["const"].get<double>());
      if (!node["const"].is_string()) return;
      const std::string word = node["const"];
      texts.insert(
          {word, word + "s", word.substr(1), static_cast<char>(std::toupper(word[0])) + word.substr(1)});
    });
    bounds.erase(0x1p64);  // the seed's: see TheLargestSeedIsTheLoaders
    for (const double bound : bounds) {
      const double step = bound == 0 ? 1e-12 : bound * 1e-6;
      for (const double number : {bound, bound - step, bound + step, -bound, bound + 1, bound - 1})
        addNumber(result, number);
    }
    for (const std::string& text : texts) result.texts.push_back({text, ""});
    for (const char* other :
         {"null", "true", "false", "7", "\"text\"", "[]", "{}", "[1,2,3]", "[1,2]", "[0,0,0]", "[1,2,3,4]",
          R"([1,"2",3])", R"([[1,2,3]])", R"({"frame":3})", R"([{"frame":3}])"})
      result.others.push_back({json::parse(other), ""});
    const std::function<void(const json&)> addMembers = [&](const json& value) {
      if (value.is_object())
        for (const auto& [key, member] : value.items()) {
          std::vector<json>& values = result.members[key];
          if (values.size() < 3 && std::find(values.begin(), values.end(), member) == values.end())
            values.push_back(member);
        }
      if (value.is_structured())
        for (const json& member : value) addMembers(member);
    };
    for (const auto& [name, text] : kOwnScenes) addMembers(asSchemasSeeIt(json::parse(text)));
    return result;
  }();
  return filled;
}

void addChangedObject(const json& object, std::vector<NewValue>& changed) {
  for (const auto& [key, value] : object.items()) {
    json without = object;
    without.erase(key);
    changed.push_back({without, ""});
    for (const std::string& renamed :
         {key + "s", key.substr(1), static_cast<char>(std::toupper(key[0])) + key.substr(1)}) {
      json other = without;
      other[renamed] = value;
      changed.push_back({other, ""});
    }
  }
  for (const auto& [key, values] : pool().members) {
    for (const json& value : values) {
      if (object.contains(key) && object[key] == value) continue;
      json other = object;
      other[key] = value;
      changed.push_back({other, ""});
    }
  }
}

void addChangedArray(const json& array, std::vector<NewValue>& changed) {
  for (std::size_t i = 0; i < array.size(); ++i) {
    json shorter = array, doubled = array;
    shorter.erase(i);
    doubled.insert(doubled.begin() + static_cast<std::ptrdiff_t>(i), array[i]);
    changed.push_back({shorter, ""});
    changed.push_back({doubled, ""});
  }
  json longer = array, reversed = array;
  longer.push_back(nullptr);
  std::reverse(reversed.begin(), reversed.end());
  changed.push_back({longer, ""});
  changed.push_back({reversed, ""});
}

/// What one value of a scene is changed into.
std::vector<NewValue> changesOf(const json& value) {
  std::vector<NewValue> changed = pool().others;
  const auto append = [&](const std::vector<NewValue>& values) {
    changed.insert(changed.end(), values.begin(), values.end());
  };
  if (value.is_number()) append(pool().numbers);
  if (value.is_string()) append(pool().texts);
  if (value.is_array()) addChangedArray(value, changed);
  if (value.is_object()) addChangedObject(value, changed);
  return changed;
}

void addPlaces(const json& value, const Place& place, std::vector<Place>& places) {
  places.push_back(place);
  if (value.is_object())
    for (const auto& [key, member] : value.items()) addPlaces(member, place / key, places);
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i) addPlaces(value[i], place / i, places);
}

std::vector<Place> placesIn(const json& scene) {
  std::vector<Place> places;
  addPlaces(scene, Place(), places);
  return places;
}

/// Whether no mesh in the scene is of so many segments that making it takes long. Cylinders are tried with
/// the most.
bool isQuick(const json& scene) {
  if (!scene.is_object() || !scene.contains("objects") || !scene["objects"].is_array()) return true;
  for (const json& object : scene["objects"]) {
    if (!object.is_object() || !object.contains("segments") || !object["segments"].is_number()) continue;
    if (object["segments"] > 64 && object["segments"] <= 4096 &&
        object.value("primitive", json()) != "cylinder")
      return false;
  }
  return true;
}

/// Hears the case of a scene, of which one value has been replaced.
void hearChanged(json& scene, const Place& place, const NewValue& value, Court& court) {
  constexpr const char* kMark = "written otherwise";
  json old = std::exchange(scene[place], value.seen);
  if (isQuick(scene)) {
    std::string text;
    if (value.text.empty()) {
      text = scene.dump();
    } else {
      scene[place] = kMark;
      text = scene.dump();
      text.replace(text.find(kMark) - 1, std::string_view(kMark).size() + 2, value.text);
      scene[place] = value.seen;
    }
    court.hear(scene, text);
  }
  scene[place] = std::move(old);
}

class SceneSchemaOf : public testing::TestWithParam<std::string> {
 protected:
  static json scene() { return asSchemasSeeIt(smallScenes().at(GetParam())); }
};
INSTANTIATE_TEST_SUITE_P(Scenes, SceneSchemaOf, testing::ValuesIn(smallSceneNames()),
                         [](const auto& tested) { return tested.param; });

TEST_P(SceneSchemaOf, AgreesWithTheLoaderOnEveryChangeOfOneValue) {
  Court court;
  json changing = scene();
  for (const Place& place : placesIn(changing)) {
    const std::vector<NewValue> values = changesOf(changing[place]);
    for (const NewValue& value : values) hearChanged(changing, place, value, court);
  }
  court.close(500);
}

/// A linear congruential generator (Numerical Recipes'), the same everywhere.
struct Lots {
  std::uint32_t state;
  std::size_t draw(std::size_t below) {
    state = state * 1664525u + 1013904223u;
    return static_cast<std::size_t>((std::uint64_t{state} * below) >> 32);
  }
};

TEST_P(SceneSchemaOf, AgreesWithTheLoaderOnChangesOfTwoValues) {
  Court court;
  const json unchanged = scene();
  Lots lots{17};
  for (int i = 0; i < 2000; ++i) {
    json changing = unchanged;
    for (const int last : {0, 1}) {
      const std::vector<Place> places = placesIn(changing);
      const Place place = places[lots.draw(places.size())];
      const std::vector<NewValue> values = changesOf(changing[place]);
      const NewValue& value = values[lots.draw(values.size())];
      if (last)
        hearChanged(changing, place, value, court);
      else
        changing[place] = value.text.empty() ? value.seen : json(0);
    }
  }
  court.close(1000);
}

/// The schema's keys: each with the definition that it is a key of.
using SchemaKey = std::pair<const json*, std::string>;
std::map<SchemaKey, const json*> schemaKeys() {
  std::map<SchemaKey, const json*> keys;
  const auto add = [&](const json& definition) {
    for (const auto& [key, value] : definition["properties"].items()) keys[{&definition, key}] = &value;
  };
  add(schemaText());
  for (const json& definition : schemaText()["definitions"])
    if (definition.contains("properties")) add(definition);
  return keys;
}

/// All words of the loader's that may be keys.
std::set<std::string> loadersWords() {
  std::set<std::string> words;
  const std::regex quoted("\"(\\$?[a-z][a-z_0-9]*)\"");
  for (const auto& entry : std::filesystem::directory_iterator(LUCIOLE_SOURCE_DIR "/host/scene/json")) {
    const std::string text = test::readText(entry.path().string());
    for (auto i = std::sregex_iterator(text.begin(), text.end(), quoted); i != std::sregex_iterator(); ++i)
      words.insert((*i)[1]);
  }
  return words;
}

TEST(SceneSchema, KnowsEveryKeyThatTheLoaderKnows) {
  const std::set<std::string> words = loadersWords();
  for (const auto& [key, value] : schemaKeys()) EXPECT_TRUE(words.contains(key.second)) << key.second;
  Judges judges;
  int known = 0;
  for (const auto& [name, text] : kOwnScenes) {
    json scene = json::parse(text);
    for (const Place& place : placesIn(scene)) {
      if (!scene[place].is_object()) continue;
      for (const std::string& word : words) {
        if (scene[place].contains(word)) continue;
        scene[place][word] = nullptr;
        if (judges.refusal(scene.dump()).find("unknown key") == std::string::npos) {
          ++known;
          for (const char* value : {"0.5", "7", "true", "\"text\"", "[1,2,3]", "[1,2]", "{}", "[]"}) {
            scene[place][word] = json::parse(value);
            EXPECT_TRUE(!judges.refusal(scene.dump()).empty() || judges.schemaAccepts(asSchemasSeeIt(scene)))
                << scene;
          }
        }
        scene[place].erase(word);
      }
    }
  }
  EXPECT_GT(known, 100);
}

TEST(SceneSchema, EveryRuleThatOnlyTheLoaderKnowsHasItsExample) {
  Judges judges;
  for (const auto& rules :
       {std::span<const LoadersRule>(kLoadersRules), std::span<const LoadersRule>(kRoundings)}) {
    for (const LoadersRule& rule : rules) {
      EXPECT_TRUE(judges.schemaAccepts(asSchemasSeeIt(json::parse(rule.scene)))) << rule.scene;
      EXPECT_NE(judges.refusal(rule.scene).find(rule.message), std::string::npos)
          << rule.scene << "\n"
          << rule.why << "\n"
          << judges.refusal(rule.scene);
    }
  }
}

TEST(SceneSchema, KnowsMeshFilesByTheirNamesAsTheLoaderDoes) {
  Court court;
  for (const char* name :
       {"t.obj", "t.OBJ", "./t.obj", "t.obj.txt", ".obj", "./.obj", "lamps.csv", "t.obj/", "t.obj "}) {
    const json scene{{"objects", {{{"mesh", name}}}}};
    court.hear(scene, scene.dump());
  }
  court.close(9);
}

TEST(SceneSchema, TheLargestSeedIsTheLoaders) {
  const json& seed = schemaText()["definitions"]["light_field"]["properties"]["seed"];
  EXPECT_EQ(seed["minimum"], 0);
  EXPECT_EQ(seed["maximum"].get<std::uint64_t>(), std::numeric_limits<std::uint64_t>::max());
  const auto scene = [](const std::string& number) {
    return R"({"light_fields": [{"count": 1, "shape": "surface", "seed": )" + number + "}]}";
  };
  const Judges judges;
  EXPECT_EQ(judges.refusal(scene("18446744073709551615")), "");
  EXPECT_NE(judges.refusal(scene("18446744073709551616")), "");
  // The schema's words say so: by its rules this is a whole number too, as its digits are.
  EXPECT_NE(judges.refusal(scene("1e16")), "");
}

TEST(SceneSchema, EverySceneOfTheProjectIsRight) {
  Judges judges;
  const auto files = sceneFiles();
  EXPECT_GE(files.size(), 6u);
  for (const auto& [name, path] : files)
    EXPECT_TRUE(judges.schemaAccepts(asSchemasSeeIt(parsedWithComments(test::readText(path.string())))))
        << path;
  for (const auto& [name, scene] : smallScenes()) {
    EXPECT_TRUE(judges.schemaAccepts(asSchemasSeeIt(scene))) << name;
    EXPECT_EQ(judges.refusal(scene.dump()), "") << name;
  }
}

TEST(SceneSchema, EveryExampleOfItsPageIsRight) {
  Judges judges;
  const std::string page = test::readText((kScenesFolder / "FORMATS.md").string());
  int examples = 0;
  constexpr std::string_view kBegin = "```json\n";
  for (std::size_t at = page.find(kBegin); at != std::string::npos;
       at = page.find(kBegin, at + 1), ++examples) {
    const std::size_t begin = at + kBegin.size();
    const std::string text = page.substr(begin, page.find("```", begin) - begin);
    EXPECT_TRUE(judges.schemaAccepts(asSchemasSeeIt(parsedWithComments(text)))) << text;
    EXPECT_EQ(judges.refusal(text), "") << text;
  }
  EXPECT_GE(examples, 1);
}

/// Calls visit(definition, object) for each object of a scene that the schema has keys for.
void eachObject(const json& node, json& value, const std::function<void(const json&, json&)>& visit) {
  const std::string reference = node.value("$ref", "");
  const json& definition = reference.empty() ? node : schemaText().at(Place(reference.substr(1)));
  if (value.is_object()) {
    if (definition.contains("properties")) visit(definition, value);
    for (auto& [key, member] : value.items()) {
      if (definition.contains("properties") && definition["properties"].contains(key))
        eachObject(definition["properties"][key], member, visit);
      else if (definition.contains("additionalProperties") && definition["additionalProperties"].is_object())
        eachObject(definition["additionalProperties"], member, visit);
    }
  }
  if (value.is_array() && definition.contains("items") && definition["items"].is_object())
    for (json& element : value) eachObject(definition["items"], element, visit);
}

TEST(SceneSchema, TheseTestsUseEveryKey) {
  std::set<SchemaKey> used;
  for (auto [name, scene] : smallScenes())
    eachObject(schemaText(), scene, [&](const json& definition, json& object) {
      for (const auto& [key, value] : object.items()) used.insert({&definition, key});
    });
  for (const auto& [key, value] : schemaKeys())
    EXPECT_TRUE(used.contains(key)) << key.first->at("title") << " " << key.second;
  RecordProperty("keys", static_cast<int>(schemaKeys().size()));
}

/// Of what kind a key's values are, through what it refers to.
bool holdsNumbers(const json& schema) {
  bool found = false;
  eachSchemaNode(schema, [&](const json& node) {
    if (!node.is_object()) return;
    if (node.value("type", json()) == "number" || node.value("type", json()) == "integer") found = true;
    const std::string reference = node.value("$ref", "");
    if (reference.empty()) return;
    const json& definition = schemaText().at(Place(reference.substr(1)));
    if (!definition.contains("properties")) found = found || holdsNumbers(definition);
  });
  return found;
}

TEST(SceneSchema, EveryKeyHasADescriptionWithItsUnitADefaultAndARange) {
  const std::regex unit(
      "metre|degree|linear|pixel|1/m|factor|exponent|number|[Ff]rame|opacity|how (many|often)|any length",
      std::regex::icase);
  for (const auto& [key, value] : schemaKeys()) {
    const std::string name = key.first->at("title").get<std::string>() + ": " + key.second;
    const std::string description = value->value("description", "");
    EXPECT_FALSE(description.empty()) << name;
    EXPECT_TRUE(!holdsNumbers(*value) || std::regex_search(description, unit)) << name << ": no unit";
    const json required = key.first->value("required", json::array());
    const bool is_required = std::find(required.begin(), required.end(), key.second) != required.end();
    const bool says_without = description.find("Without it, ") != std::string::npos;
    EXPECT_EQ(is_required + value->contains("default") + says_without, 1)
        << name << ": needed, or what if it isn't there?";
  }
  eachSchemaNode(schemaText(), [](const json& node) {
    if (!node.is_object()) return;
    const json type = node.value("type", json());
    if (type == "number" || type == "integer") {
      EXPECT_TRUE(node.contains("minimum") || node.contains("exclusiveMinimum")) << node;
      EXPECT_TRUE(node.contains("maximum") || node.contains("exclusiveMaximum")) << node;
    }
    if (type == "object" && node.contains("properties")) {
      EXPECT_EQ(node.value("additionalProperties", json()), false) << node;
    }
  });
}

/// A hash of the scene that a text makes, with its light fields.
std::uint64_t digestOf(const Judges& judges, const json& text) {
  SceneFile file = judges.load(text.dump());
  for (const LightField& field : file.light_fields) expandLightField(field, file.scene);
  return sceneDigest(file.scene);
}

TEST(SceneSchema, DefaultsAreTheLoaders) {
  Judges judges;
  std::set<SchemaKey> tried;
  for (const auto& entry : smallScenes()) {
    json scene = entry.second;
    const std::uint64_t digest = digestOf(judges, scene);
    eachObject(schemaText(), scene, [&](const json& definition, json& object) {
      for (const auto& [key, schema] : definition["properties"].items()) {
        if (!schema.contains("default") || object.contains(key)) continue;
        object[key] = schema["default"];
        if (judges.schemaAccepts(asSchemasSeeIt(scene))) {
          tried.insert({&definition, key});
          EXPECT_EQ(digestOf(judges, scene), digest)
              << entry.first << ": " << definition["title"] << " " << key;
        }
        object.erase(key);
      }
    });
  }
  for (const auto& [key, value] : schemaKeys())
    EXPECT_TRUE(!value->contains("default") || tried.contains(key))
        << key.first->at("title") << " " << key.second;
}

}  // namespace
}  // namespace luciole

#endif
