#pragma once

#include <cstdint>
#include <string>

#include "culling/light_clusters.hpp"
#include "render/shade.hpp"

namespace luciole {

struct ClusteredLightArguments {
  const ShadeFrame& frame;  ///< plane_stride and all set
  const GBufferBuffers& gbuffer;
  const LightClusters& clusters;
  float light_error;    ///< E > 0: a pixel's bound is at most E·max(1, colour), in each channel
  Buffer<float> light;  ///< out: planes r g b: what these lights give a pixel, material included, before fog
  Buffer<float> bound;  ///< out: planes r g b: bounds of the error of `light` as it is seen through the fog
};

struct ClusteredLightCounts {
  std::uint64_t clusters = 0;  ///< pairs of a pixel and a cluster
  std::uint64_t lights = 0;    ///< pairs of a pixel and a light that was summed by itself
  std::uint64_t redone = 0;    ///< pixels that needed finer clusters
};

/// Lights every pixel of the G-buffer by clusters of lights. Pixels that show nothing get zeros. defines: the
/// program's features (clusterFeatures) and mathDefines. Throws MachineError.
ClusteredLightCounts clusteredLight(Device& device, const std::string& defines,
                                    const ClusteredLightArguments& arguments);

/// Whether clusters take less work than so many lights that are each summed by themselves. It counts, so a
/// picture doesn't depend on the machine. light_error: > 0.
bool clustersPay(std::size_t lights, float light_error);

}  // namespace luciole
