#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gbuffer/gbuffer.hpp"
#include "kernels/shared.h"
#include "raster/meshlets.hpp"
#include "raster/view.hpp"
#include "scene/scene.hpp"

namespace luciole {

enum class Shading : std::uint8_t {
  kFlat,     ///< the triangle's own normal
  kGouraud,  ///< colours lit at the vertices, interpolated
  kPhong,    ///< normals interpolated
};

/// Triangles on their way: every one is counted once in `submitted`, and in one of the others at most. The
/// parts and samples of one picture share their counts: a triangle is outside if it covers no sample of any.
struct RasterCounts {
  std::uint64_t submitted = 0;
  std::uint64_t back_facing = 0;
  std::uint64_t outside = 0;           ///< of the view volume, or covering no sample
  std::vector<std::uint8_t> covering;  ///< one a triangle, 1: it covers a sample
};

/// Draws the given objects (indices into scene.objects) and resolves what each pixel sees: visibility first,
/// then attributes once a visible pixel. Back faces are culled unless double-sided. The nearer surface wins;
/// at equal depth the first in object and triangle order. The result does not depend on the number of threads
/// or on the crop.
///
/// `vertex_colors`: empty, or for Shading::kGouraud the lit colours of all vertices of all the given objects,
/// in order (see gatherVertices). Then meshes are drawn in their divided form, the interpolated colour × the
/// diffuse map goes into `emission`, and diffuse, specular and ambient are zero.
GBuffer rasterize(const Scene& scene, std::span<const std::uint32_t> objects, const View& view,
                  Shading shading, PlaneSet planes, std::span<const glm::vec3> vertex_colors = {},
                  RasterCounts* counts = nullptr);

/// Draws a depth map of the given meshlets (ascending indices into meshlets.items): the view's crop row by
/// row into `texels`. Alpha-masked holes are left open and no face is culled. A texel's content does not
/// depend on the crop, nor on meshlets that don't reach it. `farthest`: one for each bin of kBinSize² texels
/// of the whole picture that the crop touches, row by row: what has a smaller reversed depth may be missing
/// there, and a bin of infinity isn't drawn at all. Empty: all is drawn.
void rasterizeDepth(const Scene& scene, const Meshlets& meshlets, std::span<const std::uint32_t> chosen,
                    const View& view, std::span<const float> farthest, std::span<ShadowTexel> texels);

/// The vertices of the given objects as a G-buffer of their own, for Gouraud shading by the same kernels that
/// shade pixels: vertex i of all (objects in order, the vertices of each mesh's divided form in order) lies
/// at index i of every plane. Its material is that of the first triangle that uses it; textures are left out.
/// Normals of double-sided materials are turned towards the viewer.
GBuffer gatherVertices(const Scene& scene, std::span<const std::uint32_t> objects, const View& view,
                       PlaneSet planes);

}  // namespace luciole
