#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/gltf/write_gltf.hpp"

namespace luciole {

// An open-air theatre, y up, in metres: rows of seats around a round stage with a temple on it, columns along
// the top, cypresses and paving where the audience comes in. It is looked at from there.

/// The radius of the disc around the y axis in which lamps may be.
inline constexpr double kTheatreRadius = 37.0;
/// The radius of the temple's roof, and the largest height of lamps below it.
inline constexpr double kTempleRadius = 6.6, kTempleRoom = 4.4;
/// The eye of the file's camera.
inline constexpr glm::dvec3 kTheatreEye{0.0, 12.0, 47.0};

/// An obstacle that stands on the ground: its bounding circle, as x, z and radius.
struct Standing {
  glm::dvec2 center;
  double radius;
};

/// The columns, pedestals and trees.
std::vector<Standing> standingThings();

/// The height of the ground at x, z, and the distance along the radius, outwards, to the middle of the row
/// there; 0 outside of the rows.
struct Ground {
  double height, to_middle;
};
Ground theatreGround(const glm::dvec2& place);

/// Appends meshes, materials, camera and nodes of the theatre. Returns the nodes at the top.
std::vector<int> addTheatre(GltfDocument& document);

}  // namespace luciole
