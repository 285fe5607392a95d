#include "tools/view/view_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <system_error>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/json/scene_changes.hpp"
#include "tools/viewing/light_mixer.hpp"

namespace luciole {
namespace {

constexpr double kMostStrength = 1e6;

[[noreturn]] void refuseChange(const std::string& change) {
  throw InputError(fmt::format("changes: {}: the page can't change that", forMessage(change)));
}

/// Whether the page may change the place.
bool isChangeable(const std::vector<ChangeStep>& place) {
  static const std::vector<std::string_view> kOfLights{
      "color", "intensity", "position", "direction", "enabled", "shadow", "radius", "range", "angle"},
      kOfMaterials{"diffuse", "specular", "ambient", "emission", "shininess"},
      kOfScenes{"ambient", "background", "fog", "lighting"};
  const auto has = [](const std::vector<std::string_view>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const std::string& first = place[0].key;
  if (place.size() == 1) return has(kOfScenes, first);
  if (place.size() == 2) return first == "fog" && place[1].key == "color";
  return place.size() == 3 && ((first == "lights" && has(kOfLights, place[2].key)) ||
                               (first == "materials" && has(kOfMaterials, place[2].key)));
}

/// The linear colour of "#rrggbb" or "#rrggbb*STRENGTH" as a list of JSON; another text as it is.
std::string numberedColor(const std::string& text) {
  if (!text.starts_with('#')) return text;
  const std::size_t star = std::min(text.find('*'), text.size());
  const std::optional<glm::vec3> color = linearColor(text.substr(0, star));
  double strength = 1;
  const char* const end = text.data() + text.size();
  const bool has_strength = star < text.size();
  const auto [last, error] =
      has_strength ? std::from_chars(text.data() + star + 1, end, strength) : std::from_chars_result{end, {}};
  if (!color || error != std::errc() || last != end || !(strength >= 0 && strength <= kMostStrength))
    throw InputError(fmt::format("changes: {}: no colour", forMessage(text)));
  const glm::vec3 scaled = float(strength) * *color;
  return nlohmann::json{scaled.x, scaled.y, scaled.z}.dump();
}

}  // namespace

SceneValues valuesOf(const Scene& scene) {
  return {scene.lights,       scene.source_lights, scene.sources,    scene.materials, scene.user_models,
          scene.light_groups, scene.ambient,       scene.background, scene.fog,       scene.lighting};
}

void setValues(const SceneValues& values, Scene& scene) {
  scene.lights = values.lights;
  scene.source_lights = values.source_lights;
  scene.sources = values.sources;
  scene.materials = values.materials;
  scene.user_models = values.user_models;
  scene.light_groups = values.light_groups;
  scene.ambient = values.ambient;
  scene.background = values.background;
  scene.fog = values.fog;
  scene.lighting = values.lighting;
}

std::vector<std::string> numberedChanges(const std::vector<std::string>& changes) {
  std::vector<std::string> numbered;
  std::size_t fog = ~std::size_t(0);
  for (const std::string& change : changes) {
    const SceneChange read = readChanges({change}).front();
    if (!isChangeable(read.place)) refuseChange(change);
    const std::size_t length = placeLength(change, "changes:");
    const std::string value = numberedColor(change.substr(length + 1));
    if (read.place.size() != 2) {
      if (read.place[0].key == "fog") fog = numbered.size();
      numbered.push_back(change.substr(0, length + 1) + value);
      continue;
    }
    if (fog >= numbered.size()) refuseChange(change);
    nlohmann::json whole = nlohmann::json::parse(numbered[fog].substr(4), nullptr, false);
    const nlohmann::json color = nlohmann::json::parse(value, nullptr, false);
    if (!whole.is_object() || color.is_discarded()) refuseChange(change);
    whole["color"] = color;
    numbered[fog] = "fog=" + whole.dump();
  }
  return numbered;
}

void makeChanges(const std::vector<std::string>& numbered, Scene& scene) {
  std::vector<SceneChange> changes = readChanges(numbered);
  changeMaterials(changes, {}, scene);
  changeLoaded(changes, scene);
  if (scene.source_lights > 0) addSourceLights(scene);  // materials may emit more or less
}

}  // namespace luciole
