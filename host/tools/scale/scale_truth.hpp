#pragma once

#include <string>

#include "tools/scale/scale.hpp"

namespace luciole {

/// The reference of the point's picture in words: "shadows by rays, model toon". Only points with the same
/// number of lights and the same words have the same reference, so that their errors can be compared. Empty
/// if all points of the experiment have the same. Other methods' pictures have that of all others.
std::string truthName(const ScaleDescription& description, const ScalePoint& point);

}  // namespace luciole
