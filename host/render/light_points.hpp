#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "lighting/light_gbuffer.hpp"
#include "render/ready_picture.hpp"

// The one loop by which all light is made: points are listed, lit, and added to what they are part of.
namespace luciole {

/// Lists a picture's points, some at a time, and takes their light.
struct PointLister {
  const GBuffer* gbuffer = nullptr;  ///< the points to be lit now
  PixelCounts counts;                ///< what to count of them
  Plane recycled;                    ///< a plane that is done with

  virtual ~PointLister() = default;
  /// Sets the members for the next points. Returns false where there are none left.
  virtual bool next() = 0;
  /// Takes the picture's light.
  virtual void take(LitPlanes lit) = 0;
  /// Takes the light of a layer, r g b. Called for one after the other, after take().
  virtual void takeLayer(std::size_t layer, Plane color) = 0;
};

/// Lights all points of the lister, by the picture's lights and by those of each layer. features: of the
/// picture's own light. Throws MachineError.
void lightPoints(ReadyPicture& picture, const FeatureSet& features, PointLister& lister);

/// What to count for this sample: for layers only in the first one, for statistics in all.
PixelCounts wantedCounts(const RenderSettings& settings, int sample);

/// The names of the picture's layers of light.
std::vector<std::string> layerNames(const ReadyPicture& picture);

/// The first channel of a layer of light: they come last.
std::size_t channelOfLayer(const Image& image, std::size_t layer, std::size_t layers);

/// The pixels that `band` shows, with each sample rasterized and lit by itself. on_sample: called after each.
Image lightAllSamples(ReadyPicture& picture, const View& band, RasterCounts& triangles,
                      const std::function<void()>& on_sample);

/// The same with one point for the samples that see the same surface.
Image lightSharedSamples(ReadyPicture& picture, const View& band, RasterCounts& triangles);

/// The picture of a given G-buffer.
Image lightGivenPoints(ReadyPicture& picture, const GBuffer& gbuffer);

/// Lights the vertices of the objects that are drawn, for Shading::kGouraud: sets picture.vertex_colors, in
/// the order of gatherVertices(), before fog, and the bound of their error.
void lightVertices(ReadyPicture& picture);

}  // namespace luciole
