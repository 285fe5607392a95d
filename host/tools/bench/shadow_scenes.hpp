#pragma once

#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// Six scenes that are hard for shadows. Their names say why:
/// - grazing plane: a sun 3 degrees above a plane, with a few posts
/// - thin wall: a sheet without thickness, a light 2 cm behind it
/// - picket fence: a hundred pickets of 3 cm under the sun, into the distance
/// - cube seam: a light in a room of smooth and of flat shapes, the seams of its map across them
/// - contact: a smooth sphere that touches a plane, a light at its side
/// - foliage: 40,000 leaves under 16 lamps
std::vector<Scene> makeShadowScenes();

/// A hall of 60 columns and balls, 80,000 triangles, under `lamps` point lights in rows, whose ranges add up
/// to the same floor whatever their number. All cast shadows.
Scene makeLampHall(int lamps);

}  // namespace luciole
