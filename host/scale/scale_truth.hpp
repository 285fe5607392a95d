#pragma once

#include <string>

#include "scale/scale.hpp"

namespace luciole {

/// What the point's picture is held against, in words: "shadows by rays, model toon". Points of as many
/// lights and the same words approximate one picture, so their errors compare; those of others don't. Empty
/// where nothing is varied but the way to make the picture.
std::string truthName(const ScaleDescription& description, const ScalePoint& point);

}  // namespace luciole
