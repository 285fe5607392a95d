#include "scene/gltf/gltf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "base/did_you_mean.hpp"
#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/gltf/gltf_animation.hpp"
#include "scene/gltf/gltf_model.hpp"
#include "scene/gltf/gltf_nodes.hpp"
#include "scene/gltf/gltf_objects.hpp"
#include "scene/light_groups.hpp"
#include "scene/posing.hpp"
#include "scene/profiles/profile_table.hpp"

namespace luciole {
namespace {

constexpr const char* kLights = "KHR_lights_punctual";
constexpr double kPi = 3.14159265358979323846;
constexpr double kNearOfFar = 1e-6;  ///< where a near plane is at 0

void addCamera(const GltfModel& model, const PlacedNode& placed, Scene& scene) {
  const GltfNode& node = model.file.nodes[std::size_t(placed.node)];
  const GltfCamera& source =
      element(model, model.file.cameras, node.camera, nodePlace(placed.node), "camera");
  const std::string place = fmt::format("cameras[{}]", node.camera);
  const auto leaveOut = [&](const std::string& what) {
    warnRepaired(model, place, what + "; left out", "camera");
  };
  Camera camera;
  camera.name = source.name.empty() ? node.name : source.name;
  const std::string fault = attachCamera(placed.to_world, camera);
  if (!fault.empty()) return warnLeftOut(model, nodePlace(placed.node), fault + "; left out", "camera");
  camera.orthographic = source.orthographic;
  camera.far = source.far.value_or(std::numeric_limits<double>::infinity());
  camera.near = source.near.value_or(0);
  if (camera.orthographic) {
    camera.half_height = std::abs(source.ymag.value_or(0));
    if (!source.ymag) return leaveOut("has no ymag");
    if (!(camera.half_height > 0)) return leaveOut("ymag is 0");
    if (*source.ymag < 0)
      warnRepaired(model, place, fmt::format("ymag is {}, taken for {}", *source.ymag, camera.half_height),
                   "ymag");
    if (!source.far) return leaveOut("has no zfar");
    if (!std::isfinite(camera.far) || !(camera.far > std::max(camera.near, 0.0)))
      return leaveOut(fmt::format("zfar is {}, expected more than znear {}", camera.far, camera.near));
    // glTF allows 0 here; Camera::near must be above 0.
    if (camera.near == 0) camera.near = kNearOfFar * camera.far;
  } else {
    if (!source.yfov) return leaveOut("has no yfov");
    camera.fov_y = *source.yfov;
    if (!(camera.fov_y > 0 && camera.fov_y < kPi))
      return leaveOut(fmt::format("yfov is {}, expected one between 0 and pi", camera.fov_y));
    if (!(camera.far > std::max(camera.near, 0.0))) {
      warnRepaired(
          model, place,
          fmt::format("zfar is {}, expected more than znear {}; taken for infinite", camera.far, camera.near),
          "zfar");
      camera.far = std::numeric_limits<double>::infinity();
    }
  }
  if (!(camera.near > 0)) {
    const double near = std::isfinite(camera.far) ? kNearOfFar * camera.far : 1e-3;
    const std::string what = source.near ? fmt::format("znear is {}", camera.near) : "has no znear";
    warnRepaired(model, place, fmt::format("{}, taken for {:.6g}", what, near), "znear");
    camera.near = near;
  }
  const char* const type = camera.orthographic ? "orthographic" : "perspective";
  if (source.type != type)
    warnRepaired(model, place, fmt::format("type is '{}', taken for {}", forMessage(source.type), type),
                 "type");
  if (placed.moving >= 0)
    scene.animation.attached_cameras.push_back({static_cast<std::uint32_t>(scene.cameras.size()),
                                                static_cast<std::uint32_t>(placed.moving), placed.since});
  scene.cameras.push_back(camera);
}

/// The group that a light's node, or else the light, names: a text "group" in its extras. Extras are
/// anybody's, so one that can't be a group's name is told and left out.
std::uint32_t groupOf(const GltfModel& model, int node, const std::optional<std::string>& of_light,
                      LightGroupNumbers& groups, Scene& scene) {
  for (const std::optional<std::string>& name : {model.file.nodes[std::size_t(node)].group, of_light}) {
    if (!name) continue;
    const std::string fault = faultOfGroupName(*name);
    if (fault.empty()) return lightGroupNumber(*name, groups, scene);
    warnLeftOut(model, nodePlace(node), fmt::format("extras.group: {}; left out", fault), "group");
  }
  return 0;
}

/// Sets a spot's cone. Returns whether it has one.
bool setCone(const GltfModel& model, const GltfLight& source, const std::string& place, Light& light) {
  double inner = source.inner_cone;
  light.kind = LightKind::kSpot;
  light.falloff = SpotFalloff::kCone;
  light.cutoff = source.outer_cone;
  if (!(light.cutoff > 0)) {
    warnRepaired(model, place,
                 fmt::format("outerConeAngle is {}, expected more than 0; left out", light.cutoff), "cone");
    return false;
  }
  if (light.cutoff > kPi / 2) {
    // π/2 as a decimal may have been rounded up.
    if (light.cutoff > kPi / 2 + 1e-5)
      warnRepaired(model, place, fmt::format("outerConeAngle is {}, taken for pi/2", light.cutoff), "cone");
    light.cutoff = kPi / 2;
  }
  if (inner < 0 || inner > source.outer_cone) {
    const double repaired = inner < 0 ? 0 : light.cutoff;
    warnRepaired(model, place, fmt::format("innerConeAngle is {}, taken for {}", inner, repaired), "cone");
    inner = repaired;
  }
  // Programs write inner = outer for a sharp edge; Light::inner_cone must be below the cutoff.
  light.inner_cone = std::min(inner, light.cutoff * (1 - 1e-6));
  return true;
}

/// A light's colour: white without one.
glm::vec3 colorOf(const GltfModel& model, const std::string& place, const std::vector<double>& numbers) {
  glm::vec3 color(1);
  if (!numbers.empty() && numbers.size() != 3)
    warnRepaired(model, place, fmt::format("color has {} numbers, expected 3", numbers.size()), "color");
  for (std::size_t i = 0; i < std::min<std::size_t>(numbers.size(), 3); ++i) {
    if (numbers[i] < 0)
      warnRepaired(model, place, fmt::format("color has {}, taken for 0", numbers[i]), "negative light");
    color[static_cast<int>(i)] = static_cast<float>(std::max(numbers[i], 0.0));
  }
  return color;
}

/// Places a light and adds it to the scene. group, name: the light's own.
void placeLight(const GltfModel& model, const PlacedNode& placed, const std::optional<std::string>& group,
                const std::string& name, LightGroupNumbers& groups, Scene& scene, Light& light) {
  light.over_pi = true;
  const std::string fault = attachLight(placed.to_world, scene.luminaires, light);
  // What moves may have a scale of 0 for a while, and is kept.
  if (placed.moving < 0 && !fault.empty())
    return warnLeftOut(model, nodePlace(placed.node), fault + "; left out", "light");
  light.group = groupOf(model, placed.node, group, groups, scene);
  const std::string& node_name = model.file.nodes[placed.node].name;
  light.name = node_name.empty() ? name : node_name;
  if (placed.moving >= 0)
    scene.animation.attached_lights.push_back({static_cast<std::uint32_t>(scene.lights.size()),
                                               static_cast<std::uint32_t>(placed.moving), placed.since});
  scene.lights.push_back(light);
}

/// KHR_lights_punctual. Its intensities are candela and lux, and its Lambertian surface reflects base colour
/// / π; our diffuse term has no 1/π, so the light carries it: diffuse = specular = colour · intensity / π. A
/// surface then has the radiance in cd/m² that glTF gives it. Lights cast no shadow, as glTF says nothing of
/// shadows.
void addLight(const GltfModel& model, const PlacedNode& placed, LightGroupNumbers& groups, Scene& scene) {
  const int number = model.file.nodes[std::size_t(placed.node)].light;
  const GltfLight& source = element(model, model.file.lights, number, nodePlace(placed.node), "light");
  const std::string place = fmt::format("extensions.{}.lights[{}]", kLights, number);
  const auto kind = [&](const char* name) { return equalIgnoringCase(source.type, name); };
  Light light;
  const glm::vec3 color = colorOf(model, place, source.color);
  if (source.intensity < 0)
    warnRepaired(model, place, fmt::format("intensity is {}, taken for 0", source.intensity),
                 "negative light");
  light.diffuse = light.specular = color * static_cast<float>(std::max(source.intensity, 0.0) / kPi);
  if (!std::isfinite(light.diffuse.x + light.diffuse.y + light.diffuse.z))
    failGltf(model, place, "color and intensity are too large");
  if (source.type != "directional" && source.type != "point" && source.type != "spot")
    warnRepaired(model, place,
                 fmt::format("type is '{}', expected point, directional or spot{}", forMessage(source.type),
                             kind("directional") || kind("point") || kind("spot") ? "" : "; left out"),
                 "light type");
  if (kind("directional")) {
    light.kind = LightKind::kDirectional;
  } else if (kind("point") || kind("spot")) {
    light.attenuation = {0, 0, 1};
    light.window = RangeWindow::kKhr;
    if (source.range && static_cast<float>(*source.range) > 0)
      light.range = static_cast<float>(*source.range);
    else if (source.range)
      warnRepaired(model, place, fmt::format("range is {}, taken for infinite", *source.range), "range");
    if (kind("spot") && !setCone(model, source, place, light)) return;
  } else {
    return;
  }
  placeLight(model, placed, source.group, source.name, groups, scene, light);
}

/// EXT_lights_ies: a luminaire that shines along the node's −z, its C 0 along +x. Its candela are over π, as
/// other lights' intensities are. profiles: of the file's profiles those that were read.
void addLuminaire(const GltfModel& model, const PlacedNode& placed, LightGroupNumbers& groups,
                  std::map<int, std::shared_ptr<const LightProfile>>& profiles, Scene& scene) {
  const GltfLuminaire& node = model.file.nodes[std::size_t(placed.node)].luminaire;
  const GltfImage& source =
      element(model, model.file.profiles, node.profile, nodePlace(placed.node), "light profile");
  const std::string place = profilePlace(std::size_t(node.profile));
  std::shared_ptr<const LightProfile>& profile = profiles[node.profile];
  if (!profile && !source.file.empty()) {
    profile = readLightProfile(source.file, scene.warnings);
  } else if (!profile) {
    const std::span<const std::byte> bytes =
        source.view >= 0 ? viewBytes(model, source.view, place) : source.bytes;
    if (bytes.empty())
      failGltf(model, place,
               source.uri.empty() ? "has no file, expected uri or bufferView"
                                  : fmt::format("there is no file '{}'", forMessage(source.uri)));
    profile = parseLightProfile({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                                fmt::format("{}: {}", model.path, place), scene.warnings);
  }
  if (node.multiplier < 0)
    warnRepaired(model, nodePlace(placed.node), fmt::format("multiplier is {}, taken for 0", node.multiplier),
                 "negative light");
  Light light;
  light.attenuation = {0, 0, 1};
  light.luminaire = static_cast<std::int32_t>(scene.luminaires.size());
  light.diffuse = light.specular =
      glm::min(colorOf(model, nodePlace(placed.node), node.color), glm::vec3(1)) *
      float(std::max(node.multiplier, 0.0) * profile->peak / kPi);
  if (!std::isfinite(light.diffuse.x + light.diffuse.y + light.diffuse.z))
    failGltf(model, nodePlace(placed.node), "multiplier is too large");
  scene.luminaires.push_back({profile});
  placeLight(model, placed, std::nullopt, source.name, groups, scene, light);
}

std::string listNames(const std::vector<std::string>& names) {
  return names.empty() ? "none" : forMessage(fmt::format("{}", fmt::join(names, ", ")));
}

int findVariant(const std::string& path, const std::vector<std::string>& names, const std::string& wanted) {
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (found == names.end())
    throw InputError(fmt::format("{}: has no variant '{}'{}; it has {}", path, forMessage(wanted),
                                 forMessage(didYouMean(wanted, names)), listNames(names)));
  return static_cast<int>(found - names.begin());
}

/// By name, or else counted from 0.
int findAnimation(const std::string& path, const std::vector<std::string>& names, const std::string& wanted) {
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (found == names.end()) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error == std::errc() && end == wanted.data() + wanted.size() && index < names.size())
      return static_cast<int>(index);
    throw InputError(fmt::format("{}: has no animation '{}'{}; it has {}, by name or counted from 0", path,
                                 forMessage(wanted), forMessage(didYouMean(wanted, names)),
                                 listNames(names)));
  }
  if (std::find(found + 1, names.end(), wanted) != names.end())
    throw InputError(fmt::format("{}: has several animations '{}'; expected a number, counted from 0", path,
                                 forMessage(wanted)));
  return static_cast<int>(found - names.begin());
}

}  // namespace

