#pragma once

#include <glm/glm.hpp>

#include "luciole/scene.hpp"

namespace luciole {

/// A camera chosen for a scene without one, and facts about the scene.
struct Framing {
  Camera camera;
  bool inside = false;     ///< it stands in a room of the scene
  double floor = 0;        ///< inside: world y below the eye
  double ceiling = 0;      ///< inside: world y above it
  double view_length = 0;  ///< inside: clear distance ahead, metres
};

/// Chooses a camera for a picture of aspect 16:9. It looks from outside at the box around everything, or from
/// inside if rays show that the scene is an interior, like a hall or a game's level. Deterministic. For a
/// scene without geometry it looks from (0,0,5) along −z. Above 8 million triangles it traces no rays and
/// looks from outside. Throws MachineError as buildRayScene does.
Framing frameScene(const Scene& scene);

}  // namespace luciole
