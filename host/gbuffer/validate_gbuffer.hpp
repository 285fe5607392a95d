#pragma once

#include "luciole/gbuffer.hpp"

namespace luciole {

/// Throws InputError for a G-buffer whose sizes and planes don't match, with an invalid camera, or with an
/// unknown model: "gbuffer.normal: has 0 numbers, expected 786432". Other numbers in planes must be finite,
/// and aren't checked. O(1), or O(pixels) if it has models.
void validateGBuffer(const GBuffer& gbuffer);

}  // namespace luciole
