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

/// A face for drawing.
struct PlannedFace {
  std::uint32_t light;  ///< index into Scene::lights
  View view;            ///< of the whole face, from the light
  glm::ivec2 first{
      0};  ///< first texel of the rectangle in memory, which has whole bins except at the face's rim
  glm::ivec2 count{0};  ///< of the rectangle; 0: nothing is drawn yet
  std::vector<float>
      farthest;  ///< for each bin the reversed depth down to which it is drawn; infinity: it isn't
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
  RawArray<ShadowTexel> texels;
  /// More passes follow, whose lookups reach a little farther. So bins are drawn down to half of the reversed
  /// depth that is needed, and rectangles have a margin of one bin, to avoid drawing them twice.
  bool expects_more = false;
  ShadowMethod method = ShadowMethod::kOff;
  Meshlets meshlets;
  std::size_t bin_count = 0;         ///< of all faces
  std::size_t planned_texels = 0;    ///< if all of every face were drawn
  std::uint64_t reduced_lights = 0;  ///< lights whose maps are coarser than wanted, for lack of memory
};

/// Plans the maps of all lights with a shadow or, if `ways` isn't empty, of those whose way is kMap. Draws
/// nothing. The plan is for the camera's whole picture, without its crop: cascadeSpheres() says what the maps
/// cover, and chooseSizes() how fine they are. Throws MachineError if even the coarsest maps exceed
/// limits.bytes.
ShadowMaps planShadowMaps(const Scene& scene, const View& camera_view, ShadowMethod method,
                          const ShadowLimits& limits, std::span<const ShadowWay> ways = {});

}  // namespace luciole
