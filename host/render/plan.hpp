#pragma once

#include <cstddef>
#include <vector>

#include "lighting/light_layers.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "raster/view.hpp"
#include "render/render.hpp"
#include "shade/features.hpp"
#include "shade/screen_rows.hpp"
#include "shade/surface.hpp"

namespace luciole {

/// All decisions about a picture that don't depend on the device.
struct PicturePlan {
  View view;               ///< of the picture, or of its crop
  ShadeSettings shade;     ///< those of the settings, with the model and shadow ways decided
  FeatureSet features;     ///< of all passes together
  FeatureSet pixels;       ///< of the pass that lights pixels
  FeatureSet vertices;     ///< of the pass that lights vertices, with Shading::kGouraud only
  PlaneSet planes;         ///< the G-buffer groups of the pass that lights pixels
  SurfaceProgram surface;  ///< RenderSettings::surfaces
  std::vector<LightLayer> layers;
  std::vector<FeatureSet> programs;  ///< feature sets of all passes, each once
  double pairs = 0;                  ///< of a point and a light that lights it, about
  std::vector<ScreenProgram> screens;
  bool ids_of_gbuffer = false;  ///< the layers object_id and material_id show planes of the G-buffer
  bool shares_samples = false;  ///< samples that see the same surface share a shading point
  std::size_t pixel_bytes = 0;  ///< see bytesPerPixel
  int band_height = 0;          ///< rows of a band, at most
};

/// The plan of a scene's picture. O(vertices + lights). Nothing is drawn and no time is measured, so the same
/// scene and settings give the same plan on every machine. Only band_height depends on the memory that is
/// left. Throws as lightLayers does.
PicturePlan planPicture(const Scene& scene, const RenderSettings& settings);

/// The plan of lighting a G-buffer by the scene's lights; without bands and samples.
PicturePlan planShading(const Scene& scene, const GBuffer& gbuffer, const RenderSettings& settings);

}  // namespace luciole
