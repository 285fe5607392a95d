#include "luciole/load_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "load/frame.hpp"
#include "load/no_light_warning.hpp"
#include "luciole/error.hpp"
#include "luciole/pose.hpp"
#include "scene/json/json_scene.hpp"
#include "scene/json/mesh_file.hpp"
#include "scene/tangents.hpp"
#include "shaders/shader_text.hpp"

namespace luciole {
namespace {

Light directionalLight(const glm::dvec3& direction, float strength, bool shadow) {
  Light light;
  light.kind = LightKind::kDirectional;
  light.direction = glm::normalize(direction);
  light.diffuse = light.specular = glm::vec3(strength);
  light.shadow = shadow;
  return light;
}

/// Adds a directional light from above with shadows, for daylight through openings of the roof, and lamps
/// along the hall that reach about as far as it is high.
void lightHall(const Framing& framing, Scene& scene) {
  const glm::dmat4& place = framing.camera.camera_to_world;
  const double height = framing.ceiling - framing.floor;
  const double reach = std::max(0.4 * height, 0.12 * framing.view_length);
  scene.lights.push_back(directionalLight({0.25, -1, 0.15}, 0.9f, true));
  for (double share : {0.05, 0.35, 0.65, 0.95}) {
    Light lamp;
    lamp.position = glm::dvec3(place[3]) - glm::dvec3(place[2]) * (share * framing.view_length);
    lamp.position.y = framing.floor + 0.6 * height;
    lamp.diffuse = lamp.specular = glm::vec3(0.8f, 0.7f, 0.55f);
    lamp.attenuation = {1.0f, 0.0f, static_cast<float>(1 / (reach * reach))};
    scene.lights.push_back(lamp);
  }
  scene.ambient = glm::vec3(0.25f);
}

/// Adds a key light over the camera's left shoulder, with shadows, and a weak one from the right, without.
void lightObject(const glm::dmat4& camera_to_world, Scene& scene) {
  const glm::dmat3 axes{camera_to_world};
  scene.lights.push_back(directionalLight(axes * glm::dvec3(0.5, -0.8, -0.9), 0.8f, true));
  scene.lights.push_back(directionalLight(axes * glm::dvec3(-0.9, -0.1, -0.6), 0.25f, false));
  scene.ambient = glm::vec3(0.2f);
}

/// Whether a scene that is lit has no light, no ambient light and no emissive material.
bool isDark(const Scene& scene) {
  const auto glows = [](const Material& material) { return material.emission != glm::vec3(0); };
  return scene.lighting && scene.lights.empty() && scene.ambient == glm::vec3(0) &&
         std::none_of(scene.materials.begin(), scene.materials.end(), glows);
}

/// Gives the scene this environment, in place of its own.
void setEnvironment(const std::string& path, Scene& scene) {
  LightSource sky;
  sky.shadow = true;
  sky.count = kSkyLights;
  sky.sky = readSky(path, scene.warnings);
  scene.says_light = true;
  const auto own = std::find_if(scene.sources.begin(), scene.sources.end(), [](const LightSource& source) {
    return source.kind == SourceKind::kEnvironment;
  });
  if (own == scene.sources.end())
    scene.sources.push_back(std::move(sky));
  else
    own->sky = std::move(sky.sky);
}

/// Expands the light fields. A missing camera is chosen before: frameScene tries the positions of lights, and
/// random ones say nothing of where to stand.
void addLightFields(const std::vector<LightField>& fields, Scene& scene) {
  if (fields.empty()) return;
  poseScene(scene, 1);  // the surfaces that lights lie on
  if (scene.cameras.empty()) {
    scene.cameras.push_back(frameScene(scene).camera);
    scene.adds_camera = true;
  }
  expandLightFields(fields, scene);
}

/// Several faults of a scene's files as one line: ten of them at most, then how many more there are.
std::string joinFaults(const std::vector<std::string>& faults) {
  constexpr std::size_t kMost = 10;
  const std::size_t told = std::min(faults.size(), kMost);
  std::string line =
      fmt::format("{}", fmt::join(faults.begin(), faults.begin() + std::ptrdiff_t(told), "; "));
  if (faults.size() > told) line += fmt::format("; and {} more", faults.size() - told);
  return line;
}

/// Throws InputError for what the settings don't let pass.
void refuseFaults(const Scene& scene, const LoadSettings& settings) {
  std::vector<std::string> faults;
  for (const Warning& warning : scene.warnings)
    if (settings.strict && warning.repaired) faults.push_back(warning.text);
  if (settings.missing == MissingTextures::kError)
    faults.insert(faults.end(), scene.missing_textures.begin(), scene.missing_textures.end());
  if (!faults.empty()) throw InputError(joinFaults(faults));
}

}  // namespace

Scene loadScene(const std::string& path, double frame, const LoadSettings& settings) {
  const bool is_mesh_file = isMeshFile(path);
  Scene scene;
  std::vector<LightField> light_fields;
  std::vector<SceneChange> changes = readChanges(settings.changes);
  if (is_mesh_file) {
    loadMeshFile(path, scene, settings.choice, settings.search);
    scene.name = path;
    changeMaterials(changes, {std::filesystem::path(path).parent_path().string(), settings.search}, scene);
  } else if (path == "-" || extensionOf(path) == ".json") {
    checkIsGltf(path, settings.choice);
    SceneFile read = loadJsonScene(path, settings.search, changes);
    scene = std::move(read.scene);
    light_fields = std::move(read.light_fields);
  } else {
    throw InputError(fmt::format("{}: unknown kind of scene \"{}\"; expected .json, .obj, .gltf or .glb",
                                 path, extensionOf(path)));
  }
  if (!settings.environment.empty()) setEnvironment(settings.environment, scene);
  refuseFaults(scene, settings);
  for (const std::string& texture : scene.missing_textures)
    scene.warnings.push_back({texture + "; drawn without", "missing texture"});
  // Before any pose: deformations keep those at rest.
  addTangents(scene);
  if (settings.tangents || usesTangents(scene.user_models)) addAllTangents(scene);
  addLightFields(light_fields, scene);
  poseScene(scene, 1);
  addSourceLights(scene);
  completeScene(scene, is_mesh_file);
  if (is_mesh_file) changeLoaded(changes, scene);
  if (frame != 1) poseScene(scene, frame);
  return scene;
}

Warning noLightWarning(const Scene& scene) {
  return {scene.name + ": nothing lights this scene", "nothing lights"};
}

void completeScene(Scene& scene, bool is_mesh_file) {
  const bool is_bare = is_mesh_file || !scene.objects.empty();
  const bool needs_lights = is_bare && !scene.says_light && scene.lights.empty();
  if (!needs_lights && isDark(scene)) scene.warnings.push_back(noLightWarning(scene));
  if (!scene.cameras.empty() && !needs_lights) return;
  const Framing framing = frameScene(scene);
  if (scene.cameras.empty()) {
    scene.cameras.push_back(framing.camera);
    scene.adds_camera = true;
  }
  scene.adds_lights = needs_lights;
  if (!needs_lights) return;
  if (framing.inside) {
    lightHall(framing, scene);
  } else {
    lightObject(scene.cameras[0].camera_to_world, scene);
  }
  if (is_mesh_file) scene.background = 0.8f * glm::vec3(0.45f, 0.6f, 0.8f);
}

}  // namespace luciole
