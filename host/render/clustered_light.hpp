#pragma once

#include <cstdint>
#include <string>

#include "culling/light_clusters.hpp"
#include "render/shade.hpp"

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

/// Launches kernels/clustered_light.cl on every tile of the G-buffer and waits for it. defines: the program's
/// features (featureDefines). Throws MachineError.
ClusteredLightCounts clusteredLight(Device& device, const std::string& defines,
                                    const ClusteredLightArguments& arguments);

/// About the work for a pixel of clusters that stand for so many lights, in lights that are each summed by
/// themselves. It counts and never times, so no picture depends on the machine. light_error: > 0; highlights:
/// whether surfaces have them.
double clusteredWork(std::size_t lights, float light_error, bool highlights);

/// Whether clusters take less work than the lights.
bool clustersPay(std::size_t lights, float light_error, bool highlights);

}  // namespace luciole
