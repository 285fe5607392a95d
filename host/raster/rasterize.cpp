#include "raster/rasterize.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <utility>

#include "raster/bins.hpp"
#include "raster/coverage.hpp"
#include "raster/empty_gbuffer.hpp"
#include "raster/placed_meshlets.hpp"
#include "raster/resolve.hpp"
#include "raster/seen_surface.hpp"
#include "raster/setup.hpp"

namespace luciole {

GBuffer rasterize(const Scene& scene, std::span<const std::uint32_t> objects, const View& view,
                  Shading shading, PlaneSet planes, std::span<const glm::vec3> vertex_colors,
                  RasterCounts* counts, GBuffer recycled, KeptGeometry* kept) {
  checkView(view);
  const bool lit_vertices = shading == Shading::kGouraud && !vertex_colors.empty();
  KeptGeometry own_kept;
  if (!kept) kept = &own_kept;
  updateRuns(scene, lit_vertices, kept->runs);
  const Geometry& geometry = kept->geometry =
      transformObjects(scene, objects, view, lit_vertices, &kept->runs, std::move(kept->geometry));
  const RasterSetup& setup = kept->setup =
      setupTriangles(scene, geometry, view, FaceCulling::kBackFaces, std::move(kept->setup));
  const Bins bins = binTriangles(setup.triangles, view);

  planes.emission |= lit_vertices;
  GBuffer gbuffer = emptyGBuffer(view, planes, std::move(recycled));
  const ViewPlane plane = viewPlane(view);
  const HoleTest holes{scene, geometry.objects, plane, view.number};
  const ResolveInput input{scene,  geometry.objects,  plane, shading, vertex_colors,
                           planes, view.world_to_view};
  RasterCounts own_counts;
  if (!counts) counts = &own_counts;
  counts->covering.resize(geometry.triangle_count);
  // Neighbouring bins see triangles in common.
  tbb::enumerable_thread_specific<SurfaceCache> surfaces([&] { return SurfaceCache(input); });
  tbb::parallel_for(0, bins.size(), [&](int bin) {
    if (bins.list(bin).empty()) return;
    BinPixels pixels;
    drawBin(setup.triangles, bins, bin, holes, counts->covering, pixels);
    resolveBin(input, pixels, bins.origin(bin), surfaces.local(), gbuffer);
  });

  setCounts(geometry.triangle_count, setup, *counts);
  return gbuffer;
}

void rasterizeDepth(const Scene& scene, const Meshlets& meshlets, std::span<const std::uint32_t> chosen,
                    const View& view, std::span<const float> farthest, std::span<ShadowTexel> texels) {
  checkView(view);
  const PlacedMeshlets placed = placeMeshlets(scene, meshlets, chosen, view.world_to_view);
  const RasterSetup setup = setupMeshlets(scene, placed, view);
  const Bins bins = binTriangles(setup.triangles, view, farthest);

  const ViewPlane plane = viewPlane(view);
  const HoleTest holes{scene, placed.objects, plane, std::nullopt};
  tbb::parallel_for(0, bins.size(), [&](int bin) {
    if (!farthest.empty() && !std::isfinite(farthest[bin])) return;
    BinPixels pixels;
    drawBinDepth(setup.triangles, bins, bin, holes, pixels);
    forEachRow(view, bins.origin(bin), [&](int in_bin, std::size_t in_crop, int count) {
      ShadowTexel* row = texels.data() + in_crop;
      for (int i = 0; i < count; ++i) row[i] = {pixels.depth[in_bin + i], pixels.label[in_bin + i]};
    });
  });
}

}  // namespace luciole
