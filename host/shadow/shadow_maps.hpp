#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/array_memory.hpp"
#include "base/index_range.hpp"
#include "kernels/shared.h"
#include "raster/triangle_runs.hpp"
#include "raster/view.hpp"
#include "scene/scene.hpp"

namespace luciole {

enum class ShadowMethod : std::uint8_t {
  kOff,
  kHard,   ///< the texel that the point falls into
  kPcf,    ///< the nearest texels, weighted (percentage-closer filtering)
  kSoft,   ///< a disc as wide as the light's size makes the shadow's edge
  kExact,  ///< as rays to the light's middle: by bounds of depth, and where these leave a doubt by rays
};

/// How much shadow maps may take.
struct ShadowLimits {
  int size = 2048;  ///< texels a side of a cascade and of a spot's map; a cube's face: half
  std::size_t bytes = std::size_t(512) << 20;  ///< of all maps together
};

/// A face as it is drawn.
struct PlannedFace {
  std::uint32_t light;  ///< index into Scene::lights
  View view;            ///< of the whole face, from the light
  glm::ivec2 first{0};  ///< of the rectangle of texels that memory holds; whole bins but for the face's rim
  glm::ivec2 count{0};  ///< of its texels; 0: nothing was drawn yet
  std::vector<float> farthest;  ///< one a bin of the face: drawn down to this depth; infinity: not drawn
};

/// The shadow maps of a scene for one camera: first a plan, then texels where somebody looks.
///
///     map_of_light   light ─► map, or kNoShadow
///     maps           how lookups get from a view-space point to a face     80 bytes a light
///     faces, planned the same face for lookups and for drawing             six a point light, one a spot, a
///     cascade each texels         drawn rectangles of faces, one after another           8 bytes a texel
struct ShadowMaps {
  std::vector<ShadowMap> maps;
  std::vector<std::uint32_t> map_of_light;
  std::vector<ShadowFace> faces;
  std::vector<PlannedFace> planned;
  std::vector<ShadowTexel, RawArrayAllocator<ShadowTexel>> texels;
  std::vector<BoundTexel, RawArrayAllocator<BoundTexel>>
      bounds;  ///< in place of texels for ShadowMethod::kExact
  ShadowMethod method = ShadowMethod::kOff;
  TriangleRuns runs;
  std::size_t bin_count = 0;         ///< of all faces
  std::size_t planned_texels = 0;    ///< if all of every face were drawn
  std::uint64_t reduced_lights = 0;  ///< lights whose maps the memory made coarser than wanted
};

/// Whether a shadowed light needs six faces: point lights, and spots too wide for one perspective map.
bool usesCubeMap(const Light& light);

/// Plans the maps of all lights with a shadow; draws nothing. It depends on the whole picture that the camera
/// sees, whatever the crop.
/// - A directional light has four cascades (one under a parallel camera). The last reaches to the farthest
/// that
///   the camera sees of the scene, each other a third as far as the next. Each is a sphere around its part of
///   the view, so that turning the camera changes nothing, on texels that stay where they are in the world.
/// - The others have as many texels as their reach has pixels on the picture, so that a texel is about as
/// large
///   as a pixel.
/// Where that exceeds limits.bytes all maps get coarser, down to kSmallestFace texels a side. Throws
/// MachineError if even that is too much.
ShadowMaps planShadowMaps(const Scene& scene, const View& camera_view, ShadowMethod method,
                          const ShadowLimits& limits);

/// Texels a side: faces have no fewer, and limits ask for no more.
inline constexpr int kSmallestFace = 16, kLargestFace = 16384;

/// Draws the bins that are needed (see findNeeded) and weren't drawn yet, from the triangles that can be seen
/// there within the light's reach, and no farther away than what looks there. Returns the texels that it drew
/// to, of maps.texels or maps.bounds; where there are any, maps.faces changed, too.
std::vector<IndexRange> drawNeeded(const Scene& scene, std::span<const std::uint32_t> needed,
                                   ShadowMaps& maps);

}  // namespace luciole
