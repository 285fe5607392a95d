#pragma once

#include <cstdint>
#include <vector>

#include "kernels/shared.h"
#include "raster/gbuffer.hpp"
#include "raster/view.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// The shadow maps of a scene for one camera.
struct ShadowMaps {
  std::vector<ShadowMap> maps;              ///< lookups take positions in the camera's view space
  std::vector<std::uint32_t> map_of_light;  ///< one a light of the scene: index into maps, or kNoShadow
  Plane depths;                             ///< all maps, one after another; reversed depth
};

/// Whether a shadowed light needs six faces: point lights, and spots too wide for one perspective map.
bool usesCubeMap(const Light& light);

/// Draws the maps of all lights with a shadow, by the same rasterizer as the picture, depth only. Directional
/// maps are fitted to what the camera can see of the scene: its whole picture, whatever the crop. They are
/// `size` texels a side, a spot's half and a cube's face a quarter of that. All maps together stay within
/// kShadowBudget bytes: where they would not, each has half the side, until they do. Throws MachineError if
/// even the smallest don't fit.
ShadowMaps drawShadowMaps(const Scene& scene, const View& camera_view, int size);

inline constexpr std::size_t kShadowBudget = std::size_t(512) << 20;

}  // namespace luciole
