#include <algorithm>

#include "scene/scene.hpp"

namespace luciole {

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

}  // namespace luciole
