#pragma once

#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "raster/view.hpp"

namespace luciole {

/// What an environment shows in a G-buffer's pixels, whatever else these show: planes r g b, in its layout.
/// Each pixel has the sky's mean over about its own width, by trilinear mips, and all samples of it the same.
/// view: that of the G-buffer.
Plane skyPlane(const LightSource& environment, const View& view, const GBuffer& layout);

/// Adds it to the colours of pixels that show no surface.
void addSky(const Plane& sky, const GBuffer& gbuffer, Plane& color);

}  // namespace luciole
