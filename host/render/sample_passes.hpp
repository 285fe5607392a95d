#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "render/light_layers.hpp"
#include "render/lighting.hpp"
#include "render/render.hpp"

// A band of a picture: the samples of its pixels, drawn, lit and summed.
namespace luciole {

/// Memory of a band that is done with, for the next one: the system takes as long to clear fresh memory as
/// its pixels take to be shaded.
struct UsedMemory {
  GBuffer gbuffer;
  Plane color;
  Image picture;
};

/// What the bands of a picture share.
struct Prepared {
  FeatureSet features;  ///< of the pass that shades pixels
  std::vector<std::uint32_t> objects;
  Lighting lighting;
  std::vector<LayerLighting> layers;  ///< of light
  std::vector<glm::vec3> vertex_colors;
  PlaneSet planes;
  UsedMemory used;
};

/// Counts the rows of passes, and reports each pass.
struct Progress {
  const std::function<void(int, int)>& report;
  int rows;
  int done = 0;

  void step(int rows_done) {
    done += rows_done;
    if (report) report(done, rows);
  }
};

/// What to count for this sample: for layers only in the first one, for statistics in all.
PixelCounts wantedCounts(const RenderSettings& settings, int sample);

/// The names of layers of light.
std::vector<std::string> namesOf(const std::vector<LayerLighting>& layers);

/// The first channel of a layer of light: they come last.
std::size_t channelOfLayer(const Image& picture, std::size_t layer, std::size_t layers);

/// The pixels that `view` shows, with each sample rasterized and shaded by itself.
Image renderAllSamples(Device& device, const Scene& scene, const RenderSettings& settings, Prepared& prepared,
                       const View& view, RasterCounts& triangles, Progress& progress, Stats& stats);

/// The same with one shading for the samples that see the same surface.
Image renderSharedSamples(Device& device, const Scene& scene, const RenderSettings& settings,
                          Prepared& prepared, const View& view, RasterCounts& triangles, Progress& progress,
                          Stats& stats);

}  // namespace luciole
