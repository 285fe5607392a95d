#pragma once

#include <cstdint>
#include <vector>

#include "lights/light_set.hpp"
#include "luciole/scene.hpp"
#include "shade/features.hpp"
#include "shadow/exact/beam_shadows.hpp"

namespace luciole {

/// Lights that aren't summed by themselves: their indices in the scene, ascending.
struct BoundedLights {
  std::vector<std::uint32_t> clustered, sampled, directions;
  bool shadows = true;  ///< lights that are sampled cast shadows, if they are marked so
};

/// Those of a picture with these features. O(lights).
BoundedLights boundedLights(const Scene& scene, const FeatureSet& features, const ShadeSettings& settings);

/// Which colours of lights count; the others are black.
struct LightColors {
  bool diffuse = true, specular = true;
  bool lux = false;  ///< in lux (luxOfColor)
};

/// Sets the clusters and the sampled lights of a set. features: the picture's. Lights whose colours give
/// nothing are left out.
void setBoundedLights(const Scene& scene, const Camera& camera, const BeamScene& beams,
                      const FeatureSet& features, const BoundedLights& chosen, LightColors colors,
                      LightSet& set);

}  // namespace luciole
