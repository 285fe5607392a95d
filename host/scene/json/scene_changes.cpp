#include "scene/json/scene_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/did_you_mean.hpp"
#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/json/json_light.hpp"
#include "scene/json/json_object.hpp"
#include "scene/json/json_scene.hpp"
#include "scene/load_textures.hpp"

namespace luciole {
namespace {

/// Of what there is, in the message about what isn't.
constexpr std::size_t kNamesTold = 12;

[[noreturn]] void refusePlace(const std::string& text, const std::string& option) {
  throw InputError(fmt::format(
      "{} {}: expected PATH=VALUE, such as materials.box.shininess=4 or 'lights[0].color=[1,0,0]'", option,
      forMessage(text)));
}

/// Where the quoted text that begins at `at` ends, behind its quote; npos where it doesn't.
std::size_t quoteEnd(const std::string& text, std::size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at)
    if (text[at] == '\\') ++at;
  return at < text.size() ? at + 1 : std::string::npos;
}

/// Reads the step that begins at `at`, and moves `at` behind it.
ChangeStep readStep(const std::string& text, std::size_t& at, const std::string& option) {
  if (text[at] != '[') {
    if (text[at] == '.') ++at;
    const std::size_t end = std::min(text.find_first_of(".[=", at), text.size());
    if (end == at) refusePlace(text, option);
    const std::size_t begin = std::exchange(at, end);
    return {text.substr(begin, end - begin)};
  }
  ChangeStep step;
  const bool is_quoted = at + 1 < text.size() && text[at + 1] == '"';
  const std::size_t end = is_quoted ? quoteEnd(text, at + 1) : text.find(']', at);
  if (end >= text.size() || text[end] != ']') refusePlace(text, option);
  const std::string inside = text.substr(at + 1, end - at - 1);
  at = end + 1;
  if (is_quoted) {
    const Json key = Json::parse(inside, nullptr, false);
    if (!key.is_string()) refusePlace(text, option);
    step.key = key.get<std::string>();
    return step;
  }
  const auto [last, error] = std::from_chars(inside.data(), inside.data() + inside.size(), step.index);
  if (error != std::errc() || last != inside.data() + inside.size() || step.index == JsonNode::kNoIndex)
    refusePlace(text, option);
  return step;
}

/// The steps of a text up to its =, where `at` stands then.
std::vector<ChangeStep> readSteps(const std::string& text, std::size_t& at, const std::string& option) {
  std::vector<ChangeStep> place;
  at = 0;
  while (at < text.size() && text[at] != '=') {
    if (!place.empty() && text[at] != '.' && text[at] != '[') refusePlace(text, option);
    place.push_back(readStep(text, at, option));
  }
  if (at >= text.size() || place.empty()) refusePlace(text, option);
  return place;
}

/// The first steps of a place, as they would be typed.
std::string placeText(const std::vector<ChangeStep>& place, std::size_t steps) {
  std::string text;
  for (std::size_t i = 0; i < steps; ++i) {
    const ChangeStep& step = place[i];
    if (step.index != JsonNode::kNoIndex)
      text += fmt::format("[{}]", step.index);
    else
      text += (text.empty() ? "" : ".") + forMessage(step.key);
  }
  return text;
}

[[noreturn]] void refuseStep(const SceneChange& change, std::size_t steps, const std::string& file,
                             const std::vector<std::string>& known) {
  const std::string& key = change.place[steps - 1].key;
  const std::string guess = key.empty() ? "" : didYouMean(key, known);
  const std::size_t told = std::min(known.size(), kNamesTold);
  std::string list =
      known.empty()
          ? ""
          : fmt::format("; it has {}", fmt::join(known.begin(), known.begin() + std::ptrdiff_t(told), ", "));
  if (known.size() > told) list += fmt::format(" and {} more", known.size() - told);
  throw InputError(fmt::format("changes: {}: {} has no {}{}", forMessage(change.text), file,
                               placeText(change.place, steps), guess.empty() ? list : guess));
}

/// Whether an element of an array is called so.
bool isCalled(const Json& element, const std::string& name) {
  const auto own = element.is_object() ? element.find("name") : element.end();
  return element.is_object() && own != element.end() && own->is_string() && *own == name;
}

/// What there is in a value, as a step would name it.
std::vector<std::string> namesIn(const Json& holder) {
  std::vector<std::string> names;
  if (holder.is_object())
    for (const auto& [key, value] : holder.items()) names.push_back(forMessage(key));
  if (holder.is_array() && !holder.empty())
    names.push_back(holder.size() == 1 ? "[0]" : fmt::format("[0] to [{}]", holder.size() - 1));
  return names;
}

/// The member that a step names; null where there is none.
Json* memberOf(Json& holder, const ChangeStep& step) {
  const bool by_index = step.index != JsonNode::kNoIndex;
  if (holder.is_object() && !by_index) {
    const auto found = holder.find(step.key);
    return found == holder.end() ? nullptr : &*found;
  }
  if (!holder.is_array()) return nullptr;
  if (by_index) return step.index < holder.size() ? &holder[step.index] : nullptr;
  const auto found = std::find_if(holder.begin(), holder.end(),
                                  [&](const Json& element) { return isCalled(element, step.key); });
  return found == holder.end() ? nullptr : &*found;
}

/// Sets what lies at the steps of the change from `first` on.
void makeChange(Json& json, SceneChange& change, std::size_t first, const std::string& file) {
  Json* at = &json;
  for (std::size_t i = first; i < change.place.size(); ++i) {
    const ChangeStep& step = change.place[i];
    Json* next = memberOf(*at, step);
    const bool may_be_new = i + 1 == change.place.size() && at->is_object() && !step.key.empty();
    if (!next && !may_be_new) refuseStep(change, i + 1, file, namesIn(*at));
    at = next ? next : &(*at)[step.key];
  }
  *at = change.value;
  change.is_made = true;
}

bool isOf(const SceneChange& change, const char* key) { return change.place.front().key == key; }

/// The place of a change in its scene's materials or lights; throws where there is none.
template <class T>
std::vector<std::size_t> placesOf(const SceneChange& change, const std::vector<T>& list,
                                  const std::string& file) {
  std::vector<std::size_t> places;
  std::vector<std::string> names;
  const ChangeStep& step = change.place[1];
  for (std::size_t i = 0; i < list.size(); ++i) {
    const bool by_index = step.index != JsonNode::kNoIndex;
    if (by_index ? step.index == i : list[i].name == step.key) places.push_back(i);
    if (!list[i].name.empty()) names.push_back(forMessage(list[i].name));
  }
  if (!places.empty()) return places;
  if (names.empty() && !list.empty()) names.push_back(fmt::format("[0] to [{}]", list.size() - 1));
  refuseStep(change, 2, file, names);
}

/// Calls read(the node) of an object that the change makes: that of materials.NAME or lights[0] in a scene
/// file.
template <class Read>
void readAlone(const SceneChange& change, Json object, const Scene& scene, const Read& read) {
  if (change.place.size() > 3)
    throw InputError(fmt::format("changes: {}: of a mesh file whole values can be set, expected {}=...",
                                 forMessage(change.text), placeText(change.place, 3)));
  if (change.place.size() == 3)
    object[change.place[2].key] = change.value;
  else
    object.update(change.value.is_object() ? change.value : Json::object());
  const JsonNode top{nullptr, nullptr, scene.name, JsonNode::kNoIndex};
  const JsonNode list{nullptr, &top, change.place[0].key, JsonNode::kNoIndex};
  read(JsonNode{&object, &list, change.place[1].key, change.place[1].index});
}

/// A light as a scene file has it. Its group has no word here.
Json lightJson(const Light& light, const std::vector<Luminaire>& luminaires) {
  const auto list = [](const auto& v) { return Json{v.x, v.y, v.z}; };
  Json json = Json::object();
  json["shadow"] = light.shadow;
  const float intensity = std::max({light.diffuse.x, light.diffuse.y, light.diffuse.z});
  const glm::vec3 unit = light.diffuse / (intensity > 0 ? intensity : 1.0f);
  const auto color = [&](const glm::vec3& own) { return list(intensity > 0 ? own / intensity : own); };
  json["color"] = intensity > 0 ? list(unit) : Json(1);
  json["intensity"] = intensity;
  if (light.specular != light.diffuse) json["specular"] = color(light.specular);
  if (light.ambient != glm::vec3(0)) json["ambient"] = color(light.ambient);
  if (light.kind == LightKind::kDirectional) {
    json["type"] = "directional";
    json["direction"] = list(light.direction);
    json["angle"] = glm::degrees(2 * light.half_angle);
    return json;
  }
  json["type"] = light.kind == LightKind::kSpot ? "spot" : "point";
  json["position"] = list(light.position);
  json["attenuation"] = list(light.attenuation);
  json["radius"] = light.radius;
  if (std::isfinite(light.range)) json["range"] = light.range;
  if (light.window == RangeWindow::kKhr) json["window"] = "khr";
  if (light.luminaire >= 0) {
    const Luminaire& luminaire = luminaires[std::size_t(light.luminaire)];
    json["profile"] = luminaire.profile->name;
    json["candela"] = 1;
    json["up"] = list(luminaire.up);
  } else if (light.kind == LightKind::kPoint) {
    return json;
  }
  json["direction"] = list(light.direction);
  if (light.kind == LightKind::kPoint) return json;
  if (light.falloff == SpotFalloff::kCone) {
    json["inner_cone"] = glm::degrees(light.inner_cone);
    json["outer_cone"] = glm::degrees(light.cutoff);
  } else {
    json["cutoff"] = glm::degrees(light.cutoff);
    json["exponent"] = light.exponent;
  }
  return json;
}

void changeLight(const SceneChange& change, std::size_t number, Scene& scene) {
  Light& light = scene.lights[number];
  LightFiles files{};
  for (const Luminaire& luminaire : scene.luminaires)
    files.profiles.emplace(luminaire.profile->name, luminaire.profile);
  readAlone(change, lightJson(light, scene.luminaires), scene, [&](const JsonNode& node) {
    Scene read;
    read.light_groups = scene.light_groups;
    LightGroupNumbers groups = lightGroupNumbers(read);
    readLight(node, groups, files, read);
    if (!read.animation.lights.empty()) refuse(node, "a mesh file's light can't be given keys");
    scene.light_groups = read.light_groups;
    if (read.lights.empty()) {  // it is switched off; its place stays, as what moves counts on it
      light.ambient = light.diffuse = light.specular = glm::vec3(0);
      return;
    }
    Light changed = read.lights.front();
    if (!find(node, "name")) changed.name = light.name;
    if (!find(node, "group")) changed.group = light.group;
    if (changed.luminaire >= 0) {
      changed.luminaire = std::int32_t(scene.luminaires.size());
      scene.luminaires.push_back(read.luminaires.front());
    }
    changed.over_pi = light.over_pi;
    light = changed;
  });
}

}  // namespace

