#pragma once

#include "gbuffer/gbuffer.hpp"
#include "image/image.hpp"
#include "render/lighting.hpp"
#include "render/render.hpp"

namespace luciole {

/// Whether the settings ask for this layer.
bool wants(const RenderSettings& settings, Aov aov);

/// Channels of a picture whose G-buffer has these groups: R G B and the layers asked for.
std::size_t channelCount(const RenderSettings& settings, const PlaneSet& planes);

/// A picture with channels R G B, still black, and the layers asked for, from the first sample's G-buffer and
/// its lit planes.
Image startPicture(const GBuffer& gbuffer, const LitPlanes& first, const RenderSettings& settings);

/// Fills in R G B: the sum of `settings.samples` samples, in the G-buffer's layout, averaged and exposed.
void setColors(const GBuffer& gbuffer, const Plane& color_sum, const RenderSettings& settings, Image& image);

}  // namespace luciole
