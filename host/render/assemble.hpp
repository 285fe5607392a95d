#pragma once

#include <optional>

#include "lighting/light_gbuffer.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"
#include "render/pixel_sums.hpp"
#include "render/render.hpp"

namespace luciole {

/// Whether they ask for one that is in world space.
bool wantsInWorld(const RenderSettings& settings);

/// Which of the picture's channels is the layer's first; nothing where the settings don't ask for it.
std::optional<std::size_t> channelOf(const Image& image, const RenderSettings& settings, Aov aov);

/// Number of channels of a picture whose G-buffer has these groups: R G B, A and the layers asked for,
/// without those of lightLayers().
std::size_t channelCount(const RenderSettings& settings, const PlaneSet& planes);

/// A picture of the G-buffer's size with channels R G B and, if asked for, A, which setColors() fills in as
/// it does the number of shadings, and the layers that the settings ask for, from the first sample's G-buffer
/// and lit planes. Its positions and normals are in world space. light_layers: names
/// of layers whose channels come last, NAME + R, G and B, for setLightLayer(). `used`: a picture that is done
/// with, whose memory it takes.
Image startPicture(const GBuffer& gbuffer, const LitPlanes& first, const RenderSettings& settings,
                   const std::vector<std::string>& light_layers, Image used = {});

/// Adds 1 to each pixel of `covered` that shows a surface in this sample's G-buffer. An empty plane is made.
void countCovered(const GBuffer& gbuffer, Plane& covered);

/// Whether the settings need to know how many samples of each pixel show a surface.
bool countsCovered(const RenderSettings& settings);

/// Fills in R G B: the mean of the samples times 2^exposure, clamped to finite floats; A and the number of
/// shadings and bounds of the light's error, if asked for. sums: over `settings.samples` samples, in the
/// G-buffer's layout; `covered` as countsCovered() says, and empty `shadings` where each of those samples was
/// shaded.
void setColors(const GBuffer& gbuffer, const PixelSums& sums, const RenderSettings& settings, Image& image);

/// Fills in three channels of a layer of light as setColors() does R G B. sums: r g b, over the samples.
void setLightLayer(const GBuffer& gbuffer, const Plane& sums, const RenderSettings& settings,
                   std::size_t first_channel, Image& image);

}  // namespace luciole
