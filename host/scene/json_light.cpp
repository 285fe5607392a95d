#include "scene/json_light.hpp"

#include <fmt/format.h>

#include <limits>

namespace luciole {
namespace {

LightKind readKind(const JsonNode& node) {
  const std::string type = readText(node);
  if (type == "point") return LightKind::kPoint;
  if (type == "directional") return LightKind::kDirectional;
  if (type == "spot") return LightKind::kSpot;
  refuse(node, fmt::format("expected \"point\", \"directional\" or \"spot\", got {}", node.json->dump()));
}

void readColors(const JsonNode& node, Light& light) {
  glm::vec3 color{1.0f};
  if (const auto n = find(node, "color")) color = readColor(*n);
  light.ambient = glm::vec3(0);
  light.diffuse = light.specular = color;
  if (const auto n = find(node, "ambient")) light.ambient = readColor(*n);
  if (const auto n = find(node, "diffuse")) light.diffuse = readColor(*n);
  if (const auto n = find(node, "specular")) light.specular = readColor(*n);
  if (const auto n = find(node, "intensity")) {
    const float intensity = static_cast<float>(readNumber(*n, 0, kLargestNumber));
    light.ambient *= intensity;
    light.diffuse *= intensity;
    light.specular *= intensity;
  }
}

/// Where a spot shines and how it falls off to the sides. With OpenGL's cutoff of 180° it is a point light,
/// whatever its exponent and direction.
void readSpot(const JsonNode& node, Light& light) {
  const auto direction = find(node, "direction");
  const auto target = find(node, "target");
  if (direction && target) refuse(*target, "expected either \"direction\" or \"target\", got both");
  if (direction) light.direction = readDirection(*direction);
  if (target) {
    const glm::dvec3 ray = readVector(*target) - light.position;
    if (!(glm::length(ray) >= 1 / kLargestNumber))
      refuse(*target, "is the light's position, so it has no direction");
    light.direction = glm::normalize(ray);
  }

  if (find(node, "inner_cone") || find(node, "outer_cone")) {
    refuseKeys(node, {"cutoff", "exponent"}, "beside inner_cone and outer_cone");
    double inner = 0;
    double outer = 45;
    if (const auto n = find(node, "outer_cone")) outer = readNumber(*n, 0, 90);
    if (const auto n = find(node, "inner_cone")) inner = readNumber(*n, 0, 90);
    if (inner >= outer)
      refuse(node, fmt::format("inner_cone {} isn't smaller than outer_cone {}", inner, outer));
    light.falloff = SpotFalloff::kCone;
    light.inner_cone = glm::radians(inner);
    light.cutoff = glm::radians(outer);
  } else {
    double cutoff = 180;
    if (const auto n = find(node, "cutoff")) {
      cutoff = readNumber(*n);
      if (!(cutoff >= 0 && cutoff <= 90) && cutoff != 180) {
        refuse(*n, fmt::format("expected degrees from 0 to 90, or 180, got {}", cutoff));
      }
    }
    if (const auto n = find(node, "exponent")) light.exponent = static_cast<float>(readNumber(*n, 0, 128));
    if (cutoff == 180) {
      light.kind = LightKind::kPoint;
      light.exponent = 0;
      return;
    }
    light.cutoff = glm::radians(cutoff);
  }
  if (!direction && !target) refuse(node, "\"direction\" or \"target\" is missing");
}

/// One number, or [low, high].
glm::vec2 readSpan(const JsonNode& node, double (*readOne)(const JsonNode&)) {
  if (!node.json->is_array()) return glm::vec2(static_cast<float>(readOne(node)));
  if (node.json->size() != 2) refuse(node, "expected a number or [lowest, highest]");
  const double low = readOne(element(node, 0));
  const double high = readOne(element(node, 1));
  if (low > high) refuse(node, fmt::format("the lowest, {}, is above the highest, {}", low, high));
  return {low, high};
}

void readShape(const JsonNode& node, LightField& field) {
  if (const auto n = find(node, "shape")) {
    const std::string shape = readText(*n);
    if (shape == "ball") {
      field.shape = FieldShape::kBall;
    } else if (shape == "sphere") {
      field.shape = FieldShape::kSphere;
    } else if (shape != "box") {
      refuse(*n, fmt::format("expected \"box\", \"ball\" or \"sphere\", got {}", n->json->dump()));
    }
  }
  if (field.shape == FieldShape::kBox) {
    refuseKeys(node, {"center", "radius"}, "for a box");
    field.low = readVector(need(node, "min"));
    field.high = readVector(need(node, "max"));
    for (int i = 0; i < 3; ++i) {
      if (field.low[i] > field.high[i])
        refuse(need(node, "min"), fmt::format("[{}] is above that of \"max\"", i));
    }
  } else {
    refuseKeys(node, {"min", "max"}, "for a ball or sphere");
    field.center = readVector(need(node, "center"));
    field.radius = readPositive(need(node, "radius"));
  }
}

}  // namespace

std::optional<Light> readLight(const JsonNode& node) {
  allowKeys(node, {"type", "position", "direction", "target", "color", "intensity", "ambient", "diffuse",
                   "specular", "attenuation", "range", "cutoff", "exponent", "inner_cone", "outer_cone",
                   "shadow", "radius", "angle", "enabled"});
  Light light;
  light.kind = readKind(need(node, "type"));
  if (light.kind == LightKind::kDirectional) {
    refuseKeys(node, {"position", "target", "attenuation", "range", "radius"}, "for a directional light");
    light.direction = readDirection(need(node, "direction"));
    if (const auto n = find(node, "angle")) light.half_angle = glm::radians(readNumber(*n, 0, 90)) / 2;
  } else {
    refuseKeys(node, {"angle"}, "for a light with a position");
    light.position = readVector(need(node, "position"));
    if (const auto n = find(node, "radius")) light.radius = readNumber(*n, 0, kLargestNumber);
    if (const auto n = find(node, "attenuation")) light.attenuation = readAttenuation(*n);
    if (const auto n = find(node, "range")) light.range = static_cast<float>(readPositive(*n));
  }
  if (light.kind == LightKind::kPoint) refuseKeys(node, {"direction", "target"}, "for a point light");
  if (light.kind == LightKind::kSpot) {
    readSpot(node, light);
  } else {
    refuseKeys(node, {"cutoff", "exponent", "inner_cone", "outer_cone"}, "for a light that isn't a spot");
  }
  readColors(node, light);
  if (const auto n = find(node, "shadow")) light.shadow = readBool(*n);
  if (const auto n = find(node, "enabled"); n && !readBool(*n)) return std::nullopt;
  return light;
}

LightField readLightField(const JsonNode& node) {
  allowKeys(node, {"count", "seed", "shape", "min", "max", "center", "radius", "color", "colors", "intensity",
                   "range", "attenuation", "shadow"});
  LightField field;
  field.count = readCount(need(node, "count"), kMostLights);
  if (const auto n = find(node, "seed"))
    field.seed = readCount(*n, std::numeric_limits<std::uint64_t>::max());
  readShape(node, field);
  if (const auto n = find(node, "color")) {
    refuseKeys(node, {"colors"}, "beside color");
    field.colors = {readColor(*n)};
  }
  if (const auto n = find(node, "colors")) {
    needArray(*n);
    if (n->json->empty()) refuse(*n, "expected one colour or more");
    field.colors.clear();
    for (std::size_t i = 0; i < n->json->size(); ++i) field.colors.push_back(readColor(element(*n, i)));
  }
  if (const auto n = find(node, "intensity")) {
    field.intensity = readSpan(*n, [](const JsonNode& one) { return readNumber(one, 0, kLargestNumber); });
  }
  if (const auto n = find(node, "range")) field.range = readSpan(*n, readPositive);
  if (const auto n = find(node, "attenuation")) field.attenuation = readAttenuation(*n);
  if (const auto n = find(node, "shadow")) field.shadow = readBool(*n);
  return field;
}

}  // namespace luciole
