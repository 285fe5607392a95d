#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "luciole/scene.hpp"

// What the page may change of a scene that is loaded.
namespace luciole {

/// The values of a scene that may change while it is looked at.
struct SceneValues {
  std::vector<Light> lights;  ///< with those of sources
  std::size_t source_lights = 0;
  std::vector<LightSource> sources;
  std::vector<Material> materials;
  std::vector<Shader> user_models;
  std::vector<std::string> light_groups;
  glm::vec3 ambient{0.0f}, background{0.0f};
  Fog fog;
  bool lighting = true;
};
SceneValues valuesOf(const Scene& scene);
void setValues(const SceneValues& values, Scene& scene);

/// The changes of the page as --set has them: a colour #rrggbb, or #rrggbb*STRENGTH, becomes a list of linear
/// numbers, and "fog.color=…" goes into the "fog=…" before it. Throws InputError for a place that the page
/// may not change: names of files, above all.
std::vector<std::string> numberedChanges(const std::vector<std::string>& changes);

/// Makes these changes in a scene that is loaded. Throws InputError.
void makeChanges(const std::vector<std::string>& numbered, Scene& scene);

}  // namespace luciole