void loadGltf(const std::string& path, Scene& scene, const GltfChoice& choice,
              const std::vector<std::string>& search) {
  GltfModel model = readGltfModel(path, search, scene.warnings);
  scene.variants = variantNames(model);
  scene.animations = animationNames(model);
  if (!choice.variant.empty()) model.variant = findVariant(path, scene.variants, choice.variant);
  if (!choice.animation.empty()) model.animation = findAnimation(path, scene.animations, choice.animation);
  for (const std::string& extension : ignoredExtensions(model)) {
    warnLeftOut(model, "extensionsUsed",
                fmt::format("'{}' is not supported and left out", forMessage(extension)), "extension");
    std::vector<std::string>& all = scene.ignored_extensions;
    if (std::find(all.begin(), all.end(), extension) == all.end()) all.push_back(extension);
  }
  const std::map<int, NodeCurves> curves = readGltfAnimations(model, scene.animation);
  const std::vector<PlacedNode> nodes = placedNodes(model, curves, scene.animation);
  const std::size_t before = scene.objects.size() + scene.cameras.size() + scene.lights.size();
  addGltfObjects(model, nodes, curves, scene);
  LightGroupNumbers groups = lightGroupNumbers(scene);
  std::map<int, std::shared_ptr<const LightProfile>> profiles;
  for (const PlacedNode& placed : nodes) {
    if (!placed.shown) continue;
    const GltfNode& node = model.file.nodes[std::size_t(placed.node)];
    if (node.camera >= 0) addCamera(model, placed, scene);
    if (node.light >= 0) addLight(model, placed, groups, scene);
    if (node.luminaire.profile >= 0) addLuminaire(model, placed, groups, profiles, scene);
  }
  if (scene.objects.size() + scene.cameras.size() + scene.lights.size() == before) {
    failGltf(model, "scene", "shows nothing, expected a mesh, a light or a camera");
  }
}

}  // namespace luciole
