#pragma once

#include <cstddef>
#include <string>

#include "luciole/light.hpp"

namespace luciole {

/// What is wrong with a source of a scene with so many groups of lights, as "count: 9, expected …"; "" if
/// nothing is. The numbers of its sky aren't looked at. O(cells).
std::string sourceFault(const LightSource& source, std::size_t groups);

}  // namespace luciole
