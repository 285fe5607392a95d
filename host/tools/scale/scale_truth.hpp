#pragma once

#include <string>

#include "tools/scale/scale.hpp"

namespace luciole {

/// What the point's picture is compared with, in words: "shadows by rays, model toon". Points with the same
/// number of lights and the same words approximate the same picture, so their errors compare; those of others
/// don't. Empty if only the way to make the picture is varied.
std::string truthName(const ScaleDescription& description, const ScalePoint& point);

}  // namespace luciole
