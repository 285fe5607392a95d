#pragma once

#include <span>
#include <string>
#include <vector>

#include "cl/device.hpp"
#include "luciole/gbuffer.hpp"
#include "shadow/maps/shadow_maps.hpp"

namespace luciole {

/// A point of a G-buffer and a shadow map.
struct MapPair {
  std::uint32_t pixel;  ///< place in the planes
  std::uint32_t map;    ///< index into ShadowMaps::maps
};

/// Launches kernels/maps/pair_visibility.cl and waits for it. Returns for each pair the share of the map's
/// light, in [0, 1], that reaches the point, as shading computes it. The G-buffer needs surfaceNormals().
/// Sort pairs by map, because a row of lanes shares its map. defines: the program's features
/// (featureDefines). Throws MachineError.
std::vector<float> pairVisibility(OpenedDevice& device, const std::string& defines, const GBuffer& gbuffer,
                                  const ShadowMaps& shadows, std::span<const MapPair> pairs);

}  // namespace luciole
