#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "lighting/light_gbuffer.hpp"
#include "render/ready_picture.hpp"

// The one loop that lights points: a PointLister gives batches of points, and takes their light.
namespace luciole {

/// Gives a picture's points batch by batch as G-buffers, and takes their light.
struct PointLister {
  const GBuffer* gbuffer = nullptr;  ///< the batch
  PixelCounts counts;                ///< to be made of it
  Plane recycled;                    ///< a plane whose memory the next colours take

  virtual ~PointLister() = default;
  /// Sets the members for the next batch. Returns false after the last one.
  virtual bool next() = 0;
  /// Takes the batch's light.
  virtual void take(LitPlanes lit) = 0;
  /// Takes its light of a layer: `color`, and with boundsLayers() `light_error`, if it has any. Called after
  /// take(), for each layer in order.
  virtual void takeLayer(std::size_t layer, LitPlanes lit) = 0;
};

/// Lights all points of the lister, by the picture's lights and by those of each layer. features: of the
/// picture's own light. Throws MachineError.
void lightPoints(ReadyPicture& picture, const FeatureSet& features, PointLister& lister);

/// The counts for a sample: those that layers show in the first one only, those of statistics in all.
PixelCounts wantedCounts(const RenderSettings& settings, int sample);

/// The names of the picture's layers of light, and with boundsLayers() after each that of its bounds.
std::vector<std::string> layerNames(const ReadyPicture& picture);

/// The first channel of a layer of light. These layers are the picture's last.
std::size_t channelOfLayer(const ReadyPicture& picture, const Image& image, std::size_t layer);

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
