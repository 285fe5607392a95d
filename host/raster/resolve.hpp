#pragma once

#include <glm/glm.hpp>
#include <span>

#include "luciole/gbuffer.hpp"
#include "raster/coverage.hpp"
#include "raster/rasterize.hpp"

namespace luciole {

/// The input of resolving the pixels of a picture. It refers to its parts.
struct ResolveInput {
  const Scene& scene;
  const std::vector<PlacedObject>& objects;
  const ViewPlane& plane;
  Shading shading;
  std::span<const glm::vec3> vertex_colors;  ///< as in rasterize(); used for kGouraud only
  const PlaneSet& planes;                    ///< of the G-buffer
  glm::dmat3 world_to_view{1.0};             ///< of the view space of `objects`
  /// For texture space, else null: the same triangles, placed where `plane` sees them. Attributes are those
  /// of the front of `objects`.
  const std::vector<PlacedObject>* flattened_objects = nullptr;

  bool litVertices() const { return shading == Shading::kGouraud && !vertex_colors.empty(); }
};

class SurfaceCache;

/// Writes the attributes of the triangle that each pixel of a bin sees to the G-buffer, as far as the bin
/// lies in the crop. Pixels that see nothing keep their content. `bin_origin`: pixels of the whole picture.
/// `surfaces` must be of this input.
void resolveBin(const ResolveInput& input, const BinPixels& pixels, glm::ivec2 bin_origin,
                SurfaceCache& surfaces, GBuffer& gbuffer);

}  // namespace luciole
