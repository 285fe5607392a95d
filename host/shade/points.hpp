#pragma once

#include "cl/device.hpp"
#include "lights/cull.hpp"
#include "lights/light_set.hpp"
#include "luciole/gbuffer.hpp"
#include "shade/features.hpp"
#include "shade/shade.hpp"

namespace luciole {

/// The points of a G-buffer on the device. Buffers are borrowed from the G-buffer and from the members before
/// them, so it must not be copied.
struct Points {
  const GBuffer& gbuffer;
  PackedNormals normal_packed;  ///< in the place of surfaceNormals() that the G-buffer lacks
  PackedNormals tangents;       ///< likewise: tangentsOf()
  Plane zeros;                  ///< likewise in the place of specular, ambient, emission and lift
  ModelPlane default_model;     ///< likewise: the picture's model
  GBufferBuffers buffers;
  std::size_t stride;  ///< elements in a plane
  std::size_t bytes;   ///< of all planes
};

/// Borrows the planes that the program with the features `compiled` reads, for a pass of `features`: they are
/// the same, or fewer. Of those, emission and models of their own are hidden from the program. unlit: the
/// diffuse colour takes the place of ambient. Throws MachineError.
Points pointsOnDevice(OpenedDevice& device, const GBuffer& gbuffer, const FeatureSet& features,
                      const FeatureSet& compiled, bool unlit);

/// The arguments of cull() for these points and lights. tests: see CullArguments.
CullArguments cullArguments(const Points& points, const LightSet& lights, unsigned group_log2,
                            unsigned tests);

}  // namespace luciole
