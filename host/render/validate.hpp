#pragma once

#include "luciole/scene.hpp"
#include "render/render.hpp"

namespace luciole {

/// Checks the input of the library's public functions: the scene (validateScene()) and the settings. Throws
/// InputError that names the field: "settings.samples: 0, expected 1 to 1024". Memory and the device aren't
/// checked. Takes less than a hundredth of the picture's time. kept: tells whether an earlier picture has
/// checked the scene, and learns that this one did. G-buffers are checked by validateGBuffer(). Functions
/// below, such as rasterize(), trust their caller.
void validate(const Scene& scene, const RenderSettings& settings, KeptPicture* kept = nullptr);

}  // namespace luciole
