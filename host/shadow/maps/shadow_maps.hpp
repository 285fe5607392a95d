#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "kernels/shared.h"
#include "luciole/array_memory.hpp"
#include "luciole/scene.hpp"
#include "luciole/settings.hpp"
#include "raster/meshlets.hpp"
#include "raster/view.hpp"
#include "shadow/maps/shadow_sizes.hpp"

namespace luciole {

/// A face as it is drawn.
struct PlannedFace {
  std::uint32_t light;  ///< index into Scene::lights
  View view;            ///< of the whole face, from the light
  glm::ivec2 first{0};  ///< of the rectangle of texels that memory holds; whole bins but for the face's rim
  glm::ivec2 count{0};  ///< of the rectangle; 0: nothing is drawn yet
  std::vector<float> farthest;  ///< one a bin of the face: drawn down to this depth; infinity: not drawn
};

/// The shadow maps of a scene for one camera: a plan of all faces, and texels only where lookups need them.
///
///     map_of_light    light ─► map, or kNoShadow
///     maps            how lookups get from a view-space point to a face   80 bytes a light
///     faces, planned  a face as lookups and as drawing see it             6 a cube, 1 a cone, 1 a cascade
///     texels          drawn rectangles of faces, one after another        8 bytes a texel
struct ShadowMaps {
  std::vector<ShadowMap> maps;
  std::vector<std::uint32_t> map_of_light;
  std::vector<ShadowFace> faces;
  std::vector<PlannedFace> planned;
  std::vector<ShadowTexel, RawArrayAllocator<ShadowTexel>> texels;
  /// Lookups follow that reach a little farther than those before. So bins are drawn down to half of the
  /// reversed depth that is needed, and rectangles have a bin to spare on each side.
  bool expects_more = false;
  ShadowMethod method = ShadowMethod::kOff;
  Meshlets meshlets;
  std::size_t bin_count = 0;         ///< of all faces
  std::size_t planned_texels = 0;    ///< if all of every face were drawn
  std::uint64_t reduced_lights = 0;  ///< lights whose maps are coarser than wanted, for lack of memory
};

/// Plans the maps of all lights with a shadow, or if `ways` aren't empty, of those whose way is kMap; draws
/// nothing. The plan is for the camera's whole picture,
/// whatever the crop. See cascadeSpheres for what maps cover and chooseSizes for how fine they are. Throws
/// MachineError where even the coarsest maps exceed limits.bytes.
ShadowMaps planShadowMaps(const Scene& scene, const View& camera_view, ShadowMethod method,
                          const ShadowLimits& limits, std::span<const ShadowWay> ways = {});

}  // namespace luciole
