#include <algorithm>

#include "luciole/scene.hpp"
#include "scene/models.hpp"

namespace luciole {

const char* modelName(Model model) { return kModelNames[std::size_t(model)]; }

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
