#pragma once

#include "luciole/scene.hpp"
#include "render/render.hpp"

namespace luciole {

/// What the library's own functions do before anything else, so that what a caller gets wrong is an
/// InputError that names the place, never a crash: checks the scene (validateScene()) and the settings,
/// "settings.samples: 0, expected 1 to 1024". What is only a matter of memory, or of the device, shows later.
/// Takes less than a hundredth of the picture's time. Of pictures of one scene at several poses
/// (renderBands() with `kept`) the first one checks the scene. G-buffers are checked by validateGBuffer().
/// Functions below these, such as rasterize(), trust their caller.
void validate(const Scene& scene, const RenderSettings& settings, const KeptShadows* kept = nullptr);

}  // namespace luciole
