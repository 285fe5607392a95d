#pragma once

#include <cstddef>
#include <functional>

#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "raster/view.hpp"

namespace luciole {

/// What an environment shows in a G-buffer's pixels: planes r g b, in its layout. Each pixel has the sky's
/// mean over about its own width, by trilinear mips, and all samples of it the same. view: that of the
/// G-buffer. is_seen: of a place in the planes; where it is false the planes stay 0.
Plane skyPlane(const LightSource& environment, const View& view, const GBuffer& layout,
               const std::function<bool(std::size_t place)>& is_seen);

/// The same where the G-buffer shows no surface.
Plane skyPlane(const LightSource& environment, const View& view, const GBuffer& gbuffer);

/// Adds it to the colours of pixels that show no surface.
void addSky(const Plane& sky, const GBuffer& gbuffer, Plane& color);

}  // namespace luciole
