#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace luciole {

/// Reads point lights from a text file, one a line: x,y,z,r,g,b,range. Positions are in metres, colours
/// linear and ≥ 0; a range that is empty or left out is none. The first line may be these names. Blanks,
/// empty lines, lines that start with # and CRLF are fine. Takes the first `count` lights, or all. Throws
/// InputError "file: line: what", and where there are fewer than `count`, or more than kMostLights.
std::vector<Light> readLightList(const std::string& path, std::optional<std::uint64_t> count = {});

}  // namespace luciole
