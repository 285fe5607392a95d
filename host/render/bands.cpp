#include "render/bands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <future>

#include "base/machine_memory.hpp"
#include "base/trace.hpp"
#include "cl/device_error.hpp"
#include "lighting/compile_kernels.hpp"
#include "lighting/count_picture.hpp"
#include "lights/fog_cull.hpp"
#include "raster/bins.hpp"
#include "raster/surface_ids.hpp"
#include "render/assemble.hpp"
#include "render/light_points.hpp"
#include "render/screens.hpp"

namespace luciole {
namespace {

/// Renders a picture's bands.
struct BandMaker {
  ReadyPicture& picture;
  const MatteIds matte_ids;
  RasterCounts triangles = {};
  int rows_done = 0;  ///< in all passes together

  void step(int rows) {
    rows_done += rows;
    const int passes = picture.plan.shares_samples ? 1 : picture.settings.samples;
    if (picture.settings.on_pass) picture.settings.on_pass(rows_done, picture.plan.view.crop_size.y * passes);
  }

  Image make(const Band& rows) {
    View band = picture.plan.view;
    band.crop_origin.y = rows.first;
    band.crop_size.y = rows.height;
    const TraceSpan span("band", {{"first_row", band.crop_origin.y},
                                  {"pixels", std::int64_t(band.crop_size.x) * band.crop_size.y}});
    Image image;
    if (picture.plan.shares_samples) {
      image = lightSharedSamples(picture, band, triangles);
      step(rows.height);
    } else {
      image = lightAllSamples(picture, band, triangles, [&] { step(rows.height); });
    }
    if (wantsSurfaceIds(picture.settings) && !picture.plan.ids_of_gbuffer) {
      const auto channel = [&](Aov aov) { return channelOf(image, picture.settings, aov); };
      const SurfaceIdChannels channels{channel(Aov::kObjectId), channel(Aov::kMaterialId),
                                       channel(Aov::kCryptoObject), channel(Aov::kCryptoMaterial)};
      timed(picture.stats, Stage::kRasterize,
            [&] { setSurfaceIds(picture.scene, band, picture.settings, matte_ids, channels, image); });
    }
    return image;
  }

  /// Renders a band into picture.recycled.picture. If the device's memory doesn't hold it, renders only its
  /// first rows and lowers limits.tallest. Returns the rows rendered.
  Band makeAsMuch(const Band& left, BandLimits& limits) {
    while (true) {
      const int end = bandEnd(left.first, {limits.tallest, limits.origin, left.first + left.height});
      const Band rows{left.first, end - left.first};
      const Stats stats_before = picture.stats;
      const RasterCounts triangles_before = triangles;
      const int done_before = rows_done;
      try {
        picture.recycled.picture = make(rows);
        return rows;
      } catch (const DeviceError& error) {
        // The length of light lists isn't known before. Fewer rows have shorter ones.
        if (!error.is_out_of_memory || rows.height <= kBinSize) throw;
        picture.stats = stats_before;
        triangles = triangles_before;
        rows_done = done_before;
        limits.tallest = std::max(rows.height / 2, kBinSize);
      }
    }
  }
};

/// Where the bands of a picture may end. Points of a bin are lit by the same clusters, so where points are
/// shared no band may end within a bin. Bins are counted from the picture's corner, and other pixels' tiles
/// from the crop's.
BandLimits bandLimits(const PicturePlan& plan) {
  const bool whole_bins = plan.shares_samples && plan.pixels.lightError();
  const int top = plan.view.crop_origin.y;
  return {plan.band_height, whole_bins ? 0 : top, top + plan.view.crop_size.y};
}

}  // namespace

int bandEnd(int first, const BandLimits& limits) {
  const int end = first + limits.tallest;
  if (end >= limits.bottom) return limits.bottom;
  const int whole_bins = limits.origin + (end - limits.origin) / kBinSize * kBinSize;
  return whole_bins > first ? whole_bins : end;
}

void makeBands(OpenedDevice& device, const Scene& scene, const RenderSettings& settings,
               const PicturePlan& plan, const NextBand& next, const BandSink& take, Stats& stats,
               KeptPicture* kept) {
  const TrafficMeter meter{device, stats};
  const glm::ivec2 size = plan.view.crop_size;
  const TraceSpan span("picture", {{"width", size.x},
                                   {"height", size.y},
                                   {"samples", settings.samples},
                                   {"objects", std::int64_t(scene.objects.size())},
                                   {"lights", std::int64_t(scene.lights.size())}});
  ReadyPicture picture{device, scene, settings, plan, stats};
  std::future<double> compiling =
      startCompiling(device, plan.programs, plan.shade, plan.pairs, plan.surface, plan.screens);
  picture.objects = settings.alpha ? allObjects(scene)
                                   : objectsInSight(scene, withMargin(plan.view, plan), settings.exposure,
                                                    settings.shade.model);
  if (kept) picture.recycled = std::move(kept->recycled);
  prepareLights(picture, settings.camera, kept ? &kept->shadows : nullptr);
  picture.lighting.maps.host.expects_more = settings.samples > 1;
  awaitKernels(compiling, device, settings, stats);
  if (settings.shading == Shading::kGouraud) lightVertices(picture);
  describePicture(picture, size);
  const int tallest = std::min(plan.band_height, size.y);
  View band = plan.view;
  band.crop_size.y = tallest;
  const glm::ivec2 drawn = withMargin(band, plan).crop_size;
  requireMemory(double(plan.pixel_bytes) * drawn.x * drawn.y,
                fmt::format("a band of {}x{} pixels", size.x, tallest));
  // Also where the taker of rows has enough of them.
  const auto keep = [&] {
    if (!kept) return;
    keepMaps(scene, takeMaps(picture.lighting.maps), kept->shadows);
    kept->recycled = std::move(picture.recycled);
  };
  BandMaker maker{picture, matteIds(scene, settings)};
  BandLimits limits = bandLimits(plan);
  while (const std::optional<Band> asked = next(limits)) {
    for (Band left = *asked; left.height > 0;) {
      const Band rows = maker.makeAsMuch(left, limits);
      try {
        take(rows, picture.recycled.picture);
      } catch (...) {
        keep();
        throw;
      }
      left = {rows.first + rows.height, left.height - rows.height};
    }
  }
  countLighting(picture);
  addRasterCounts(maker.triangles, stats);
  addCount(stats, "objects_hidden_by_fog", scene.objects.size() - picture.objects.size());
  keep();
}

}  // namespace luciole
