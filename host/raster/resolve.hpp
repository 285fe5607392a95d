#pragma once

#include <glm/glm.hpp>
#include <span>

#include "gbuffer/gbuffer.hpp"
#include "raster/coverage.hpp"
#include "raster/rasterize.hpp"

namespace luciole {

/// What a picture's pixels are made of.
struct ResolveInput {
  const Scene& scene;
  const std::vector<PlacedObject>& objects;
  const ViewPlane& plane;
  Shading shading;
  std::span<const glm::vec3> vertex_colors;  ///< as in rasterize(); used for kGouraud only
  bool lifts;                                ///< fill in GBuffer::lift

  bool litVertices() const { return shading == Shading::kGouraud && !vertex_colors.empty(); }
};

/// Fills in a bin's pixels: the attributes, once a pixel, of the triangle that each of them sees.
/// `bin_origin` counts pixels of the whole picture.
void resolveBin(const ResolveInput& input, const BinPixels& pixels, glm::ivec2 bin_origin, GBuffer& gbuffer);

}  // namespace luciole
