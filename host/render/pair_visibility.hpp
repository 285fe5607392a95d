#pragma once

#include <span>
#include <string>
#include <vector>

#include "cl/device.hpp"
#include "gbuffer/gbuffer.hpp"
#include "shadow/shadow_maps.hpp"

namespace luciole {

/// A point of a G-buffer and a shadow map.
struct MapPair {
  std::uint32_t pixel;  ///< place in the planes
  std::uint32_t map;    ///< index into ShadowMaps::maps
};

/// Launches kernels/pair_visibility.cl: the share of the map's light that reaches each point, as shading has
/// it. The G-buffer has facets. Pairs of the same map should follow each other. defines: the program's
/// features (featureDefines).
std::vector<float> pairVisibility(Device& device, const std::string& defines, const GBuffer& gbuffer,
                                  const ShadowMaps& shadows, std::span<const MapPair> pairs);

}  // namespace luciole
