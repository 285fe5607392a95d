#pragma once

#include "gbuffer/gbuffer.hpp"
#include "image/image.hpp"
#include "render/lighting.hpp"
#include "render/render.hpp"

namespace luciole {

/// Whether the settings ask for this layer.
bool wants(const RenderSettings& settings, Aov aov);

/// Number of channels of a picture whose G-buffer has these groups: R G B and the layers asked for.
std::size_t channelCount(const RenderSettings& settings, const PlaneSet& planes);

/// A picture of the G-buffer's size with channels R G B, still black, and the layers that the settings ask
/// for, from the first sample's G-buffer and lit planes. Its positions and normals are in world space.
Image startPicture(const GBuffer& gbuffer, const LitPlanes& first, const RenderSettings& settings);

/// Fills in R G B: the mean of the samples times 2^exposure, clamped to finite floats. color_sum: planes r,
/// g, b in the G-buffer's layout, the sum of `settings.samples` samples.
void setColors(const GBuffer& gbuffer, const Plane& color_sum, const RenderSettings& settings, Image& image);

}  // namespace luciole
