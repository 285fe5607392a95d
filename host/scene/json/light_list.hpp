#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// Reads lights from a text file, one a line: x,y,z,r,g,b,range, or the columns that a first line names:
/// x, y, z, r, g, b, range, constant, linear, quadratic, dx, dy, dz, cutoff, exponent, inner_cone and
/// outer_cone, in any order. They mean what the keys of a scene's light do: positions and ranges are in
/// metres, colours linear and ≥ 0, angles in degrees. An empty field has the default of the scene's key; of
/// constant, linear and quadratic an empty one is 0 if another is given. A light with a direction and without
/// a position is directional; one with a cutoff below 180 or a cone is a spot. Blanks, empty lines, lines
/// that start with # and CRLF are fine. Takes the first `count` lights, or all. Throws InputError "file:
/// line: what", and where there are fewer than `count`, or more than kMostLights.
std::vector<Light> readLightList(const std::string& path, std::optional<std::uint64_t> count = {});

}  // namespace luciole
