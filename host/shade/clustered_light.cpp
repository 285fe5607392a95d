#include "shade/clustered_light.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cl/launch.hpp"
#include "kernels/shared.h"
#include "raster/geometry.hpp"

namespace luciole {
namespace {

/// GROUP_RADIUS of kernels/clusters/clustered_light.cl: the largest distance of a group's pixels from its
/// first one, mostly a corner, as a share of the distance from the eye.
constexpr double kGroupWidth = 0.03;
/// The angle of a pixel, in radians, of a picture of 720 rows and 60°.
constexpr double kUsualPixel = 0.0016;
/// Inserting a light into the tree takes as long as summing it at so many pixels.
constexpr double kTreeWork = 3000;

/// The width of a pixel in the picture's middle as a share of its distance.
double pixelAngle(const View& view) {
  return (isPerspective(view) ? 2 / view.projection[1][1] : 1) / view.size.y;
}

}  // namespace

ClusteredLightCounts clusteredLight(OpenedDevice& device, const std::string& defines,
                                    const ClusteredLightArguments& arguments) {
  Kernel kernel = makeKernel(device, "clusters/clustered_light.cl", "clustered_light", defines);
  const GBufferBuffers& gbuffer = arguments.gbuffer;
  const LightClusters& clusters = arguments.clusters;
  const std::size_t tiles = arguments.frame.plane_stride / kTilePixels;
  std::vector<uint> counts(4 * tiles);
  const Buffer<uint> counts_buffer = borrowedForOutput(device, counts);
  const Buffer<const float> rows = borrowed(device, clusters.rows);
  const Buffer<const float> light_rows = borrowed(device, clusters.light_rows);
  const bool shared = &arguments.highlights == &clusters;
  const Buffer<const float> highlight_rows = shared ? rows : borrowed(device, arguments.highlights.rows);
  const Buffer<const float> highlight_light_rows =
      shared ? light_rows : borrowed(device, arguments.highlights.light_rows);
  const ClusterFrame frame{.shade = arguments.frame,
                           .light_count = uint(clusters.lights),
                           .levels = uint(clusters.levels),
                           .light_error = arguments.light_error,
                           .least_value = arguments.least_value,
                           .tiles_x = uint(arguments.tiles_x),
                           .pad = {}};
  const std::size_t runs = std::size_t((arguments.tiles_x + kClusterRun - 1) / kClusterRun);
  launch(device, kernel,
         {{"frame", frame},
          {"position", gbuffer.position},
          {"normal", gbuffer.normal},
          {"diffuse", gbuffer.diffuse},
          {"specular", gbuffer.specular},
          {"rows", rows},
          {"light_rows", light_rows},
          {"highlight_rows", highlight_rows},
          {"highlight_light_rows", highlight_light_rows},
          {"light", arguments.light},
          {"bound", arguments.bound},
          {"counts", counts_buffer}},
         {.items = runs * std::size_t(arguments.tiles_y)});
  download(device, counts_buffer, counts);
  ClusteredLightCounts sums;
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    sums.far += counts[4 * tile];
    sums.clusters += counts[4 * tile + 1];
    sums.lights += counts[4 * tile + 2];
    sums.redone += counts[4 * tile + 3];
  }
  return sums;
}

double clusteredWork(const ClusterableLights& lights, const View& view) {
  // A group of pixels walks the tree once, and is at most kGroupWidth of its distance wide, within a tile: it
  // has up to (kGroupWidth / pixel)² pixels to share the walk, and fewer where a surface slants. Series, and
  // lights that are listed, are summed for each pixel. Together they grow as the pixel's angle, from where a
  // group is a tile.
  const double pixel = std::max(pixelAngle(view), kGroupWidth / (std::sqrt(2.0) * int(kTileSize)));
  // Fitted to Sponza, cornell, city and fireflies, matte, as they are and shiny, of 90 to 720 rows, with 300
  // to 10,000 lights in a box, in clusters and on surfaces, and errors of 1/16 to 1/1024. Clusters then never
  // take more than 1.15 times as long as the lights but for leaves, whose groups are small from near, too
  // (twice), and where all surfaces shine (1.3 times). Few scenes need so much: mostly less lights would do.
  const double root = std::sqrt(double(lights.count)), error = double(lights.light_error);
  const double of_walks =
      200 + root * (lights.highlights ? 7.7 * std::pow(error, -1.0 / 3) : 8 * std::pow(error, -0.2));
  const double pixels = double(view.size.x) * view.size.y;
  return of_walks * pixel / kUsualPixel + kTreeWork * double(lights.count) / pixels;
}

bool clustersAreFaster(const ClusterableLights& lights, const View& view) {
  return clusteredWork(lights, view) < double(lights.count);
}

}  // namespace luciole
