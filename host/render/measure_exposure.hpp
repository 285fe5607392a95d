#pragma once

#include "cl/device.hpp"
#include "lighting/stats.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"
#include "luciole/scene.hpp"
#include "render/render.hpp"

namespace luciole {

/// The exposure that suits a scene's picture (see suitableExposure), in stops. Renders the whole picture,
/// also where the settings ask for a crop, in measuringSize() with one sample a pixel. Pixels of the
/// background don't count. Adds to the statistics what it cost. kept, and what it throws: as of
/// renderBands.
double measureExposure(OpenedDevice& device, const Scene& scene, const RenderSettings& settings, Stats& stats,
                       KeptPicture* kept = nullptr);

/// The exposure that suits a lit G-buffer. `picture`: by shadeGBuffer with an exposure of 0.
double measureExposure(const Image& picture, const GBuffer& gbuffer);

}  // namespace luciole
