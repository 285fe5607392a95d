// Scene files changed in one value or two: scenes/scene.schema.json and the program agree on which of them
// are right.
#include <gtest/gtest.h>

#if __has_include(<valijson/adapters/nlohmann_json_adapter.hpp>)

#include <algorithm>
#include <cctype>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "long_run.hpp"
#include "scene/schema_judges.hpp"

namespace luciole::test {
namespace {

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

class SceneChanges : public testing::TestWithParam<std::string> {
 protected:
  static json scene() { return asSchemasSeeIt(smallScenes().at(GetParam())); }
};
INSTANTIATE_TEST_SUITE_P(Scenes, SceneChanges, testing::ValuesIn(smallSceneNames()),
                         [](const auto& tested) { return tested.param; });

/// What places have in common that only lie in other elements of arrays, or in other materials, of the same
/// keys and the same types: both judges treat them alike.
std::string kindOfPlace(const json& scene, const Place& place) {
  static const std::set<std::string> types{"type", "primitive", "mode", "shape"};
  std::string kind;
  for (Place part = place; !part.empty(); part = part.parent_pointer()) {
    const json& value = scene[part];
    if (value.is_object())
      for (const auto& [key, member] : value.items())
        kind += types.count(key) != 0 ? key + "=" + member.dump() + "," : key + ",";
    const Place parent = part.parent_pointer();
    const bool is_one_of_many = scene[parent].is_array() || parent == Place("/materials");
    kind += is_one_of_many ? "/#" : "/" + part.back();
  }
  return kind;
}

// Where there are several places of a kind, each is tried with other values of those that the kind is tried
// with; a long run tries every place with all.
TEST_P(SceneChanges, OfOneValueAreJudgedAlikeBySchemaAndLoader) {
  Court court;
  json changing = scene();
  std::map<std::string, std::vector<Place> > kinds;
  for (const Place& place : placesIn(changing)) kinds[kindOfPlace(changing, place)].push_back(place);
  for (const auto& [kind, places] : kinds)
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::vector<NewValue> values = changesOf(changing[places[i]]);
      const std::size_t step = longRun() ? 1 : places.size();
      for (std::size_t j = longRun() ? 0 : i; j < values.size(); j += step)
        hearChanged(changing, places[i], values[j], court);
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

TEST_P(SceneChanges, OfTwoValuesAreJudgedAlikeBySchemaAndLoader) {
  Court court;
  const json unchanged = scene();
  Lots lots{17};
  const int cases = longRun() ? 20'000 : 800;
  for (int i = 0; i < cases; ++i) {
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
  court.close(cases / 2);
}
}  // namespace
}  // namespace luciole::test

#endif
