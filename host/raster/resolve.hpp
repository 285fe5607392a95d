#pragma once

#include <glm/glm.hpp>
#include <span>

#include "luciole/gbuffer.hpp"
#include "raster/coverage.hpp"
#include "raster/rasterize.hpp"

namespace luciole {

/// What resolving the pixels of a picture needs. It refers to its parts.
struct ResolveInput {
  const Scene& scene;
  const std::vector<PlacedObject>& objects;
  const ViewPlane& plane;
  Shading shading;
  std::span<const glm::vec3> vertex_colors;  ///< as in rasterize(); used for kGouraud only
  const PlaneSet& planes;                    ///< of the G-buffer
  /// Not null: the plane sees these instead, which have the same triangles, laid out elsewhere, and shows the
  /// fronts of `objects` there.
  const std::vector<PlacedObject>* laid_out = nullptr;

  bool litVertices() const { return shading == Shading::kGouraud && !vertex_colors.empty(); }
};

class SurfaceCache;

/// Writes the attributes of the triangle that each pixel of a bin sees to the G-buffer, as far as the bin
/// lies in the crop. Pixels that see nothing keep their content. `bin_origin`: pixels of the whole picture.
/// `surfaces` must be of this input.
void resolveBin(const ResolveInput& input, const BinPixels& pixels, glm::ivec2 bin_origin,
                SurfaceCache& surfaces, GBuffer& gbuffer);

}  // namespace luciole
