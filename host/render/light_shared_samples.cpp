#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "kernels/shared.h"
#include "lighting/count_picture.hpp"
#include "luciole/planes.hpp"
#include "raster/shading_points.hpp"
#include "raster/uneven_pixels.hpp"
#include "render/assemble.hpp"
#include "render/change_surfaces.hpp"
#include "render/light_points.hpp"
#include "render/memory.hpp"
#include "render/pixel_sums.hpp"
#include "render/sky_background.hpp"

namespace luciole {
namespace {

/// The end of the lists from `first` on that are lit in one pass: at most most_points points, or one list.
std::size_t endOfPass(const PointLists& points, std::size_t first, std::size_t most_points) {
  std::size_t end = first + 1, tiles = tilesOf(points[first]);
  while (end < points.size() && (tiles += tilesOf(points[end])) * kTilePixels <= most_points) ++end;
  return end;
}

/// Removes all points of the pixels that are set.
void removePoints(const std::vector<std::uint8_t>& pixels, SharedSamples& shared) {
  tbb::parallel_for(std::size_t(0), pixels.size(), [&](std::size_t i) {
    if (pixels[i]) shared.samples[i] = 0;
  });
  tbb::parallel_for(std::size_t(0), shared.further.size(), [&](std::size_t list) {
    std::erase_if(shared.further[list], [&](const ShadingPoint& point) { return pixels[point.pixel]; });
  });
}

glm::vec3 backgroundOf(const LightSet& lights) {
  const float4& color = lights.frame.background;
  return {color.x, color.y, color.z};
}

/// Lists a band's shading points: first those of all pixels' first samples, then the other points of pixels
/// that see several surfaces, and last every sample of pixels with uneven light.
struct SharedLister final : PointLister {
  ReadyPicture& picture;
  SampledView sampled;
  SharedSamples shared;  ///< its G-buffer is the layout of all sums
  std::size_t most_points;
  PointCounts counted;
  PixelSums sums;
  std::vector<PixelSums> layer_sums;  ///< colours and bounds alone
  Image image;
  bool is_begun = false;

  // After the first batch: the lists, and the range of the current batch.
  const PointLists* points = nullptr;
  std::size_t first_list = 0, end_list = 0;
  GBuffer gathered;

  // For every sample of the uneven pixels: the bins, and the lists of the current ones.
  std::vector<std::uint8_t> uneven;
  std::vector<std::size_t> in_bins;
  std::size_t next_bin = 0;
  PointLists of_bins;
  std::uint64_t refined_pixels = 0, refined_points = 0;

  SharedLister(ReadyPicture& ready, SampledView view, SharedSamples points_shared)
      : picture(ready), sampled(std::move(view)), shared(std::move(points_shared)) {
    shared.gbuffer.camera = picture.settings.camera;
    changePoints(shared.gbuffer);
    most_points = pointsAPass(shared.gbuffer.pixels());
    layer_sums.resize(picture.layers.size());
    const auto has_background = [](const auto& layer) {
      return backgroundOf(layer.lights) != glm::vec3(0.0f) || layer.lights.sky;
    };
    counted = {countsCovered(picture.settings) || has_background(picture.lighting) ||
                   std::any_of(picture.layers.begin(), picture.layers.end(), has_background),
               picture.settings.wants(Aov::kShadingCount)};
  }

  void changePoints(GBuffer& of_pixels) {
    // Colours lit at vertices are of changed surfaces.
    if (picture.settings.shading != Shading::kGouraud) changeSurfaces(picture, of_pixels);
  }

  bool next() override {
    if (!is_begun) {
      is_begun = true;
      gbuffer = &shared.gbuffer;
      counts = wantedCounts(picture.settings, 0);
      return true;
    }
    if (!points) {
      freePlanes(shared.gbuffer);
      points = &shared.further;
      in_bins = chosenInBins(sampled, uneven);
    }
    while (!gatherLists())
      if (!listBins()) return false;
    gbuffer = &gathered;
    counts = wantedCounts(picture.settings, 1);
    return true;
  }

  /// Gathers the next points of the lists. Returns false where none are left.
  bool gatherLists() {
    do {
      first_list = end_list;
      if (first_list == points->size()) return false;
      end_list = endOfPass(*points, first_list, most_points);
    } while (std::all_of(points->begin() + std::ptrdiff_t(first_list),
                         points->begin() + std::ptrdiff_t(end_list),
                         [](const auto& list) { return list.empty(); }));
    gathered = timed(picture.stats, Stage::kRasterize, [&] {
      return gatherPoints(sampled, *points, first_list, end_list, std::move(gathered));
    });
    gathered.camera = picture.settings.camera;
    changePoints(gathered);
    return true;
  }

