#include "scene/json/write_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "luciole/shader.hpp"
#include "scene/json/mesh_file.hpp"
#include "scene/json/scene_changes.hpp"

namespace luciole {
namespace {

std::string quoted(const std::string& text) {
  try {
    return nlohmann::json(text).dump();
  } catch (const nlohmann::json::type_error&) {
    throw InputError(text + ": the path isn't UTF-8, so a scene file can't hold it");
  }
}

std::string vectorText(const glm::dvec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

/// In place of infinity, which JSON doesn't have: farther than anything may lie from anything
/// (place_limits.hpp).
constexpr double kBeyondAll = 1e20;

/// The degrees that are read as these radians, to the bit where they were typed as degrees.
double degreesOf(double radians) {
  double degrees = glm::degrees(radians);
  for (const double near : {degrees, std::nextafter(degrees, 0.0), std::nextafter(degrees, 360.0)})
    if (glm::radians(near) == radians) return near;
  return degrees;
}

std::string cameraText(const Camera& camera) {
  const glm::dmat4& place = camera.camera_to_world;
  const glm::dvec3 eye = place[3];
  // The target is as far from the eye as the eye is from the origin, so that at any place rounding turns the
  // view by about 2^-53.
  const double away = std::max({1.0, std::abs(eye.x), std::abs(eye.y), std::abs(eye.z)});
  const glm::dvec3 target = eye - away * glm::dvec3(place[2]);
  std::string lens = camera.orthographic ? fmt::format("\"orthographic\": {}", camera.half_height)
                                         : fmt::format("\"fov_y\": {}", degreesOf(camera.fov_y));
  if (camera.shift != glm::dvec2(0))
    lens += fmt::format(", \"shift\": [{}, {}]", camera.shift.x, camera.shift.y);
  if (camera.pixel_aspect != 1) lens += fmt::format(", \"pixel_aspect\": {}", camera.pixel_aspect);
  return fmt::format("{{\"eye\": {}, \"target\": {}, \"up\": {}, {}, \"near\": {}, \"far\": {}}}",
                     vectorText(eye), vectorText(target), vectorText(place[1]), lens, camera.near,
                     std::min(camera.far, kBeyondAll));
}

std::string cameraLine(const Camera& camera) {
  return fmt::format("  \"camera\": {},\n", cameraText(camera));
}

void appendSpot(const Light& light, std::string& text) {
  const auto out = std::back_inserter(text);
  if (light.falloff == SpotFalloff::kCone)
    fmt::format_to(out, ", \"inner_cone\": {}, \"outer_cone\": {}", degreesOf(light.inner_cone),
                   degreesOf(light.cutoff));
  else
    fmt::format_to(out, ", \"cutoff\": {}, \"exponent\": {}", degreesOf(light.cutoff), light.exponent);
}

/// A vector that is read as this unit vector, to the last bit where one is found near: reading divides by the
/// length, which rounds.
glm::dvec3 directionToRead(const glm::dvec3& direction) {
  for (int i = 0; i < 4096; ++i) {  // mostly one or two
    const glm::dvec3 scaled = (1 + i / 4096.0) * direction;
    if (scaled / glm::length(scaled) == direction) return scaled;
  }
  return direction;
}

/// folder: of the file that names the profile.
void appendLuminaire(const Luminaire& luminaire, const std::string& folder, std::string& text) {
  const glm::dvec3 up = directionToRead(luminaire.up);
  fmt::format_to(std::back_inserter(text), ", \"profile\": {}, \"candela\": 1, \"up\": [{}, {}, {}]",
                 quoted(pathFrom(folder, luminaire.profile->name)), up.x, up.y, up.z);
}

/// What lights refer to.
struct LightReferences {
  const std::vector<std::string>& groups;  ///< the names of the scene's
  const std::vector<Luminaire>& luminaires;
  std::string folder;  ///< of the scene's file
};

/// Appends the lights and the end of a scene's file. sources: as elements of the list, too.
void appendLights(std::span<const Light> lights, const LightReferences& of_scene, std::string& text,
                  const std::vector<nlohmann::ordered_json>& sources = {}) {
  const std::vector<std::string>& groups = of_scene.groups;
  text += "  \"lights\": [";
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    const glm::vec3& c = light.diffuse;
    fmt::format_to(out, "{}\n    {{\"type\": \"{}\"", i ? "," : "",
                   light.kind == LightKind::kPoint  ? "point"
                   : light.kind == LightKind::kSpot ? "spot"
                                                    : "directional");
    if (light.kind != LightKind::kDirectional) {
      const glm::dvec3& p = light.position;
      fmt::format_to(out, ", \"position\": [{}, {}, {}]", p.x, p.y, p.z);
    }
    const bool is_luminaire = light.luminaire >= 0;
    if (is_luminaire)
      appendLuminaire(of_scene.luminaires[std::size_t(light.luminaire)], of_scene.folder, text);
    if (light.kind != LightKind::kPoint || is_luminaire) {
      const glm::dvec3 d = directionToRead(light.direction);
      fmt::format_to(out, ", \"direction\": [{}, {}, {}]", d.x, d.y, d.z);
    }
    fmt::format_to(out, ", \"color\": [{}, {}, {}]", c.x, c.y, c.z);
    if (light.kind == LightKind::kSpot) appendSpot(light, text);
    if (light.attenuation != glm::vec3(1, 0, 0) || is_luminaire) {
      const glm::vec3& a = light.attenuation;
      fmt::format_to(out, ", \"attenuation\": [{}, {}, {}]", a.x, a.y, a.z);
    }
    if (std::isfinite(light.range)) fmt::format_to(out, ", \"range\": {}", light.range);
    if (std::isfinite(light.range) && light.window == RangeWindow::kKhr) text += ", \"window\": \"khr\"";
    const auto appendColor = [&](const char* name, const glm::vec3& color) {
      fmt::format_to(out, ", \"{}\": [{}, {}, {}]", name, color.x, color.y, color.z);
    };
    if (light.specular != c) appendColor("specular", light.specular);
    if (light.ambient != glm::vec3(0)) appendColor("ambient", light.ambient);
    if (light.radius > 0) fmt::format_to(out, ", \"radius\": {}", light.radius);
    if (light.half_angle > 0) fmt::format_to(out, ", \"angle\": {}", degreesOf(2 * light.half_angle));
    if (light.group > 0 && light.group < groups.size())
      fmt::format_to(out, ", \"group\": {}", quoted(groups[light.group]));
    if (!light.name.empty()) fmt::format_to(out, ", \"name\": {}", quoted(light.name));
    text += light.shadow ? ", \"shadow\": true}" : "}";
  }
  for (std::size_t i = 0; i < sources.size(); ++i) {
    text += i + lights.size() > 0 ? ",\n    " : "\n    ";
    text += sources[i].dump();
  }
  text += "\n  ]\n}\n";
}

/// Of lights without groups and profiles.
const std::vector<std::string> kNoGroups;
const std::vector<Luminaire> kNoLuminaires;
const LightReferences kNoReferences{kNoGroups, kNoLuminaires, ""};

nlohmann::ordered_json colorJson(const glm::vec3& color) { return {color.x, color.y, color.z}; }

/// An environment or a face as an element of "lights".
nlohmann::ordered_json sourceJson(const Scene& scene, const LightSource& source, const std::string& folder) {
  const auto list = [](const glm::dvec3& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  nlohmann::ordered_json json;
  if (source.kind == SourceKind::kEnvironment) {
    json = {{"type", "environment"}, {"image", pathFrom(folder, source.sky->name)}};
    json["rotate"] = degreesOf(source.rotate);
  } else {
    json["type"] = source.kind == SourceKind::kDisc ? "disc" : "rectangle";
    json["position"] = list(source.position);
    json["direction"] = list(directionToRead(source.direction));
    json["up"] = list(source.up);
    json["width"] = source.width;
    json["height"] = source.height;
  }
  json["color"] = colorJson(source.radiance);
  json["count"] = source.count;
  json["shadow"] = source.shadow;
  if (source.group > 0) json["group"] = scene.light_groups[source.group];
  if (!source.name.empty()) json["name"] = source.name;
  return json;
}

nlohmann::ordered_json fogJson(const Fog& fog) {
  nlohmann::ordered_json json{{"mode", fog.mode == FogMode::kLinear ? "linear"
                                       : fog.mode == FogMode::kExp  ? "exp"
                                                                    : "exp2"}};
  if (fog.mode == FogMode::kLinear) {
    json["start"] = fog.start;
    json["end"] = fog.end;
  } else {
    json["density"] = colorJson(fog.density);
  }
  json["color"] = colorJson(fog.color);
  if (fog.radial) json["distance"] = "radial";
  return json;
}

}  // namespace

std::string lightsScene(const std::vector<Light>& lights) {
  std::string text = "{\n";
  appendLights(lights, kNoReferences, text);
  return text;
}

std::string meshWithLights(const std::string& mesh_path, const Camera& camera,
                           const std::vector<Light>& lights) {
  std::string text = "{\n" + cameraLine(camera);
  text += fmt::format("  \"objects\": [{{\"mesh\": {}}}],\n", quoted(mesh_path));
  appendLights(lights, kNoReferences, text);
  return text;
}

// Ordered, because the first of several cameras is the default.
using OrderedJson = nlohmann::ordered_json;

/// A scene's file without its lights, with paths as they are from another folder.
static OrderedJson sceneFrom(const std::string& folder, const std::string& scene_path) {
  OrderedJson scene = OrderedJson::parse(readFile(scene_path), nullptr, true, true);
  const std::string old_folder = std::filesystem::path(scene_path).parent_path().string();
  const auto movePath = [&](OrderedJson& holder, const char* key) {
    if (!holder.contains(key)) return;
    const std::filesystem::path path = holder[key].get<std::string>();
    if (path.is_relative()) holder[key] = pathFrom(folder, (old_folder / path).string());
  };
  if (scene.contains("materials")) {
    for (auto& [name, material] : scene["materials"].items()) {
      for (const char* map : {"diffuse_map", "emission_map", "normal_map", "bump_map", "alpha_map"})
        movePath(material, map);
      if (material.contains("model") && material["model"].get<std::string>().ends_with(kShaderExtension))
        movePath(material, "model");
    }
  }
  if (scene.contains("objects"))
    for (OrderedJson& object : scene["objects"]) movePath(object, "mesh");
  if (scene.contains("lights"))
    for (OrderedJson& light : scene["lights"]) movePath(light, "profile");
  if (scene.contains("light_fields"))
    for (OrderedJson& field : scene["light_fields"]) movePath(field, "csv");
  if (scene.contains("lights"))
    for (OrderedJson& light : scene["lights"]) movePath(light, "image");
  // A schema may be a path or a URL.
  if (scene.contains("$schema") && scene["$schema"].get<std::string>().find(':') == std::string::npos)
    movePath(scene, "$schema");
  return scene;
}

/// Removes all lights of a scene's file.
static void eraseLights(OrderedJson& scene) {
  scene.erase("lights");
  scene.erase("light_fields");
  if (scene.contains("objects"))
    for (OrderedJson& object : scene["objects"]) object.erase("lights");
}

/// The members of a scene's file, an element of a list a line, each with a comma behind it.
static std::string membersText(const OrderedJson& scene) {
  std::string text;
  for (const auto& [key, value] : scene.items()) {
    text += fmt::format("  {}: ", quoted(key));
    if (value.is_array() && !value.empty() && value.front().is_object()) {
      const char* separator = "[";
      for (const OrderedJson& element : value)
        text += fmt::format("{}\n    {}", std::exchange(separator, ","), element.dump());
      text += "\n  ]";
    } else {
      text += value.dump();
    }
    text += ",\n";
  }
  return text;
}

std::string sceneWithLights(const std::string& scene_path, const std::string& folder, const Camera& camera,
                            const std::vector<Light>& lights) {
  OrderedJson scene = sceneFrom(folder, scene_path);
  eraseLights(scene);
  std::string text = "{\n";
  if (!scene.contains("camera") && !scene.contains("cameras")) text += cameraLine(camera);
  text += membersText(scene);
  appendLights(lights, kNoReferences, text);
  return text;
}

/// What a file, of a scene or of a mesh, is as the members of a scene's file in another folder.
static OrderedJson membersOf(const std::string& scene_path, const std::string& folder) {
  if (!isMeshFile(scene_path)) return sceneFrom(folder, scene_path);
  OrderedJson json;
  json["objects"] = {{{"mesh", pathFrom(folder, scene_path)}}};
  return json;
}

/// Replaces what surrounds the objects, and the camera.
static void setSurroundings(const Scene& scene, OrderedJson camera, const glm::ivec2& size,
                            OrderedJson& json) {
  json.erase("cameras");
  json["camera"] = std::move(camera);
  json["size"] = {size.x, size.y};
  json["ambient"] = colorJson(scene.ambient);
  json["background"] = colorJson(scene.background);
  if (!scene.lighting) json["lighting"] = false;
  json.erase("fog");
  if (scene.fog.mode != FogMode::kNone) json["fog"] = fogJson(scene.fog);
}

std::string pictureScene(const std::string& scene_path, const std::string& folder, const Scene& scene,
                         const Camera& camera, const glm::ivec2& size) {
  OrderedJson json = scene_path.empty() ? OrderedJson::object() : membersOf(scene_path, folder);
  eraseLights(json);
  setSurroundings(scene, OrderedJson::parse(cameraText(camera)), size, json);
  std::string text = "{\n" + membersText(json);
  appendLights(scene.lights, {kNoGroups, scene.luminaires, folder}, text);
  return text;
}

SavedScene savedScene(const std::string& scene_path, const std::string& folder, const Scene& scene,
                      const Json& camera, const glm::ivec2& size, const std::vector<std::string>& changes) {
  SavedScene saved;
  OrderedJson json = membersOf(scene_path, folder);
  bool keeps_lights = !isMeshFile(scene_path);
  // Materials that the file defines are changed in it.
  std::vector<SceneChange> of_materials;
  for (const std::string& text : changes) {
    SceneChange change = readChanges({text}).front();
    keeps_lights &= change.place[0].key != "lights";
    if (change.place[0].key == "materials") of_materials.push_back(std::move(change));
  }
  // An environment that the file doesn't have.
  const auto lists_sky = [&] {
    const OrderedJson lights = json.value("lights", OrderedJson::array());
    return std::any_of(lights.begin(), lights.end(),
                       [](const OrderedJson& light) { return light.value("type", "") == "environment"; });
  };
  keeps_lights &= !environmentOf(scene) || lists_sky();
  Json materials = Json::object();
  if (json.contains("materials")) materials["materials"] = Json::parse(json["materials"].dump());
  for (SceneChange& change : of_materials) {
    // By its name, since the saved file may number materials otherwise.
    ChangeStep& which = change.place[1];
    if (which.index == JsonNode::kNoIndex || which.index >= scene.materials.size()) continue;
    const std::string& name = scene.materials[which.index].name;
    if (name.empty()) continue;
    which = {name};
    change.text = fmt::format("materials[{}].{}={}", quoted(name), change.place[2].key, change.value.dump());
  }
  changeScene(materials, scene_path, of_materials);
  if (!materials.empty()) json["materials"] = OrderedJson::parse(materials["materials"].dump());
  for (const SceneChange& change : of_materials)
    if (!change.is_made) saved.left.push_back(change.text);

  setSurroundings(scene, OrderedJson::parse(camera.dump()), size, json);
  saved.text = "{\n";
  if (keeps_lights) {
    saved.text += membersText(json);
    saved.text.replace(saved.text.size() - 2, 2, "\n}\n");  // the last comma
  } else {
    eraseLights(json);
    saved.text += membersText(json);
    std::vector<OrderedJson> sources;
    for (const LightSource& source : scene.sources) sources.push_back(sourceJson(scene, source, folder));
    appendLights(ownLights(scene), {scene.light_groups, scene.luminaires, folder}, saved.text, sources);
  }
  return saved;
}

std::string pathFrom(const std::string& folder, const std::string& path) {
  return std::filesystem::absolute(path).lexically_proximate(std::filesystem::absolute(folder)).string();
}

}  // namespace luciole