std::size_t placeLength(const std::string& text, const std::string& option) {
  std::size_t at = 0;
  readSteps(text, at, option);
  return at;
}

std::vector<SceneChange> readChanges(const std::vector<std::string>& texts) {
  std::vector<SceneChange> changes;
  for (const std::string& text : texts) {
    std::size_t at = 0;
    std::vector<ChangeStep> place = readSteps(text, at, "changes:");
    const std::string typed = text.substr(at + 1);
    Json value = Json::parse(typed, nullptr, false);
    changes.push_back({text, std::move(place), value.is_discarded() ? Json(typed) : std::move(value)});
  }
  return changes;
}

Json changedMember(const JsonNode& node, std::vector<SceneChange>& changes) {
  Json json = *node.json;
  for (SceneChange& change : changes) {
    if (change.place.size() < 2 || change.place[0].key != node.parent->key) continue;
    const ChangeStep& step = change.place[1];
    const bool is_this = step.index != JsonNode::kNoIndex ? step.index == node.index
                                                          : step.key == node.key || isCalled(json, step.key);
    if (!is_this) continue;
    const JsonNode* root = node.parent;
    while (root->parent) root = root->parent;
    makeChange(json, change, 2, std::string(root->key));
  }
  return json;
}

void changeScene(Json& top, const std::string& file, std::vector<SceneChange>& changes) {
  for (SceneChange& change : changes) {
    if (change.is_made) continue;
    const bool is_whole = change.place.size() == 1;
    if (!is_whole && (isOf(change, "lights") || isOf(change, "cameras"))) continue;
    if (isOf(change, "materials") && !is_whole) {
      // It may be a mesh file's.
      const auto materials = top.find("materials");
      if (materials == top.end() || !materials->is_object() || !memberOf(*materials, change.place[1]))
        continue;
    }
    if (!top.is_object()) continue;
    makeChange(top, change, 0, file);
  }
}

