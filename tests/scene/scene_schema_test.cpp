// scenes/scene.schema.json says of each key what the program does with it: its unit, its range, what is there
// by default.
#include <gtest/gtest.h>

#include "shared_files.hpp"

#if !__has_include(<valijson/adapters/nlohmann_json_adapter.hpp>)

TEST(SceneSchema, AgreesWithTheLoader) {
  if (std::getenv("LUCIOLE_SHARED") && !luciole::test::packageIsUnavailable("libvalijson-dev"))
    FAIL() << "built without valijson (apt install libvalijson-dev)";
  GTEST_SKIP() << "needs valijson when it is built (apt install libvalijson-dev)";
}

#else

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

#include "scene/lights/light_field.hpp"
#include "scene/scene_digest.hpp"
#include "scene/schema_judges.hpp"

namespace luciole::test {
namespace {

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
    const std::string text = readText(entry.path().string());
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
    EXPECT_TRUE(judges.schemaAccepts(asSchemasSeeIt(parsedWithComments(readText(path.string()))))) << path;
  for (const auto& [name, scene] : smallScenes()) {
    EXPECT_TRUE(judges.schemaAccepts(asSchemasSeeIt(scene))) << name;
    EXPECT_EQ(judges.refusal(scene.dump()), "") << name;
  }
}

TEST(SceneSchema, EveryExampleOfItsPageIsRight) {
  Judges judges;
  const std::string page = readText((kScenesFolder / "FORMATS.md").string());
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
}  // namespace luciole::test

#endif
