#include "scene/gltf/gltf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <vector>

#include "base/did_you_mean.hpp"
#include "base/error.hpp"
#include "base/text_file.hpp"
#include "scene/gltf/gltf_animation.hpp"
#include "scene/gltf/gltf_model.hpp"
#include "scene/gltf/gltf_nodes.hpp"
#include "scene/gltf/gltf_objects.hpp"
#include "scene/light_groups.hpp"
#include "scene/pose.hpp"

namespace luciole {
namespace {

constexpr const char* kLights = "KHR_lights_punctual";
constexpr double kPi = 3.14159265358979323846;

void addCamera(const GltfModel& model, const PlacedNode& placed, Scene& scene) {
  const tinygltf::Node& node = model.file.nodes[placed.node];
  const tinygltf::Camera& source =
      element(model, model.file.cameras, node.camera, nodePlace(placed.node), "camera");
  const std::string place = fmt::format("cameras[{}]", node.camera);
  Camera camera;
  camera.name = source.name.empty() ? node.name : source.name;
  const std::string fault = attachCamera(placed.to_world, camera);
  if (!fault.empty()) failGltf(model, nodePlace(placed.node), fault);
  camera.orthographic = source.type == "orthographic";
  if (camera.orthographic) {
    camera.half_height = std::abs(source.orthographic.ymag);
    camera.far = source.orthographic.zfar;
    // glTF allows 0 here; Camera::near must be above 0.
    camera.near = source.orthographic.znear == 0 ? 1e-6 * camera.far : source.orthographic.znear;
    if (!(camera.half_height > 0)) failGltf(model, place, "ymag is 0");
  } else {
    camera.fov_y = source.perspective.yfov;
    camera.near = source.perspective.znear;
    // Without zfar glTF's projection is infinite.
    camera.far = source.perspective.zfar == 0 ? 1e6 * camera.near : source.perspective.zfar;
    if (!(camera.fov_y > 0 && camera.fov_y < kPi)) failGltf(model, place, "yfov must be between 0 and pi");
  }
  if (!(camera.near > 0 && camera.far > camera.near)) failGltf(model, place, "expected 0 < znear < zfar");
  if (placed.moving >= 0)
    scene.animation.attached_cameras.push_back({static_cast<std::uint32_t>(scene.cameras.size()),
                                                static_cast<std::uint32_t>(placed.moving), placed.since});
  scene.cameras.push_back(camera);
}

/// The group that a light's node, or else the light, names: a text "group" in its extras. Extras are
/// anybody's, so one that can't be a group's name is told and left out.
std::uint32_t groupOf(const GltfModel& model, int node, const tinygltf::Light& light,
                      LightGroupNumbers& groups, Scene& scene) {
  for (const tinygltf::Value* extras : {&model.file.nodes[node].extras, &light.extras}) {
    if (!extras->IsObject() || !extras->Get("group").IsString()) continue;
    const std::string name = extras->Get("group").Get<std::string>();
    const std::string fault = faultOfGroupName(name);
    if (fault.empty()) return lightGroupNumber(name, groups, scene);
    scene.warnings.push_back(
        {fmt::format("{}: {}: extras.group: {}; left out", model.path, nodePlace(node), fault), "group"});
  }
  return 0;
}

/// KHR_lights_punctual. Its intensities are candela and lux, and its Lambertian surface reflects base colour
/// / π; our diffuse term has no 1/π, so the light carries it: diffuse = specular = colour · intensity / π. A
/// surface then has the radiance in cd/m² that glTF gives it. Lights cast no shadow, as glTF says nothing of
/// shadows.
void addLight(const GltfModel& model, const PlacedNode& placed, double index, LightGroupNumbers& groups,
              Scene& scene) {
  const int number = index >= 0 && index < 1e9 ? static_cast<int>(index) : -1;
  const tinygltf::Light& source = element(model, model.file.lights, number, nodePlace(placed.node), "light");
  const std::string place = fmt::format("extensions.{}.lights[{}]", kLights, number);
  Light light;
  glm::vec3 color(1);
  for (std::size_t i = 0; i < std::min<std::size_t>(source.color.size(), 3); ++i) {
    color[static_cast<int>(i)] = static_cast<float>(source.color[i]);
  }
  light.diffuse = light.specular = color * static_cast<float>(source.intensity / kPi);
  for (int i = 0; i < 3; ++i) {
    if (!(light.diffuse[i] >= 0 && std::isfinite(light.diffuse[i]))) {
      failGltf(model, place, "color and intensity must be at least 0 and finite");
    }
  }
  if (source.type == "directional") {
    light.kind = LightKind::kDirectional;
  } else {
    light.attenuation = {0, 0, 1};
    light.window = RangeWindow::kKhr;
    if (source.range != 0) light.range = static_cast<float>(source.range);
    if (!(light.range > 0)) failGltf(model, place, "range must be above 0");
  }
  if (source.type == "spot") {
    light.kind = LightKind::kSpot;
    light.falloff = SpotFalloff::kCone;
    light.cutoff = source.spot.outerConeAngle;
    // Programs write inner = outer for a sharp edge; Light::inner_cone must be below the cutoff.
    light.inner_cone = std::min(source.spot.innerConeAngle, light.cutoff * (1 - 1e-6));
    // π/2 as a decimal may have been rounded up.
    if (light.cutoff > kPi / 2 && light.cutoff < kPi / 2 + 1e-5) light.cutoff = kPi / 2;
    if (!(light.cutoff > 0 && light.cutoff <= kPi / 2 && source.spot.innerConeAngle >= 0 &&
          source.spot.innerConeAngle <= source.spot.outerConeAngle)) {
      failGltf(model, place, "expected 0 <= innerConeAngle < outerConeAngle <= pi/2");
    }
  } else if (source.type != "point" && source.type != "directional") {
    failGltf(model, place, "type must be point, directional or spot");
  }
  const std::string fault = attachLight(placed.to_world, light);
  if (!fault.empty()) failGltf(model, nodePlace(placed.node), fault);
  light.group = groupOf(model, placed.node, source, groups, scene);
  const std::string& node_name = model.file.nodes[placed.node].name;
  light.name = node_name.empty() ? source.name : node_name;
  if (placed.moving >= 0)
    scene.animation.attached_lights.push_back({static_cast<std::uint32_t>(scene.lights.size()),
                                               static_cast<std::uint32_t>(placed.moving), placed.since});
  scene.lights.push_back(light);
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
              const std::vector<std::string>& /*search*/) {
  GltfModel model = readGltfModel(path);
  scene.variants = variantNames(model);
  scene.animations = animationNames(model);
  if (!choice.variant.empty()) model.variant = findVariant(path, scene.variants, choice.variant);
  if (!choice.animation.empty()) model.animation = findAnimation(path, scene.animations, choice.animation);
  for (const std::string& extension : ignoredExtensions(model)) {
    scene.warnings.push_back(
        {fmt::format("{}: extensionsUsed: '{}' is not supported and left out", path, forMessage(extension)),
         "extension"});
    std::vector<std::string>& all = scene.ignored_extensions;
    if (std::find(all.begin(), all.end(), extension) == all.end()) all.push_back(extension);
  }
  const std::map<int, NodeCurves> curves = readGltfAnimations(model, scene.animation);
  const std::vector<PlacedNode> nodes = placedNodes(model, curves, scene.animation);
  const std::size_t before = scene.objects.size() + scene.cameras.size() + scene.lights.size();
  addGltfObjects(model, nodes, curves, scene);
  LightGroupNumbers groups = lightGroupNumbers(scene);
  for (const PlacedNode& placed : nodes) {
    if (!placed.shown) continue;
    const tinygltf::Node& node = model.file.nodes[placed.node];
    if (node.camera >= 0) addCamera(model, placed, scene);
    if (node.extensions.count(kLights)) {
      addLight(model, placed, extensionNumber(node.extensions, kLights, "light", -1), groups, scene);
    }
  }
  if (scene.objects.size() + scene.cameras.size() + scene.lights.size() == before) {
    failGltf(model, "scene", "shows nothing, expected a mesh, a light or a camera");
  }
}

}  // namespace luciole
