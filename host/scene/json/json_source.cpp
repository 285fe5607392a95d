#include "scene/json/json_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "luciole/scene.hpp"
#include "scene/json/json_keys.hpp"
#include "scene/posing.hpp"

namespace luciole {
namespace {

/// Lights of a face or of what glows, where the file doesn't say how many.
constexpr std::uint32_t kFaceLights = 256;

constexpr double kLeastSine = 1e-8;

void readEnvironment(const JsonNode& node, const SearchFolders& where, Scene& scene, LightSource& source) {
  allowKeys(node, {"type", "image", "rotate", "color", "intensity", "count", "shadow", "group", "name",
                   "enabled", "keys", "interpolation"});
  source.kind = SourceKind::kEnvironment;
  source.count = kSkyLights;
  if (const auto n = find(node, "rotate")) source.rotate = glm::radians(readNumber(*n));
  source.sky = readSky(readPath(need(node, "image"), where), scene.warnings);
}

void readFace(const JsonNode& node, LightSource& source) {
  allowKeys(node, {"type", "position", "direction", "up", "width", "height", "color", "intensity", "count",
                   "shadow", "group", "name", "enabled", "keys", "interpolation"});
  source.kind = readText(need(node, "type")) == "disc" ? SourceKind::kDisc : SourceKind::kRectangle;
  source.count = kFaceLights;
  source.position = readVector(need(node, "position"));
  source.direction = readDirection(need(node, "direction"));
  source.up = std::abs(source.direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
  if (const auto n = find(node, "up")) {
    source.up = readDirection(*n);
    if (glm::length(glm::cross(source.up, source.direction)) < kLeastSine)
      refuse(*n, "is parallel to the direction");
  }
  if (const auto n = find(node, "width")) source.width = readPositive(*n);
  if (const auto n = find(node, "height")) source.height = readPositive(*n);
}

/// How a source with keys moves.
std::optional<LightMotion> readSourceMotion(const JsonNode& node, const LightSource& source) {
  const bool is_sky = source.kind == SourceKind::kEnvironment;
  if (!(is_sky ? hasKeys(node, {"rotate", "color", "intensity"})
               : hasKeys(node, {"position", "direction", "color", "intensity"})))
    return std::nullopt;
  const auto scalar = [](double value) { return glm::dvec4(value, 0, 0, 0); };
  LightMotion motion;
  motion.rotate = readMotion(node, "rotate", [&](const JsonNode& n) { return scalar(readNumber(n)); });
  motion.position =
      readMotion(node, "position", [](const JsonNode& n) { return glm::dvec4(readVector(n), 0); });
  motion.direction =
      readMotion(node, "direction", [](const JsonNode& n) { return glm::dvec4(readDirection(n), 0); });
  motion.color = readMotion(node, "color", [](const JsonNode& n) { return glm::dvec4(readColor(n), 0); });
  motion.intensity = readMotion(node, "intensity",
                                [&](const JsonNode& n) { return scalar(readNumber(n, 0, kLargestNumber)); });
  motion.diffuse = glm::vec3(1.0f);
  if (const auto n = find(node, "color")) motion.diffuse = readColor(*n);
  if (const auto n = find(node, "intensity")) motion.own_intensity = float(readNumber(*n, 0, kLargestNumber));
  LightSource posed = source;
  checkPoses(node, [&](double frame) { return poseSource(motion, frame, posed); });
  return motion;
}

}  // namespace

bool isSource(const JsonNode& light) {
  const auto type = find(light, "type");
  return type && (*type->json == "environment" || *type->json == "rectangle" || *type->json == "disc");
}

void readSource(const JsonNode& node, const SearchFolders& where, std::uint32_t group, Scene& scene) {
  LightSource source;
  if (*need(node, "type").json == "environment")
    readEnvironment(node, where, scene, source);
  else
    readFace(node, source);
  source.group = group;
  if (const auto n = find(node, "color")) source.radiance = readColor(*n);
  if (const auto n = find(node, "intensity")) source.radiance *= float(readNumber(*n, 0, kLargestNumber));
  if (const auto n = find(node, "count")) source.count = std::uint32_t(readCount(*n, kMostSourceLights));
  if (const auto n = find(node, "shadow")) source.shadow = readBool(*n);
  if (const auto n = find(node, "name")) source.name = readText(*n);
  std::optional<LightMotion> motion = readSourceMotion(node, source);
  if (const auto n = find(node, "enabled"); n && !readBool(*n)) return;
  if (source.kind == SourceKind::kEnvironment && environmentOf(scene))
    refuse(node, "a second environment; a scene has one");
  if (motion) {
    motion->light = std::uint32_t(scene.sources.size());
    scene.animation.sources.push_back(std::move(*motion));
  }
  scene.sources.push_back(std::move(source));
}

std::uint32_t readEmits(const JsonNode& node) {
  if (node.json->is_boolean()) return readBool(node) ? kFaceLights : 0;
  return std::uint32_t(readCount(node, kMostSourceLights));
}

}  // namespace luciole
