#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/gltf/write_gltf.hpp"

namespace luciole {

/// A profile of a surface of revolution around the y axis: radius and height of its points, in metres. The
/// front is on the right when going from point to point: the outside when going up, the top when going
/// inwards.
struct Profile {
  std::vector<glm::dvec2> points;
  bool smooth = false;  ///< normals are smooth across its corners
};

/// The arc of a surface of revolution: from step `first` to step `last` of the `steps` of a full turn, from
/// +x towards +z.
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
