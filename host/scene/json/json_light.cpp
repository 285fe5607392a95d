#include "scene/json/json_light.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "scene/json/json_keys.hpp"
#include "scene/json/json_source.hpp"
#include "scene/json/light_list.hpp"
#include "scene/posing.hpp"

namespace luciole {
namespace {

LightKind readKind(const JsonNode& node) {
  const std::string type = readText(node);
  if (type == "point") return LightKind::kPoint;
  if (type == "directional") return LightKind::kDirectional;
  if (type == "spot") return LightKind::kSpot;
  refuse(
      node,
      fmt::format(
          "expected \"point\", \"directional\", \"spot\", \"environment\", \"rectangle\" or \"disc\", got {}",
          node.json->dump()));
}

RangeWindow readWindow(const JsonNode& node) {
  const std::string name = readText(node);
  if (name == "smooth") return RangeWindow::kSmooth;
  if (name == "khr") return RangeWindow::kKhr;
  refuse(node, fmt::format("expected \"smooth\" or \"khr\", got {}", node.json->dump()));
}

/// The light's colours, without its intensity.
void readOwnColors(const JsonNode& node, Light& light) {
  glm::vec3 color{1.0f};
  if (const auto n = find(node, "color")) color = readColor(*n);
  light.ambient = glm::vec3(0);
  light.diffuse = light.specular = color;
  if (const auto n = find(node, "ambient")) light.ambient = readColor(*n);
  if (const auto n = find(node, "diffuse")) light.diffuse = readColor(*n);
  if (const auto n = find(node, "specular")) light.specular = readColor(*n);
}

/// brightness: see readBrightness().
float readOwnIntensity(const JsonNode& node, double brightness) {
  const auto n = find(node, "intensity");
  return static_cast<float>((n ? readNumber(*n, 0, kLargestNumber) : 1.0) * brightness);
}

void readColors(const JsonNode& node, double brightness, Light& light) {
  readOwnColors(node, light);
  const float intensity = readOwnIntensity(node, brightness);
  light.ambient *= intensity;
  light.diffuse *= intensity;
  light.specular *= intensity;
}

/// Reads a direction, or a target. Returns whether there is one.
bool readAim(const JsonNode& node, Light& light) {
  const auto direction = find(node, "direction");
  const auto target = find(node, "target");
  if (direction && target) refuse(*target, "expected either \"direction\" or \"target\", got both");
  if (direction) light.direction = readDirection(*direction);
  if (target) {
    const std::string fault = aimSpot(readVector(*target), light);
    if (!fault.empty()) refuse(*target, fault);
  }
  return direction || target;
}

/// The profile that a light names; null without one.
std::shared_ptr<const LightProfile> readProfile(const JsonNode& node, LightFiles& files, Scene& scene) {
  const auto named = find(node, "profile");
  if (!named) return nullptr;
  std::shared_ptr<const LightProfile>& profile = files.profiles[readText(*named)];
  if (!profile) profile = readLightProfile(readPath(*named, files.where), scene.warnings);
  return profile;
}

/// The number of the luminaire with this profile, turned as the light says. C0 lies towards +x, and the
/// vertical plane of types A and B upwards, unless it does.
std::int32_t readLuminaire(const JsonNode& node, const std::shared_ptr<const LightProfile>& profile,
                           LightFiles& files, Scene& scene) {
  glm::dvec3 up = profile->type == PhotometricType::kC ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  if (const auto n = find(node, "up")) up = readDirection(*n);
  const auto [place, is_new] = files.luminaires.emplace(std::tuple(profile.get(), up.x, up.y, up.z),
                                                        std::int32_t(scene.luminaires.size()));
  if (is_new) scene.luminaires.push_back({profile, up});
  return place->second;
}

/// Lumens of a plain point or spot whose axis has a candela: the integral of its shape over all directions.
double lumensOfCandela(const Light& light) {
  constexpr double kPi = std::numbers::pi;
  if (light.kind == LightKind::kPoint) return 4 * kPi;
  const double edge = std::cos(light.cutoff), inner = std::cos(light.inner_cone);
  if (light.falloff == SpotFalloff::kCone) return 2 * kPi * (1 - inner + (inner - edge) / 3);
  const double power = double(light.exponent) + 1;
  return 2 * kPi * (1 - std::pow(edge, power)) / power;
}

/// The factor by which profile, lumens and candela multiply the colours of a light whose shape is read.
double readBrightness(const JsonNode& node, const Light& light, const LightProfile* profile) {
  const auto lumens = find(node, "lumens"), candela = find(node, "candela");
  if (lumens) refuseKeys(node, {"candela"}, "beside lumens");
  if (lumens || candela) {
    const double wanted = readNumber(lumens ? *lumens : *candela, 0, kLargestNumber);
    const double has = !profile ? lumensOfCandela(light) : lumens ? profile->lumens / profile->peak : 1;
    if (!(has > 0)) refuse(lumens ? *lumens : *candela, "the light has no shape that could give it");
    return wanted / has;
  }
  return profile ? profile->peak : 1;
}

/// Reads a spot's direction and its falloff. With OpenGL's cutoff of 180° it becomes a point light, whatever
/// its exponent and direction; a direction or target is required all the same.
void readSpot(const JsonNode& node, Light& light) {
  if (!readAim(node, light)) refuse(node, "\"direction\" or \"target\" is missing");
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

void readBox(const JsonNode& node, LightField& field) {
  field.low = readVector(need(node, "min"));
  field.high = readVector(need(node, "max"));
  for (int i = 0; i < 3; ++i) {
    if (field.low[i] > field.high[i])
      refuse(need(node, "min"), fmt::format("[{}] is above that of \"max\"", i));
  }
}

void readCurve(const JsonNode& node, LightField& field) {
  const JsonNode points = need(node, "points");
  needArray(points);
  for (std::size_t i = 0; i < points.json->size(); ++i)
    field.points.push_back(readVector(element(points, i)));
  if (field.points.size() < 2)
    refuse(points, fmt::format("{} points, expected 2 or more", field.points.size()));
  field.radius = 0;
  if (const auto n = find(node, "radius")) field.radius = readNumber(*n, 0, kLargestNumber);
}

void readShape(const JsonNode& node, LightField& field) {
  std::string name = "box";
  if (const auto n = find(node, "shape")) {
    name = readText(*n);
    const auto shape = fieldShapeNamed(name);
    if (!shape) refuse(*n, fmt::format("expected {}, got {}", kFieldShapeNames, n->json->dump()));
    field.shape = *shape;
  }
  const std::string where = "for the shape " + name;
  switch (field.shape) {
    case FieldShape::kBox:
      refuseKeys(node, {"center", "radius", "offset", "clusters", "points"}, where);
      readBox(node, field);
      break;
    case FieldShape::kBall:
    case FieldShape::kSphere:
      refuseKeys(node, {"min", "max", "offset", "clusters", "points"}, where);
      field.center = readVector(need(node, "center"));
      field.radius = readPositive(need(node, "radius"));
      break;
    case FieldShape::kSurface:
      refuseKeys(node, {"min", "max", "center", "radius", "clusters", "points"}, where);
      if (const auto n = find(node, "offset")) field.offset = readNumber(*n);
      break;
    case FieldShape::kClusters:
      refuseKeys(node, {"center", "offset", "points"}, where);
      readBox(node, field);
      field.radius = readPositive(need(node, "radius"));
      field.clusters = readCount(need(node, "clusters"), kMostLights);
      if (field.clusters == 0) refuse(need(node, "clusters"), "expected 1 or more");
      break;
    case FieldShape::kCurve:
      refuseKeys(node, {"min", "max", "center", "offset", "clusters"}, where);
      readCurve(node, field);
      break;
    case FieldShape::kList:
      break;
  }
}

void readList(const JsonNode& csv, const JsonNode& node, const SearchFolders& where, LightField& field) {
  refuseKeys(node,
             {"shape", "min", "max", "center", "radius", "offset", "clusters", "points", "color", "colors",
              "no_range"},
             "beside csv");
  std::optional<std::uint64_t> count;
  if (const auto n = find(node, "count")) count = readCount(*n, kMostLights);
  field.shape = FieldShape::kList;
  field.list = readLightList(readPath(csv, where), count);
  field.count = field.list.size();
}

/// The number of the group that a light or a field names; that of lights without a group where it doesn't.
std::uint32_t readGroup(const JsonNode& node, LightGroupNumbers& groups, Scene& scene) {
  const auto n = find(node, "group");
  if (!n) return 0;
  const std::string name = readText(*n);
  if (const std::string fault = faultOfGroupName(name); !fault.empty()) refuse(*n, fault);
  return lightGroupNumber(name, groups, scene);
}

/// How a light with keys moves. Refuses keys for members that the light itself doesn't have.
std::optional<LightMotion> readLightMotion(const JsonNode& node, const Light& light, double brightness) {
  if (!hasKeys(node, {"position", "direction", "target", "color", "intensity", "range"})) return std::nullopt;
  const auto vector = [](const JsonNode& n) { return glm::dvec4(readVector(n), 0); };
  /// The curve of a member that needs the light's own member `own`.
  const auto curveWith = [&](const char* member, const char* own, const ReadValue& read) {
    return readMotion(node, member, [&](const JsonNode& n) {
      // A profile's light has a direction without saying it.
      const bool is_default = light.luminaire >= 0 && std::string_view(own) != "position" &&
                              !find(node, "direction") && !find(node, "target");
      if (!find(node, own) && !is_default)
        refuse(n, fmt::format("means nothing for a light without its own \"{}\"", own));
      return read(n);
    });
  };
  LightMotion motion;
  motion.position = curveWith("position", "position", vector);
  motion.range =
      curveWith("range", "position", [](const JsonNode& n) { return glm::dvec4(readPositive(n), 0, 0, 0); });
  motion.direction =
      curveWith("direction", "direction", [](const JsonNode& n) { return glm::dvec4(readDirection(n), 0); });
  motion.target = curveWith("target", "target", vector);
  const auto target = find(node, "target");
  if (target && motion.target.keys.empty() && !motion.position.keys.empty())
    motion.target = constantCurve(vector(*target));
  if (light.kind == LightKind::kPoint && light.luminaire < 0)
    motion.direction.keys = motion.target.keys = {};  // a cutoff of 180
  motion.color = readMotion(node, "color", [&](const JsonNode& n) {
    if (find(node, "diffuse") || find(node, "specular"))
      refuse(n, "means nothing for a light with \"diffuse\" or \"specular\"");
    return glm::dvec4(readColor(n), 0);
  });
  motion.intensity = readMotion(node, "intensity", [&](const JsonNode& n) {
    return glm::dvec4(readNumber(n, 0, kLargestNumber) * brightness, 0, 0, 0);
  });
  Light plain;
  readOwnColors(node, plain);
  motion.ambient = plain.ambient;
  motion.diffuse = plain.diffuse;
  motion.specular = plain.specular;
  motion.own_intensity = readOwnIntensity(node, brightness);
  Light posed = light;
  checkPoses(node, [&](double frame) { return poseLight(motion, frame, posed); });
  return motion;
}

}  // namespace

void readLight(const JsonNode& node, LightGroupNumbers& groups, LightFiles& files, Scene& scene) {
  if (isSource(node)) {
    readSource(node, files.where, readGroup(node, groups, scene), scene);
    return;
  }
  allowKeys(node,
            {"type",       "position", "direction",   "target",  "color",   "intensity", "ambient",
             "diffuse",    "specular", "attenuation", "range",   "cutoff",  "exponent",  "inner_cone",
             "outer_cone", "shadow",   "radius",      "angle",   "enabled", "keys",      "interpolation",
             "group",      "name",     "window",      "profile", "up",      "lumens",    "candela"});
  Light light;
  light.kind = readKind(need(node, "type"));
  std::shared_ptr<const LightProfile> profile;
  if (light.kind == LightKind::kDirectional) {
    refuseKeys(node, {"position", "target", "attenuation", "range", "radius", "profile", "lumens"},
               "for a directional light");
    refuseKeys(node, {"window"}, "for a light without a range");
    light.direction = readDirection(need(node, "direction"));
    if (const auto n = find(node, "angle")) light.half_angle = glm::radians(readNumber(*n, 0, 90)) / 2;
  } else {
    refuseKeys(node, {"angle"}, "for a light with a position");
    light.position = readVector(need(node, "position"));
    if (const auto n = find(node, "radius")) light.radius = readNumber(*n, 0, kLargestNumber);
    profile = readProfile(node, files, scene);
    if (profile || find(node, "lumens")) light.attenuation = {0, 0, 1};
    if (const auto n = find(node, "attenuation")) light.attenuation = readAttenuation(*n);
    if (const auto n = find(node, "range")) light.range = static_cast<float>(readPositive(*n));
    if (const auto n = find(node, "window")) light.window = readWindow(*n);
  }
  if (!profile) refuseKeys(node, {"up", "candela"}, "for a light without a profile");
  if (light.kind == LightKind::kPoint && !profile)
    refuseKeys(node, {"direction", "target"}, "for a point light without a profile");
  if (light.kind == LightKind::kPoint && profile && !readAim(node, light)) light.direction = {0, -1, 0};
  if (light.kind == LightKind::kSpot) {
    readSpot(node, light);
  } else {
    refuseKeys(node, {"cutoff", "exponent", "inner_cone", "outer_cone"}, "for a light that isn't a spot");
  }
  if (profile) light.luminaire = readLuminaire(node, profile, files, scene);
  const double brightness = readBrightness(node, light, profile.get());
  readColors(node, brightness, light);
  for (const glm::vec3& color : {light.ambient, light.diffuse, light.specular})
    if (!std::isfinite(color.x + color.y + color.z)) refuse(node, "is brighter than floats can say");
  if (const auto n = find(node, "shadow")) light.shadow = readBool(*n);
  light.group = readGroup(node, groups, scene);
  if (const auto n = find(node, "name")) light.name = readText(*n);
  std::optional<LightMotion> motion = readLightMotion(node, light, brightness);
  if (const auto n = find(node, "enabled"); n && !readBool(*n)) return;
  if (motion) {
    motion->light = static_cast<std::uint32_t>(scene.lights.size());
    scene.animation.lights.push_back(std::move(*motion));
  }
  scene.lights.push_back(light);
}

LightField readLightField(const JsonNode& node, const SearchFolders& where, LightGroupNumbers& groups,
                          Scene& scene) {
  allowKeys(node, {"count",  "seed",   "shape",       "min",      "max",    "center", "radius",
                   "offset", "points", "clusters",    "csv",      "color",  "colors", "intensity",
                   "range",  "cutoff", "attenuation", "no_range", "shadow", "group"});
  LightField field;
  if (const auto n = find(node, "seed"))
    field.seed = readCount(*n, std::numeric_limits<std::uint64_t>::max());
  if (const auto csv = find(node, "csv")) {
    readList(*csv, node, where, field);
  } else {
    field.count = readCount(need(node, "count"), kMostLights);
    readShape(node, field);
  }
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
  if (const auto n = find(node, "cutoff")) {
    refuseKeys(node, {"range", "attenuation"}, "beside cutoff");
    field.cutoff = readPositive(*n);
    field.attenuation = glm::vec3(0, 0, 1);
  }
  if (const auto n = find(node, "no_range")) {
    refuseKeys(node, {"range", "cutoff", "attenuation"}, "beside no_range");
    field.no_range = readBool(*n);
  }
  if (const auto n = find(node, "shadow")) field.shadow = readBool(*n);
  field.group = readGroup(node, groups, scene);
  return field;
}

}  // namespace luciole
