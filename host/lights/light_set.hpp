#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cl/buffer.hpp"
#include "kernels/shared.h"
#include "lights/light_clusters.hpp"
#include "lights/light_tree.hpp"
#include "lights/shade_lights.hpp"
#include "luciole/light.hpp"

namespace luciole {

/// Clusters of lights, with Feature::kClusteredLights only.
struct ClusterSet {
  LightClusters diffuse;
  LightClusters specular;  ///< the same by specular colours; empty if these equal the diffuse ones
  std::size_t lights = 0;  ///< number of lights in the clusters
};

/// Lights that are sampled: with Feature::kSampledLights those with a place, with Feature::kSampledDirections
/// directional ones, as lights at the unit vectors towards them.
struct SampledSet : ClusterSet {
  /// BeamLight::place of each slot of a row of lights; w: -1 for one that casts no shadow.
  RawArray<float4> places;
  /// kLobeFields · kClusterSlots floats for each row of lights; empty where the features need none.
  RawArray<float> lobes;
  float largest_cell = 0;  ///< of kLobeCell
};

/// The lights of a picture or of a layer of light, as kernels take them, with ambient light, fog and
/// background. Buffers are borrowed from the members before them, so it can be moved, but not copied.
struct LightSet {
  /// Ambient light, fog and background; all but plane_stride and texel_count, which depend on the G-buffer.
  ShadeFrame frame{};
  const LightSource* sky = nullptr;    ///< the scene's environment, if that is the background
  bool emission = true;                ///< surfaces' own light counts
  RawArray<ShadeLight> lights;         ///< those that are summed by themselves, in the order of a Z curve
  std::vector<std::uint32_t> order;    ///< the scene's index of each
  std::vector<BeamLight> beam_lights;  ///< one for each, with Feature::kExact only
  RawArray<float> luminaires;          ///< of these lights and their profiles, see setLuminaires()
  LightTree tree;
  ClusterSet clusters;
  SampledSet samples, directions;
  Buffer<const ShadeLight> light_buffer;
  Buffer<const float> luminaire_buffer;  ///< of a layer: the picture's
  Buffer<const float> tree_buffer;
  Buffer<const BeamLight> beam_buffer;

  LightSet() = default;
  LightSet(LightSet&&) = default;
};

/// Sets the members that follow from the lights: the frame's count, the tree, and the device's buffers.
/// Throws MachineError.
void finishLightSet(OpenedDevice& device, LightSet& set);

/// The bytes of its lights, their tree and clusters on the device.
std::size_t bytesOf(const LightSet& set);

}  // namespace luciole
