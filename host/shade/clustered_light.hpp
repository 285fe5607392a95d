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
  float light_error;  ///< E > 0: a channel's bound shall be E·max(least_value, its light) at most
  float least_value = 1;
  Buffer<float> light;  ///< out: planes r g b of what the lights give a pixel, as it leaves the surface
  Buffer<float> bound;  ///< out: planes r g b, upper bounds of their errors, seen through the fog
};

/// The counts of clusteredLight().
struct ClusteredLightCounts {
  std::uint64_t far = 0;       ///< clusters that were added to a group of pixels' far field
  std::uint64_t clusters = 0;  ///< pairs of a pixel and a cluster that its horizon may cut
  std::uint64_t lights = 0;    ///< pairs of a pixel and a light that was summed by itself
  std::uint64_t redone = 0;    ///< pixels that were lit again with smaller errors of each cluster
};

/// Launches kernels/clusters/clustered_light.cl on every tile of the G-buffer and waits for it. defines: the
/// program's features (featureDefines). Throws MachineError.
ClusteredLightCounts clusteredLight(OpenedDevice& device, const std::string& defines,
                                    const ClusteredLightArguments& arguments);

/// Lights that clusters could replace.
struct ClusterableLights {
  std::size_t count;
  float light_error;  ///< > 0
  bool highlights;    ///< whether surfaces have them
};

/// The estimated work of clusters for a pixel, the building of their tree included, in units of a light that
/// is summed by itself. It is computed, not timed, so no picture depends on the machine. view: of the
/// picture; its size and field of view count, not the crop. Surfaces in a parallel view are taken to be as
/// far away as the picture is high.
double clusteredWork(const ClusterableLights& lights, const View& view);

/// Whether clusteredWork() is less than summing each light.
bool clustersAreFaster(const ClusterableLights& lights, const View& view);

}  // namespace luciole
