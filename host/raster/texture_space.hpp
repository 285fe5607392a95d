#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "raster/rasterize.hpp"

namespace luciole {

/// The coordinates by which a map of a mesh's light is laid out, one a vertex, from 0 to 1: its lightmap_uvs,
/// or else its uvs, moved by whole numbers where they lie in another square. Throws InputError where it has
/// none or they don't fit into a square.
std::vector<glm::vec2> lightMapUvs(const Scene& scene, const Mesh& mesh);

/// The fronts of an object in texture space, by the coordinates of its light map.
struct TextureSpace {
  /// A pixel for each texel, in the view space of the camera: the surface at the texel's middle, or if a
  /// chart covers only other parts of the texel, the nearest point of the chart.
  GBuffer gbuffer;
  std::size_t covered = 0;      ///< texels whose middle lies in a chart
  std::size_t overlapping = 0;  ///< of these, in more than one triangle
};

/// Draws an object (an index into scene.objects) in texture space. Holes in its materials stay covered.
/// Throws InputError for a size or an object out of range, MachineError for a size that doesn't fit into
/// memory, and as validateScene(), lightMapUvs() and rasterize() do.
TextureSpace rasterizeTextureSpace(const Scene& scene, std::uint32_t object, glm::ivec2 size,
                                   const Camera& camera, PlaneSet planes);

}  // namespace luciole
