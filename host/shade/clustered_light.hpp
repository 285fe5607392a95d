#pragma once

#include <cstdint>
#include <string>

#include "lights/light_clusters.hpp"
#include "raster/view.hpp"
#include "shade/shade.hpp"

namespace luciole {

struct ClusteredLightArguments {
  const ShadeFrame& frame;
  const GBufferBuffers& gbuffer;
  int tiles_x, tiles_y;             ///< of the G-buffer
  const LightClusters& clusters;    ///< of diffuse light
  const LightClusters& highlights;  ///< the same lights by their specular colours; may be `clusters`
  float light_error;                ///< E > 0: a channel's bound shall be E·max(1, its light) at most
  Buffer<float> light;  ///< out: planes r g b of what the lights give a pixel, as it leaves the surface
  Buffer<float> bound;  ///< out: planes r g b, how far each may be from the truth, seen through the fog
};

/// What clusteredLight() counted.
struct ClusteredLightCounts {
  std::uint64_t far = 0;       ///< clusters that were added to a group of pixels' far field
  std::uint64_t clusters = 0;  ///< pairs of a pixel and a cluster that its horizon may cut
  std::uint64_t lights = 0;    ///< pairs of a pixel and a light that no cluster stood for
  std::uint64_t redone = 0;    ///< pixels that were lit again with smaller errors of each cluster
};

/// Launches kernels/clusters/clustered_light.cl on every tile of the G-buffer and waits for it. defines: the
/// program's features (featureDefines). Throws MachineError.
ClusteredLightCounts clusteredLight(OpenedDevice& device, const std::string& defines,
                                    const ClusteredLightArguments& arguments);

/// Lights that clusters could stand for.
struct ClusterableLights {
  std::size_t count;
  float light_error;  ///< > 0
  bool highlights;    ///< whether surfaces have them
};

/// About the work for a pixel of clusters, the tree of lights included, in lights that are each summed by
/// themselves. It counts and never times, so no picture depends on the machine. view: of the picture; only
/// its size and how wide it sees matter, not the crop. What a parallel view shows is taken to lie as far away
/// as the picture is high.
double clusteredWork(const ClusterableLights& lights, const View& view);

/// Whether clusters take less work than the lights.
bool clustersAreFaster(const ClusterableLights& lights, const View& view);

}  // namespace luciole
