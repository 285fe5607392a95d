#pragma once

#include "luciole/gbuffer.hpp"

namespace luciole {

/// Throws InputError for a G-buffer whose sizes, or those of its planes, don't fit each other, whose camera
/// is none, or that names a model that there isn't: "gbuffer.normal: has 0 numbers, expected 786432". Other
/// numbers in planes may be any that are finite, and are not looked at. O(1), and O(pixels) where it has
/// models.
void validateGBuffer(const GBuffer& gbuffer);

}  // namespace luciole
