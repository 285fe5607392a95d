#pragma once

#include <cstdint>
#include <span>

#include "cl/buffer.hpp"
#include "kernels/shared.h"
#include "luciole/scene.hpp"
#include "shadow/maps/shadow_maps.hpp"

namespace luciole {

/// A picture's shadow maps, on the host and on the device. Buffers are borrowed from the maps, so it can't be
/// copied.
struct MapScene {
  ShadowMaps host;
  Buffer<const ShadowMap> maps;
  Buffer<const ShadowFace> faces;
  Buffer<const ShadowTexel> texels;  ///< those drawn so far

  MapScene() = default;
  MapScene(const MapScene&) = delete;
  MapScene& operator=(const MapScene&) = delete;
};

/// Makes the device's buffers of the planned maps and their texels. Throws MachineError.
void borrowMaps(OpenedDevice& device, MapScene& maps);

/// Draws the bins of the maps that lookups need and that aren't drawn yet, and updates the device's buffers.
/// needed: of findTexels(). Throws as drawNeeded does.
void drawMaps(OpenedDevice& device, const Scene& scene, std::span<const std::uint32_t> needed,
              MapScene& maps);

/// Takes the maps back from the device.
ShadowMaps takeMaps(MapScene& maps);

}  // namespace luciole
