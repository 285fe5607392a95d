#pragma once

#include "image/image.hpp"
#include "raster/gbuffer.hpp"
#include "render/lighting.hpp"
#include "render/render.hpp"

namespace luciole {

/// Whether the settings ask for this layer.
bool wants(const RenderSettings& settings, Aov aov);

/// The finished picture: channels R G B, the sum of `settings.samples` samples averaged and exposed, then the
/// layers asked for, from the first sample's G-buffer and its lit planes. All planes are in the G-buffer's
/// layout.
Image assemblePicture(const GBuffer& gbuffer, const LitPlanes& first, const Plane& color_sum,
                      const RenderSettings& settings);

}  // namespace luciole
