#include "luciole/scene.hpp"

namespace luciole {

void addSourceLights(Scene& scene) {
  scene.lights.resize(scene.lights.size() - scene.source_lights);
  scene.source_lights = 0;
}

}  // namespace luciole
