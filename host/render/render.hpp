#pragma once

#include "cl/device.hpp"
#include "lighting/stats.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"
#include "luciole/render.hpp"
#include "raster/rasterize.hpp"
#include "render/kept_picture.hpp"
#include "shade/features.hpp"

namespace luciole {

/// Sets Stats::triangles, lights, warnings and features.
void describeScene(const Scene& scene, const FeatureSet& features, Stats& stats);

/// Renders a scene (channels R G B, linear, A if asked for, then the layers) and hands the picture to `take`
/// band by band. Adds to the statistics. kept: of the scene's picture before this one, for the next. Throws
/// as validate() does, InputError for a crop outside the picture, MachineError, and what `take` throws.
void renderBands(OpenedDevice& device, const Scene& scene, const RenderSettings& settings,
                 const RowSink& take, Stats& stats, KeptPicture* kept = nullptr);

/// Appends rows to a picture with the same channels, or to an empty one.
void appendRows(const Image& rows, Image& picture);

/// The same, but returns the whole picture.
Image renderScene(OpenedDevice& device, const Scene& scene, const RenderSettings& settings, Stats& stats,
                  KeptPicture* kept = nullptr);

/// The first half of renderScene(): the G-buffer with every group. `device` is needed for Shading::kGouraud,
/// which lights vertices; otherwise it may be null. Throws as validate() does, InputError for a crop outside
/// the picture, and MachineError.
GBuffer rasterizeScene(OpenedDevice* device, const Scene& scene, const RenderSettings& settings,
                       Stats& stats);

/// The second half: lights a G-buffer by the scene's lights, ambient light and fog, with shadows that the
/// scene's objects cast. Uses of the settings `shade`, `aovs`, `exposure`, `alpha` and `count_lights` only;
/// the camera is the G-buffer's. Throws as validate() and validateGBuffer() do, and MachineError.
Image shadeGBuffer(OpenedDevice& device, const Scene& scene, const GBuffer& gbuffer,
                   const RenderSettings& settings, Stats& stats);

}  // namespace luciole
