#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/gltf/write_gltf.hpp"

namespace luciole {

/// A profile to be turned around the y axis: radius and height of its points, in metres. Its front is on the
/// right of the way from point to point: outside where that leads up, above where it leads inwards.
struct Profile {
  std::vector<glm::dvec2> points;
  bool smooth = false;  ///< its corners are rounded by normals
};

/// How a profile is turned: from step `first` to step `last` of `steps` that make a full turn, from +x
/// towards +z.
struct Turn {
  int steps = 32;  ///< a power of two, at least 4
  int first = 0, last = 32;
};
inline Turn fullTurn(int steps) { return {steps, 0, steps}; }

/// `steps` points of the unit circle at equal angles, from +x towards +z: x and z. By square roots alone,
/// which round alike on every machine, as sines don't. `steps`: as Turn's.
std::vector<glm::dvec2> unitCircle(int steps);

/// Appends the surface that a profile sweeps. A profile that ends at radius 0 closes there.
void addLathe(const Profile& profile, const Turn& turn, GltfTriangles& triangles);

/// Appends a flat quadrangle, corners counter-clockwise from its front.
void addQuad(const glm::dvec3 (&corners)[4], GltfTriangles& triangles);

}  // namespace luciole