  /// Lists every sample of the uneven pixels in the next bins. Returns false where no bins are left.
  bool listBins() {
    if (next_bin == in_bins.size()) return false;
    const std::size_t first = next_bin;
    std::size_t pixels = in_bins[next_bin++];
    while (next_bin < in_bins.size() &&
           (pixels + in_bins[next_bin]) * std::size_t(picture.settings.samples) <= most_points)
      pixels += in_bins[next_bin++];
    refined_pixels += pixels;
    of_bins.clear();
    if (pixels > 0)
      of_bins = timed(picture.stats, Stage::kRasterize,
                      [&] { return everySample(sampled, shared.labels, uneven, int(first), int(next_bin)); });
    for (const std::vector<ShadingPoint>& list : of_bins) refined_points += list.size();
    points = &of_bins;
    end_list = 0;
    return true;
  }

  void take(LitPlanes lit) override {
    countPass(*gbuffer, lit, counts.evaluated, picture.plan.shade.light_error_floor, picture.stats);
    timed(picture.stats, Stage::kResolve, [&] {
      if (points) {
        addPoints(shared.gbuffer, *points, first_list, end_list, lit, gathered.pixels(), sums);
        return;
      }
      image = startPicture(shared.gbuffer, lit, picture.settings, layerNames(picture),
                           std::move(picture.recycled.picture));
      uneven = unevenPixels(sampled, shared, lit.color);
      removePoints(uneven, shared);
      sums = firstPoints(shared.gbuffer, shared.samples, std::move(lit), counted);
    });
  }

  void takeLayer(std::size_t layer, LitPlanes lit) override {
    timed(picture.stats, Stage::kResolve, [&] {
      PixelSums& sum = layer_sums[layer];
      if (points) {
        addPoints(shared.gbuffer, *points, first_list, end_list, lit, gathered.pixels(), sum);
        return;
      }
      lit.half_width = Plane();
      sum = firstPoints(shared.gbuffer, shared.samples, std::move(lit), {});
    });
  }

  /// The image, when all points are lit.
  Image finish() {
    addCount(picture.stats, "refined_pixels", refined_pixels);
    addCount(picture.stats, "refined_points", refined_points);
    return timed(picture.stats, Stage::kResolve, [&] {
      Plane sky;
      const auto addUncovered = [&](const LightSet& lights, Plane& color) {
        if (sums.covered.empty()) return;
        if (!lights.sky) {
          addBackground(backgroundOf(lights), picture.settings.samples, sums.covered, color);
          return;
        }
        if (sky.empty())
          sky = skyPlane(*lights.sky, sampled.view, shared.gbuffer,
                         [&](std::size_t i) { return sums.covered[i] < float(picture.settings.samples); });
        addBackground(sky, picture.settings.samples, sums.covered, color);
      };
      addUncovered(picture.lighting.lights, sums.color);
      setColors(shared.gbuffer, sums, picture.settings, image);
      for (std::size_t layer = 0; layer < layer_sums.size(); ++layer) {
        addUncovered(picture.layers[layer].lights, layer_sums[layer].color);
        setLightLayer(shared.gbuffer, layer_sums[layer], picture.settings, picture.layers[layer].layer,
                      channelOfLayer(picture, image, layer), image);
      }
      return cutOut(std::move(image), sampled.inner.first - sampled.view.crop_origin,
                    sampled.inner.end - sampled.inner.first);
    });
  }
};

}  // namespace

Image lightSharedSamples(ReadyPicture& picture, const View& band, RasterCounts& triangles) {
  const PicturePlan& plan = picture.plan;
  SampledView sampled = timed(picture.stats, Stage::kRasterize, [&] {
    const Margin margin = plan.pixels.lightError() ? Margin::kTiles : Margin::kPixel;
    return setupSamples(picture.scene, picture.objects, band, margin, picture.settings.samples,
                        picture.settings.shading, plan.planes, picture.vertex_colors);
  });
  SharedSamples shared =
      timed(picture.stats, Stage::kRasterize, [&] { return shareSamples(sampled, triangles); });
  sampled.setup = {};
  SharedLister lister(picture, std::move(sampled), std::move(shared));
  lightPoints(picture, plan.pixels, lister);
  return lister.finish();
}

}  // namespace luciole
