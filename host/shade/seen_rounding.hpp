#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "kernels/shared.h"
#include "luciole/gbuffer.hpp"
#include "shade/features.hpp"

// Rounding errors between clustered light and the colours of a picture, for the bounds of their error.
namespace luciole {

/// Whether a pass with these features sees surfaces through fog.
bool seesFog(const FeatureSet& features);

/// The error to allow clusters so that colours keep `light_error` after all further rounding. features: of
/// the program that shades.
float clusteredError(float light_error, const ShadeFrame& frame, const FeatureSet& features);

/// Turns bounds of clustered light, r g b as seen through the fog, into bounds of the colours shaded with it;
/// 0 for background. emission: the pixels' own plus clustered light, or empty. color: planes r g b and
/// perhaps more. vertex_error: if set, replaces all bounds.
void boundVisibleLight(const GBuffer& gbuffer, const ShadeFrame& frame, const FeatureSet& features,
                       const Plane& emission, const Plane& color,
                       const std::optional<glm::vec3>& vertex_error, Plane& bounds);

}  // namespace luciole
