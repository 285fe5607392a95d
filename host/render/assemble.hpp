#pragma once

#include <optional>

#include "lighting/light_gbuffer.hpp"
#include "lighting/light_layers.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"
#include "render/pixel_sums.hpp"
#include "render/render.hpp"

namespace luciole {

/// Clamps to finite floats, as finite_color() in the kernels does: the sum of bright samples may overflow.
float finiteColor(float color);

/// A rectangle of a picture.
Image cutOut(Image picture, const glm::ivec2& first, const glm::ivec2& size);

/// The index of an AOV's first channel in the picture; empty if the settings don't ask for it.
std::optional<std::size_t> channelOf(const Image& image, const RenderSettings& settings, Aov aov);

/// Whether layers of light have channels of their bounds beside those of their colours.
bool boundsLayers(const RenderSettings& settings);

/// The number of channels of a layer of light.
std::size_t layerChannels(const RenderSettings& settings);

/// The number of channels of a picture whose G-buffer has these groups: R G B, A and AOVs, without
/// lightLayers().
std::size_t channelCount(const RenderSettings& settings, const PlaneSet& planes);

/// Allocates a picture of the G-buffer's size and fills in those of its AOVs that show the first sample.
/// Channels: R G B and, with RenderSettings::alpha, A, all for setColors(); the AOVs; then R G B of each of
/// light_layers, NAME.R …, for setLightLayer(). `recycled`: a picture whose memory is taken.
Image startPicture(const GBuffer& gbuffer, const LitPlanes& first, const RenderSettings& settings,
                   const std::vector<std::string>& light_layers, Image recycled = {});

/// Adds 1 to each pixel of `covered` that shows a surface in this sample's G-buffer. Allocates an empty
/// plane.
void countCovered(const GBuffer& gbuffer, Plane& covered);

/// Whether the settings need PixelSums::covered.
bool countsCovered(const RenderSettings& settings);

/// Fills in R G B, the mean of the samples times 2^exposure, clamped to finite floats; and A,
/// Aov::kShadingCount and Aov::kLightError if the picture has them. sums: over settings.samples samples, in
/// the G-buffer's layout. sums.covered is needed if countsCovered(). Empty sums.shadings: each sample that
/// shows a surface was shaded.
void setColors(const GBuffer& gbuffer, const PixelSums& sums, const RenderSettings& settings, Image& image);

/// Fills in the layerChannels() of a layer of light, from first_channel on, as setColors() does R G B and
/// Aov::kLightError. sums: of its colours and bounds, over the samples. Without bounds these are 0.
void setLightLayer(const GBuffer& gbuffer, const PixelSums& sums, const RenderSettings& settings,
                   const LightLayer& of, std::size_t first_channel, Image& image);

}  // namespace luciole
