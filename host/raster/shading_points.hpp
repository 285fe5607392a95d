#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/shared.h"
#include "luciole/gbuffer.hpp"
#include "raster/bins.hpp"
#include "raster/rasterize.hpp"
#include "raster/sample_pattern.hpp"
#include "raster/setup.hpp"
#include "raster/surface.hpp"

// Anti-aliasing that shades a surface once a pixel. All samples of a pixel are drawn in one pass. Those that
// see the same surface share a point, which is shaded for all of them.
namespace luciole {

/// A place on a triangle that is shaded for one sample of a pixel or several.
struct ShadingPoint {
  std::uint32_t pixel;       ///< row by row in the crop of SampledView::view
  std::uint32_t triangle;    ///< its number among all
  float x, y;                ///< from the pixel's place in the view (View::sample), in pixels
  float spread_x, spread_y;  ///< as in SquarePlace
  std::uint32_t samples;     ///< that it stands for
};

/// Lists of points, one for each of the parts in which a bin is drawn. A pixel's points are all in one list,
/// of 65,536 points at most.
using PointLists = std::vector<std::vector<ShadingPoint>>;

/// Tiles that a list's points fill. Lists don't share tiles: what else is lit with them leaves a list's
/// tiles, and with them the light of clusters, as they are.
inline std::size_t tilesOf(std::span<const ShadingPoint> list) {
  return (list.size() + kTilePixels - 1) / kTilePixels;
}

/// A scene's triangles, ready to be drawn with several samples a pixel. Refers to the scene and to the
/// vertices' colours.
struct SampledView {
  const Scene& scene;
  Shading shading;
  PlaneSet planes;
  std::span<const glm::vec3> vertex_colors;
  SamplePattern pattern;
  /// With the pattern's origin and reach. Its crop has a margin around `inner` (see setupSamples).
  View view;
  PixelRectangle inner;  ///< the pixels that are wanted
  ViewPlane plane;
  std::vector<PlacedObject> objects;
  std::uint32_t triangle_count;
  RasterSetup setup;
  Bins bins;
};

/// The margin that is drawn around the pixels wanted, inside the picture: one pixel, for neighbours; or all
/// tiles that contain the pixels and their neighbours, counted from the picture's corner. With whole tiles,
/// light that the pixels of a tile share is the same in every band.
enum class Margin : std::uint8_t { kPixel, kTiles };

/// Sets up the given objects for `samples` samples a pixel. The arguments are those of rasterize(), which
/// see; `view.sample` isn't used. Throws as rasterize does.
SampledView setupSamples(const Scene& scene, std::span<const std::uint32_t> objects, const View& view,
                         Margin margin, int samples, Shading shading, PlaneSet planes,
                         std::span<const glm::vec3> vertex_colors);

/// The visible triangles of the samples of the pixels wanted.
struct SampleLabels {
  /// For each pixel, row by row: the index of its first label in its strip's list, times 2, plus 1 if one
  /// label stands for all samples. Undefined outside SampledView::inner.
  std::vector<std::uint32_t> places;
  /// One for each part in which a bin is drawn: triangles' numbers, or kNoTriangle.
  std::vector<std::vector<std::uint32_t>> strips;
};

/// The shading points of a view's samples.
///
/// Samples that see the same triangle share a point. So do those of triangles of one object and material that
/// continue each other: they have an edge's vertices in common and interpolate between them, or where the
/// samples' mean place lies, their planes, normals, colours and texture coordinates agree (kSameShade). The
/// point lies on the triangle that most of the samples see, at the samples' mean place, or the place of the
/// triangle nearest to that. On a triangle with holes it lies at one of the samples.
struct SharedSamples {
  GBuffer gbuffer;                     ///< for each pixel the point of its first sample
  std::vector<std::uint16_t> samples;  ///< number of samples of that point, row by row; 0 for background
  std::vector<std::uint32_t> objects;  ///< index of its object among those drawn, or kNoObject
  PointLists further;                  ///< the other points of the pixels wanted
  SampleLabels labels;
};

constexpr std::uint32_t kNoObject = 0xffffffffu;

/// The largest difference of normals (unit) and vertex colours of triangles that share a point. The triangle
/// that loses its own point has at most half of the samples, so the pixel changes by half of this: one 8-bit
/// step under a light of 1.
constexpr double kSameShade = 2.0 / 255;

/// Draws the samples and groups them into points. The result doesn't depend on the number of threads, and a
/// pixel's points don't depend on the crop. `counts`: as in rasterize(). Throws as allocateArray does.
SharedSamples shareSamples(const SampledView& sampled, RasterCounts& counts);

/// Draws the samples, and calls visit(pixel of the whole picture, triangles' numbers or kNoTriangle of its
/// samples) for each pixel of `inner` in a bin that shows anything, in parallel.
void visitSamples(const SampledView& sampled,
                  const std::function<void(const glm::ivec2&, std::span<const std::uint32_t>)>& visit);

/// How many of the chosen pixels each bin holds. `chosen`: 1 or 0 for each pixel, row by row.
std::vector<std::size_t> chosenInBins(const SampledView& sampled, std::span<const std::uint8_t> chosen);

/// A point for every sample of the chosen pixels in the bins from first_bin up to end_bin that sees a
/// surface, at the sample.
PointLists everySample(const SampledView& sampled, const SampleLabels& labels,
                       std::span<const std::uint8_t> chosen, int first_bin, int end_bin);

/// A G-buffer of the points of the lists from `first` up to `end`, one tile below the other. Each list begins
/// a tile, and the points of a tile follow each other in the planes. `recycled`: as in emptyGBuffer().
GBuffer gatherPoints(const SampledView& sampled, const PointLists& points, std::size_t first, std::size_t end,
                     GBuffer recycled = {});

}  // namespace luciole
