#include "tools/view/scene_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/embedded_files.hpp"
#include "image/srgb.hpp"
#include "luciole/settings.hpp"
#include "scene/models.hpp"

namespace luciole {
namespace {

using Json = nlohmann::json;

/// Of a colour, as far as its largest channel is above 1 a share of that.
std::string hexOf(const glm::vec3& color) {
  const float largest = std::max({1.0f, color.x, color.y, color.z});
  std::string hex = "#";
  for (int c = 0; c < 3; ++c)
    hex += fmt::format("{:02x}", int(std::lround(255 * encodeSrgb(color[c] / largest))));
  return hex;
}

template <class Vector>
Json listOf(const Vector& v) {
  return {v.x, v.y, v.z};
}

Json lightState(const Light& light, std::size_t index) {
  const float intensity = std::max({light.diffuse.x, light.diffuse.y, light.diffuse.z});
  const glm::vec3 color = light.diffuse / (intensity > 0 ? intensity : 1.0f);
  Json json{{"index", index},         {"name", nameOr(light.name, "light", index)},
            {"color", listOf(color)}, {"hex", hexOf(color)},
            {"intensity", intensity}, {"shadow", light.shadow},
            {"radius", light.radius}};
  json["kind"] = light.kind == LightKind::kPoint  ? "point"
                 : light.kind == LightKind::kSpot ? "spot"
                                                  : "directional";
  if (light.kind != LightKind::kDirectional) json["position"] = listOf(light.position);
  return json;
}

Json materialState(const Material& material, std::size_t index) {
  return {{"index", index},
          {"name", nameOr(material.name, "material", index)},
          {"diffuse", listOf(material.diffuse)},
          {"diffuse_hex", hexOf(material.diffuse)},
          {"specular", listOf(material.specular)},
          {"specular_hex", hexOf(material.specular)},
          {"emission", listOf(material.emission)},
          {"emission_hex", hexOf(material.emission)},
          {"shininess", material.shininess}};
}

Json fogState(const Fog& fog) {
  if (fog.mode == FogMode::kNone) return nullptr;
  Json json{{"color", listOf(fog.color)}, {"hex", hexOf(fog.color)}};
  json["mode"] = fog.mode == FogMode::kLinear ? "linear" : fog.mode == FogMode::kExp ? "exp" : "exp2";
  if (fog.mode == FogMode::kLinear)
    json.update({{"start", fog.start}, {"end", fog.end}});
  else
    json["density"] = listOf(fog.density);
  return json;
}

}  // namespace

std::string nameOr(const std::string& name, const char* kind, std::size_t index) {
  return name.empty() ? fmt::format("{} {}", kind, index) : name;
}

Json sceneState(const Scene& scene, const SceneValues& loaded) {
  Json cameras = Json::array(), lights = Json::array(), materials = Json::array();
  for (const Camera& camera : scene.cameras) cameras.push_back(camera.name);
  for (std::size_t i = 0; i < std::min(loaded.lights.size() - loaded.source_lights, kMostListed); ++i)
    lights.push_back(lightState(loaded.lights[i], i));
  for (std::size_t i = 0; i < loaded.materials.size(); ++i)
    materials.push_back(materialState(loaded.materials[i], i));
  const glm::ivec2 size = scene.size.value_or(RenderSettings{}.size);
  return {{"name", scene.name},
          {"size", {size.x, size.y}},
          {"cameras", cameras},
          {"lights", lights},
          {"light_count", loaded.lights.size()},
          {"materials", materials},
          {"fog", fogState(loaded.fog)},
          {"ambient", listOf(loaded.ambient)},
          {"ambient_hex", hexOf(loaded.ambient)},
          {"background", listOf(loaded.background)},
          {"background_hex", hexOf(loaded.background)},
          {"choices",
           {{"model", kModelNames},
            {"shading", {"flat", "gouraud", "phong"}},
            {"shadows", {"auto", "off", "hard", "pcf", "soft", "exact", "soft-exact"}}}}};
}

Json exampleShaders() {
  Json examples;
  for (const EmbeddedFile& file : exampleShaderFiles()) {
    const char* const kind = file.text.find("void surface(") != file.text.npos ? "surface"
                             : file.text.find("screen(") != file.text.npos     ? "screen"
                                                                               : "model";
    examples[kind][std::string(file.name)] = std::string(file.text);
  }
  return examples;
}

}  // namespace luciole
