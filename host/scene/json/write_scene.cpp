#include "scene/json/write_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/text_file.hpp"
#include "luciole/error.hpp"

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

std::string cameraLine(const Camera& camera) {
  const glm::dmat4& place = camera.camera_to_world;
  const glm::dvec3 eye = place[3];
  // The target is as far from the eye as the eye is from the origin, so that at any place rounding turns the
  // view by about 2^-53.
  const double away = std::max({1.0, std::abs(eye.x), std::abs(eye.y), std::abs(eye.z)});
  const glm::dvec3 target = eye - away * glm::dvec3(place[2]);
  const std::string lens = camera.orthographic ? fmt::format("\"orthographic\": {}", camera.half_height)
                                               : fmt::format("\"fov_y\": {}", glm::degrees(camera.fov_y));
  return fmt::format(
      "  \"camera\": {{\"eye\": {}, \"target\": {}, \"up\": {}, {}, \"near\": {}, \"far\": {}}},\n",
      vectorText(eye), vectorText(target), vectorText(place[1]), lens, camera.near,
      std::min(camera.far, kBeyondAll));
}

/// The degrees that are read as these radians, to the bit where they were typed as degrees.
double degreesOf(double radians) {
  double degrees = glm::degrees(radians);
  for (const double near : {degrees, std::nextafter(degrees, 0.0), std::nextafter(degrees, 360.0)})
    if (glm::radians(near) == radians) return near;
  return degrees;
}

void appendSpot(const Light& light, std::string& text) {
  const auto out = std::back_inserter(text);
  if (light.falloff == SpotFalloff::kCone)
    fmt::format_to(out, ", \"inner_cone\": {}, \"outer_cone\": {}", degreesOf(light.inner_cone),
                   degreesOf(light.cutoff));
  else
    fmt::format_to(out, ", \"cutoff\": {}, \"exponent\": {}", degreesOf(light.cutoff), light.exponent);
}

/// Appends the lights and the end of a scene's file.
void appendLights(const std::vector<Light>& lights, std::string& text) {
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
    if (light.kind != LightKind::kPoint) {
      const glm::dvec3& d = light.direction;
      fmt::format_to(out, ", \"direction\": [{}, {}, {}]", d.x, d.y, d.z);
    }
    fmt::format_to(out, ", \"color\": [{}, {}, {}]", c.x, c.y, c.z);
    if (light.kind == LightKind::kSpot) appendSpot(light, text);
    if (light.attenuation != glm::vec3(1, 0, 0)) {
      const glm::vec3& a = light.attenuation;
      fmt::format_to(out, ", \"attenuation\": [{}, {}, {}]", a.x, a.y, a.z);
    }
    if (std::isfinite(light.range)) fmt::format_to(out, ", \"range\": {}", light.range);
    text += light.shadow ? ", \"shadow\": true}" : "}";
  }
  text += "\n  ]\n}\n";
}

}  // namespace

std::string lightsScene(const std::vector<Light>& lights) {
  std::string text = "{\n";
  appendLights(lights, text);
  return text;
}

std::string meshWithLights(const std::string& mesh_path, const Camera& camera,
                           const std::vector<Light>& lights) {
  std::string text = "{\n" + cameraLine(camera);
  text += fmt::format("  \"objects\": [{{\"mesh\": {}}}],\n", quoted(mesh_path));
  appendLights(lights, text);
  return text;
}

std::string sceneWithLights(const std::string& scene_path, const std::string& folder, const Camera& camera,
                            const std::vector<Light>& lights) {
  // Ordered, because the first of several cameras is the default.
  using OrderedJson = nlohmann::ordered_json;
  OrderedJson scene = OrderedJson::parse(readFile(scene_path), nullptr, true, true);
  scene.erase("lights");
  scene.erase("light_fields");
  const std::string old_folder = std::filesystem::path(scene_path).parent_path().string();
  const auto movePath = [&](OrderedJson& holder, const char* key) {
    if (!holder.contains(key)) return;
    const std::filesystem::path path = holder[key].get<std::string>();
    if (path.is_relative()) holder[key] = pathFrom(folder, (old_folder / path).string());
  };
  if (scene.contains("materials")) {
    for (auto& [name, material] : scene["materials"].items())
      for (const char* map : {"diffuse_map", "emission_map", "normal_map", "bump_map", "alpha_map"})
        movePath(material, map);
  }
  if (scene.contains("objects"))
    for (OrderedJson& object : scene["objects"]) {
      movePath(object, "mesh");
      object.erase("lights");
    }
  // A schema may be a path or a URL.
  if (scene.contains("$schema") && scene["$schema"].get<std::string>().find(':') == std::string::npos)
    movePath(scene, "$schema");

  std::string text = "{\n";
  if (!scene.contains("camera") && !scene.contains("cameras")) text += cameraLine(camera);
  for (const auto& [key, value] : scene.items()) {
    text += fmt::format("  {}: ", quoted(key));
    if (key == "objects") {
      const char* separator = "[";
      for (const OrderedJson& object : value)
        text += fmt::format("{}\n    {}", std::exchange(separator, ","), object.dump());
      text += value.empty() ? "[]" : "\n  ]";
    } else {
      text += value.dump();
    }
    text += ",\n";
  }
  appendLights(lights, text);
  return text;
}

std::string pathFrom(const std::string& folder, const std::string& path) {
  return std::filesystem::absolute(path).lexically_proximate(std::filesystem::absolute(folder)).string();
}

}  // namespace luciole
