#include "scene/write_scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "error.hpp"

namespace luciole {
namespace {

std::string quoted(const std::string& text) {
  try {
    return nlohmann::json(text).dump();
  } catch (const nlohmann::json::type_error&) {
    throw InputError(text + ": the path isn't UTF-8, so a scene file can't hold it");
  }
}

}  // namespace

std::string lightsScene(const std::string& mesh_path, const std::vector<Light>& lights) {
  std::string text = "{\n";
  if (!mesh_path.empty()) text += fmt::format("  \"objects\": [{{\"mesh\": {}}}],\n", quoted(mesh_path));
  text += "  \"lights\": [";
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    const glm::dvec3& p = light.position;
    const glm::vec3& c = light.diffuse;
    fmt::format_to(out, "{}\n    {{\"type\": \"point\", \"position\": [{}, {}, {}], \"color\": [{}, {}, {}]",
                   i ? "," : "", p.x, p.y, p.z, c.x, c.y, c.z);
    if (light.attenuation != glm::vec3(1, 0, 0)) {
      const glm::vec3& a = light.attenuation;
      fmt::format_to(out, ", \"attenuation\": [{}, {}, {}]", a.x, a.y, a.z);
    }
    if (std::isfinite(light.range)) fmt::format_to(out, ", \"range\": {}", light.range);
    text += light.shadow ? ", \"shadow\": true}" : "}";
  }
  return text + "\n  ]\n}\n";
}

}  // namespace luciole
