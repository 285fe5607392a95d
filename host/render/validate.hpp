#pragma once

#include "luciole/scene.hpp"
#include "render/render.hpp"

namespace luciole {

/// Checks the input of the library's public functions: the scene (validateScene()) and the settings. Throws
/// InputError that names the field: "settings.samples: 0, expected 1 to 1024". Memory and the device aren't
/// checked. Takes less than a hundredth of the picture's time. kept: not null and not empty, the scene was
/// checked by an earlier picture of it. G-buffers are checked by validateGBuffer(). Functions below, such as
/// rasterize(), trust their caller.
void validate(const Scene& scene, const RenderSettings& settings, const KeptShadows* kept = nullptr);

}  // namespace luciole
