#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "raster/view.hpp"
#include "scene/bounds.hpp"

namespace luciole {

/// The most cascades of a directional light.
constexpr int kCascades = 4;

/// Metres. Replaces the size 0 of a scene that is a single point. Scene files can't have smaller lengths.
constexpr double kSmallestLength = 1e-18;

/// World space, metres.
struct Sphere {
  glm::dvec3 middle;
  double radius;
};

/// The parts of the camera's view that a directional light's cascades cover, the finest first; 1 to
/// kCascades. The last one reaches as far as the camera sees anything of `scene`, the scene's bounds; each
/// other reaches a third as far as the next. A part larger than the whole scene is replaced by the whole
/// scene, as the last cascade. An orthographic camera has one. They are spheres, so that turning the camera
/// changes no radius. Depends on the whole picture, whatever its crop.
std::vector<Sphere> cascadeSpheres(const View& camera, const Bounds& scene);

}  // namespace luciole
