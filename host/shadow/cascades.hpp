#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "raster/view.hpp"
#include "scene/bounds.hpp"

namespace luciole {

/// Of a directional light, at most.
constexpr int kCascades = 4;

/// Metres; in place of 0, where all of a scene is one point. Files may have lengths from here on.
constexpr double kSmallestLength = 1e-18;

/// World space, metres.
struct Sphere {
  glm::dvec3 middle;
  double radius;
};

/// What a directional light's cascades cover, the finest first: parts of the camera's view, or all of the
/// scene where that is smaller. Under a parallel camera only one. The last reaches to the farthest that the
/// camera sees of the scene's bounds, each other a third as far as the next. Spheres, so that a camera that
/// turns changes no radius. Depends on all that the camera sees, whatever its crop.
std::vector<Sphere> cascadeSpheres(const View& camera, const Bounds& scene);

}  // namespace luciole
