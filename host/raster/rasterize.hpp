#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "kernels/shared.h"
#include "luciole/gbuffer.hpp"
#include "luciole/settings.hpp"
#include "raster/geometry.hpp"
#include "raster/meshlets.hpp"
#include "raster/setup.hpp"
#include "raster/triangle_runs.hpp"
#include "raster/view.hpp"

namespace luciole {

/// Counts of triangles. Each is counted once in `submitted`, and in at most one of the others. Several calls
/// for parts and samples of one picture share their counts: a triangle is outside if it covers no sample in
/// any of them.
struct RasterCounts {
  std::uint64_t submitted = 0;
  std::uint64_t back_facing = 0;
  std::uint64_t outside = 0;           ///< of the view volume, or covering no sample
  std::vector<std::uint8_t> covering;  ///< one a triangle, 1: it covers a sample
};

/// What drawing one view leaves for the next of the same scene, at this pose or another. It saves time and
/// changes no bit. Other scenes must not use it.
struct KeptGeometry {
  SceneRuns runs;
  Geometry geometry;  ///< memory alone, as the next
  RasterSetup setup;
};

/// Draws the given objects (indices into scene.objects) into a G-buffer of the view's crop: visibility first,
/// then attributes once for each visible pixel. Back faces are culled unless double-sided. The nearer surface
/// wins; at equal depth the first in object and triangle order. The result does not depend on the number of
/// threads or on the crop. Throws InputError for a view whose size or crop is out of range, and as
/// placeObjects does.
///
/// `vertex_colors`: empty, or for Shading::kGouraud the lit colours of all vertices of all the given objects,
/// in order (see gatherVertices). Then meshes are drawn in their divided form, the interpolated colour × the
/// diffuse map goes into `emission`, and diffuse, specular and ambient are zero.
///
/// `recycled`: a G-buffer whose memory is reused. `kept`: of the last view, or null.
GBuffer rasterize(const Scene& scene, std::span<const std::uint32_t> objects, const View& view,
                  Shading shading, PlaneSet planes, std::span<const glm::vec3> vertex_colors = {},
                  RasterCounts* counts = nullptr, GBuffer recycled = {}, KeptGeometry* kept = nullptr);

/// Draws a depth map of the given meshlets (ascending indices into meshlets.items): the view's crop, row by
/// row, into `texels` (8 bytes each). Alpha-masked holes stay open, and no face is culled. A texel's content
/// does not depend on the crop, nor on meshlets that don't reach it. `farthest`: for each bin of kBinSize²
/// texels that the crop touches, row by row, the smallest reversed depth that is needed; farther surfaces may
/// be missing. A bin of infinity isn't drawn, and its texels keep their content. Empty: no limit. Throws as
/// rasterize does.
void rasterizeDepth(const Scene& scene, const Meshlets& meshlets, std::span<const std::uint32_t> chosen,
                    const View& view, std::span<const float> farthest, std::span<ShadowTexel> texels);

/// The vertices of the given objects as a G-buffer of their own, for Gouraud shading by the same kernels that
/// shade pixels: vertex i of all (objects in order, the vertices of each mesh's divided form in order) lies
/// at index i of every plane. Its material is that of the first triangle that uses it; textures are left out.
/// Vertices that no triangle uses show nothing. Normals of double-sided materials are turned towards the
/// viewer.
GBuffer gatherVertices(const Scene& scene, std::span<const std::uint32_t> objects, const View& view,
                       PlaneSet planes);

}  // namespace luciole
