#pragma once

#include <string>

#include "cl/device.hpp"
#include "luciole/image.hpp"

namespace luciole {

/// Whether a file's name is that of a lamp's profile.
bool isProfile(const std::string& path);

/// What a lamp's profile looks like, linear R G B: its candela in the planes C 0–180 (filled) and C 90–270 (a
/// line) as a polar curve, straight down being down; and its light on a wall of 4 × 4 m, 0.5 m behind it.
/// Throws as readLightProfile(), and MachineError.
Image profilePicture(OpenedDevice& device, const std::string& path);

}  // namespace luciole
