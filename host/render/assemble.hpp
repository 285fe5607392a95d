#pragma once

#include "gbuffer/gbuffer.hpp"
#include "image/image.hpp"
#include "render/lighting.hpp"
#include "render/render.hpp"

namespace luciole {

/// Whether the settings ask for this layer.
bool wants(const RenderSettings& settings, Aov aov);

/// Number of channels of a picture whose G-buffer has these groups: R G B, A and the layers asked for.
std::size_t channelCount(const RenderSettings& settings, const PlaneSet& planes);

/// A picture of the G-buffer's size with channels R G B and, if asked for, A, all still 0, and the layers
/// that the settings ask for, from the first sample's G-buffer and lit planes. Its positions and normals are
/// in world space.
Image startPicture(const GBuffer& gbuffer, const LitPlanes& first, const RenderSettings& settings);

/// Adds 1 to each pixel of `covered` that shows a surface in this sample's G-buffer. An empty plane is made.
void countCovered(const GBuffer& gbuffer, Plane& covered);

/// Fills in R G B: the mean of the samples times 2^exposure, clamped to finite floats; and A, if asked for.
/// color_sum: planes r, g, b in the G-buffer's layout, the sum of `settings.samples` samples. covered: how
/// many of them show a surface; used for A only.
void setColors(const GBuffer& gbuffer, const Plane& color_sum, const Plane& covered,
               const RenderSettings& settings, Image& image);

}  // namespace luciole
