#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include "luciole/error.hpp"
#include "scene/json/json_scene.hpp"
#include "scene/profiles/profile_files.hpp"
#include "scene/small_scenes.hpp"
#include "shared_files.hpp"

namespace luciole::test {

/// A rule that only the program knows: what its message says, why a schema can't, and a scene that the schema
/// lets pass.
struct LoadersRule {
  const char* message;
  const char* why;
  const char* scene;
};

/// What compares two values of a file, or looks beyond it. Changed scenes may break these.
inline constexpr LoadersRule kLoadersRules[]{
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
    {"has no variant", "reads another file", R"({"objects": [{"mesh": "t.gltf", "variant": "worn"}]})"},
    {"has no animation", "reads another file", R"({"objects": [{"mesh": "t.gltf", "animation": "walk"}]})"},
    {"is parallel to the direction", "compares two directions",
     R"({"lights": [{"type": "disc", "position": [0,0,0], "direction": [0,-1,0], "up": [0,2,0]}]})"},
    {"up is parallel to its direction", "compares two directions",
     R"({"lights": [{"type": "disc", "position": [0,0,0], "direction": [0,-1,0], "up": [1,0,0],
                     "keys": [{"frame": 1, "direction": [1,0,0]}]}]})"},
    {"a second environment", "counts elements",
     R"({"lights": [{"type": "environment", "image": "sky.ppm"}, {"type": "environment", "image": "sky.ppm"}]})"},
    {"nothing of the object has an emission", "looks a material up",
     R"({"objects": [{"primitive": "plane", "emits": true}]})"},
    {"there is no file", "looks at the disk", R"({"objects": [{"mesh": "gone.obj"}]})"},
    {"is a folder; expected a file", "looks at the disk", R"({"light_fields": [{"csv": "."}]})"},
    {"lights, expected", "reads another file", R"({"light_fields": [{"csv": "lamps.csv", "count": 4}]})"},
};

/// What is lost where a number becomes a float. Changed scenes keep away from these
/// numbers, and so from the bounds themselves by a millionth.
inline constexpr LoadersRule kRoundings[]{
    {"all 0", "a float has no number above 0 that is as small",
     R"({"lights": [{"type": "point", "position": [0,0,0], "attenuation": [0,0,1e-60]}]})"},
    {"expected less than 1, the major radius", "as a float it is 1",
     R"({"objects": [{"primitive": "torus", "minor_radius": 0.99999999}]})"},
};
inline const json& schemaText() {
  static const json text = json::parse(readText((kScenesFolder / "scene.schema.json").string()));
  return text;
}
/// Calls visit(node) for every object and array of the schema, the schema included.
inline void eachSchemaNode(const json& node, const std::function<void(const json&)>& visit) {
  visit(node);
  for (const json& member : node)
    if (member.is_structured()) eachSchemaNode(member, visit);
}
/// The value as a JSON Schema sees numbers: 8.0 is an integer. Valijson takes what was written with a point
/// or an exponent for no integer, and integers from 2^63 on for negative ones, so they become doubles.
inline json asSchemasSeeIt(json value) {
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
using Place = json::json_pointer;

inline void addPlaces(const json& value, const Place& place, std::vector<Place>& places) {
  places.push_back(place);
  if (value.is_object())
    for (const auto& [key, member] : value.items()) addPlaces(member, place / key, places);
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i) addPlaces(value[i], place / i, places);
}

/// Every place in a value, its own included.
inline std::vector<Place> placesIn(const json& scene) {
  std::vector<Place> places;
  addPlaces(scene, Place(), places);
  return places;
}

/// The two that judge a scene file: the schema and the loader.
class Judges {
 public:
  Judges() {
    for (const char* name : {"t.obj", "t.OBJ", ".obj", "t.obj.txt"})
      std::ofstream(folder_ / name) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    // Numbers that no buffer holds are 0: a triangle without area, and an animation with one key.
    std::ofstream(folder_ / "t.gltf") << R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"componentType": 5126, "count": 3, "type": "VEC3"},
                      {"componentType": 5126, "count": 1, "type": "SCALAR"},
                      {"componentType": 5126, "count": 1, "type": "VEC3"}],
        "animations": [{"name": "spin", "samplers": [{"input": 1, "output": 2}],
                        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
        "extensions": {"KHR_materials_variants": {"variants": [{"name": "new"}]}}})";
    std::ofstream(folder_ / "sky.ppm") << "P3 2 1 255 255 255 255 128 128 128\n";
    std::ofstream(folder_ / "lamp.ies") << iesText({});
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
    return parseJsonScene(text, "scene.json", {folder_.path().string()});
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
  TemporaryFolder folder_;
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
}  // namespace luciole::test