void changeMaterials(std::vector<SceneChange>& changes, const SearchFolders& where, Scene& scene) {
  bool any = false;
  for (SceneChange& change : changes) {
    if (change.is_made || !isOf(change, "materials") || change.place.size() < 2) continue;
    for (const std::size_t number : placesOf(change, scene.materials, scene.name))
      readAlone(change, Json::object(), scene,
                [&](const JsonNode& node) { readMaterial(node, where, scene, scene.materials[number]); });
    change.is_made = any = true;
  }
  if (any) decodeTextures(scene);
}

void changeLoaded(std::vector<SceneChange>& changes, Scene& scene) {
  for (SceneChange& change : changes) {
    if (change.is_made) continue;
    const std::string& key = change.place[0].key;
    if (key == "lights" && change.place.size() > 1) {
      for (const std::size_t number : placesOf(change, scene.lights, scene.name))
        changeLight(change, number, scene);
    } else if (change.place.size() == 1 &&
               (key == "ambient" || key == "background" || key == "fog" || key == "lighting")) {
      Json json = Json::object();
      json[key] = change.value;
      readSurroundings({&json, nullptr, scene.name, JsonNode::kNoIndex}, scene);
    } else {
      throw InputError(fmt::format(
          "changes: {}: of {} materials, lights, ambient, background, fog and lighting can be set, such as "
          "lights[0].intensity=2",
          forMessage(change.text), scene.name));
    }
    change.is_made = true;
  }
}

void refuseChange(const SceneChange& change, const std::string& file, const std::vector<std::string>& known) {
  refuseStep(change, std::min<std::size_t>(change.place.size(), 2), file, known);
}

}  // namespace luciole
