#pragma once

#include "render/ready_picture.hpp"

namespace luciole {

/// Applies the picture's functions of surfaces (RenderSettings::surfaces) to points before they are lit, and
/// counts those to which they gave what is no number or no direction. Throws as surface().
void changeSurfaces(ReadyPicture& picture, GBuffer& points);

/// The same for points outside of a picture.
void changeSurfaces(OpenedDevice& device, const SurfaceProgram& program, GBuffer& points, Stats& stats);

/// Adds to a given G-buffer what the functions change and it lacks: colours of 0, and where they turn
/// normals, those before.
void prepareForSurfaces(const SurfaceProgram& program, GBuffer& gbuffer);

}  // namespace luciole
