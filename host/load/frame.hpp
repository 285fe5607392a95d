#pragma once

#include <glm/glm.hpp>

#include "luciole/scene.hpp"

namespace luciole {

/// A camera chosen for a scene that has none, and what was found out about the scene.
struct Framing {
  Camera camera;
  bool inside = false;     ///< it stands in a room of the scene
  double floor = 0;        ///< inside: world y below the eye
  double ceiling = 0;      ///< inside: world y above it
  double view_length = 0;  ///< inside: clear distance ahead, metres
};

/// Chooses a camera that shows what a scene is, for a picture of shape 16:9. It looks from outside at the box
/// around everything, or from inside where the scene is built to be seen from there, like a hall or a game's
/// level. The choice is deterministic. A scene without geometry is looked at from (0,0,5) along −z. Builds a
/// tree for rays; above 8 million triangles it traces none and looks from outside. Throws MachineError as
/// buildRayScene does.
Framing frameScene(const Scene& scene);

}  // namespace luciole
