#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "kernels/shared.h"
#include "luciole/gbuffer.hpp"
#include "shade/features.hpp"

// What is rounded between the light of clusters and the colours of a picture, for the bounds of its error.
namespace luciole {

/// The E to ask of clusters for colours to keep `light_error` when all that follows has rounded. features: of
/// the program that shades.
float clusteredError(float light_error, const ShadeFrame& frame, const FeatureSet& features);

/// Makes bounds of the light of clusters, r g b as the eye sees it, bounds of the colours that were shaded
/// with it; 0 for background. emission: that of the pixels with the light of clusters; may be empty for none.
/// color: r g b and perhaps more. vertex_error: takes the place of all bounds, where there is one.
void boundVisibleLight(const GBuffer& gbuffer, const ShadeFrame& frame, const FeatureSet& features,
                       const Plane& emission, const Plane& color,
                       const std::optional<glm::vec3>& vertex_error, Plane& bounds);

}  // namespace luciole
