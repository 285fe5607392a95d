#pragma once

#include <cstddef>
#include <vector>

#include "lighting/light_layers.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "raster/view.hpp"
#include "render/render.hpp"
#include "shade/features.hpp"

namespace luciole {

/// What is decided of a picture before any of it is made, whatever the device.
struct PicturePlan {
  View view;  ///< of the picture, or of its crop
  ShadeSettings
      shade;  ///< the settings', with models, the error that clusters may make and shadow ways chosen
  FeatureSet features;  ///< of all passes together
  FeatureSet pixels;    ///< of the pass that lights pixels
  FeatureSet vertices;  ///< of the pass that lights vertices, with Shading::kGouraud only
  PlaneSet planes;      ///< the G-buffer groups of the pass that lights pixels
  std::vector<LightLayer> layers;
  std::vector<FeatureSet> programs;  ///< those that all passes need, without repetitions
  bool shares_samples = false;       ///< a point is shaded for samples that see the same surface
  std::size_t pixel_bytes = 0;       ///< see bytesPerPixel
  int band_height = 0;               ///< rows that are made at a time, at most
};

/// Of a scene's picture. O(vertices + lights); nothing is drawn, and no time is measured, so that the same
/// scene and settings give the same picture everywhere; only band_height depends on the memory that is left.
/// Throws as lightLayers does.
PicturePlan planPicture(const Scene& scene, const RenderSettings& settings);

/// Of lighting a G-buffer by the scene's lights. Bands and samples don't matter.
PicturePlan planShading(const Scene& scene, const GBuffer& gbuffer, const RenderSettings& settings);

}  // namespace luciole
