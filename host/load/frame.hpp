#pragma once

#include <glm/glm.hpp>

#include "scene/scene.hpp"

namespace luciole {

/// A camera that nobody chose, and what it found out about the scene.
struct Framing {
  Camera camera;
  bool inside = false;     ///< it stands in a room of the scene
  double floor = 0;        ///< inside: world y below the eye
  double ceiling = 0;      ///< inside: world y above it
  double view_length = 0;  ///< inside: clear distance ahead, metres
};

/// Looks at the scene as somebody would who wants to see what it is, on a picture of shape 16:9: from outside
/// at a box that holds all of it, or from inside where it is built to be seen from there, like a hall or a
/// game's level. Neither depends on anything random. A scene without geometry is looked at from (0,0,5) along
/// −z.
Framing frameScene(const Scene& scene);

}  // namespace luciole
