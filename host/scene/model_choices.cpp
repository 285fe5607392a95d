#include <algorithm>

#include <fmt/format.h>

#include "luciole/error.hpp"
#include "luciole/scene.hpp"
#include "scene/models.hpp"
#include "shaders/shader_text.hpp"

namespace luciole {

const char* modelName(Model model) {
  return isUserModel(model) ? "a file's" : kModelNames[std::size_t(model)];
}

Model addUserModel(const std::string& path, Scene& scene) {
  Shader shader = readShader(path, ShaderKind::kModel);
  const auto known = std::find(scene.user_models.begin(), scene.user_models.end(), shader);
  const auto index = std::size_t(known - scene.user_models.begin());
  if (index == kMostUserModels)
    throw InputError(fmt::format("{}: the scene has {} models in files already, expected that many at most",
                                 path, kMostUserModels));
  if (known == scene.user_models.end()) {
    for (const std::string& place : shaderFacts(shader, ShaderKind::kModel).loose)
      scene.warnings.push_back({place, kLooseArithmetic});
    scene.user_models.push_back(std::move(shader));
  }
  return userModel(index);
}

ModelChoices modelChoices(const Scene& scene) {
  ModelChoices choices;
  const auto chooses = [](const Material& material) { return material.model.has_value(); };
  if (std::none_of(scene.materials.begin(), scene.materials.end(), chooses)) return choices.set(0);
  const auto add = [&](std::size_t material) { choices.set(modelNumber(scene.materials[material].model)); };
  for (const Object& object : scene.objects) {
    if (object.material >= 0) {
      add(std::size_t(object.material));
      continue;
    }
    for (const std::uint32_t material : scene.meshes[object.mesh].triangle_materials) add(material);
  }
  return choices;
}

void takeFacets(Scene& scene) {
  for (Material& material : scene.materials) {
    if (!material.facets || material.model) continue;
    const double alpha = material.facets->alpha;
    material.specular = material.facets->f0;
    material.shininess = float(2 / (alpha * alpha) - 2);
  }
}

}  // namespace luciole
