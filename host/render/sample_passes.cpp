#include "render/sample_passes.hpp"

#include <tbb/parallel_for.h>

#include <utility>

#include "base/trace.hpp"
#include "gbuffer/planes.hpp"
#include "raster/shading_points.hpp"
#include "raster/view.hpp"
#include "render/assemble.hpp"
#include "render/count_picture.hpp"
#include "render/memory.hpp"
#include "render/pixel_sums.hpp"
#include "render/uneven_pixels.hpp"

namespace luciole {
namespace {

void addPlanes(const Plane& more, std::size_t count, Plane& sum) {
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) { sum[i] += more[i]; });
}

/// The lists from `first` on that are lit together: as many as fill at most so many points' tiles, or one.
std::size_t endOfPass(const PointLists& points, std::size_t first, std::size_t most_points) {
  std::size_t end = first + 1, tiles = points.tiles(first);
  while (end < points.size() && (tiles += points.tiles(end)) * kTilePixels <= most_points) ++end;
  return end;
}

/// Takes from these pixels all their points.
void leaveOut(const std::vector<std::uint8_t>& pixels, SharedSamples& shared) {
  tbb::parallel_for(std::size_t(0), pixels.size(), [&](std::size_t i) {
    if (pixels[i]) shared.samples[i] = 0;
  });
  PointLists& further = shared.further;
  std::size_t kept = 0;
  for (std::size_t list = 0; list < further.size(); ++list) {
    const std::size_t first = std::exchange(further.starts[list], kept), end = further.starts[list + 1];
    for (std::size_t k = first; k < end; ++k)
      if (!pixels[further.items[k].pixel]) further.items[kept++] = further.items[k];
  }
  further.starts.back() = kept;
  further.items.resize(kept);
}

/// The part of a picture from `first` on.
Image cutOut(Image picture, const glm::ivec2& first, const glm::ivec2& size) {
  if (size == glm::ivec2(picture.width, picture.height)) return picture;
  Image part{size.x, size.y, picture.channels, {}};
  const std::size_t step = picture.channels.size();
  part.pixels.reserve(std::size_t(size.x) * size.y * step);
  for (int y = first.y; y < first.y + size.y; ++y) {
    const auto row =
        picture.pixels.begin() + std::ptrdiff_t((std::size_t(y) * picture.width + first.x) * step);
    part.pixels.insert(part.pixels.end(), row, row + std::ptrdiff_t(std::size_t(size.x) * step));
  }
  return part;
}

/// A picture's sums over the samples of its pixels, and those of each layer of its light.
struct PictureSums {
  PixelSums picture;
  std::vector<PixelSums> layers;  ///< colours alone
};

/// Lights points, and adds them to the pixels' sums.
void addLit(Device& device, const Scene& scene, const RenderSettings& settings, Prepared& prepared,
            const SampledView& sampled, const GBuffer& layout, const PointLists& points, PictureSums& sums,
            Stats& stats) {
  const std::size_t most_points = pointsAPass(layout.pixels());
  for (std::size_t first = 0, end; first < points.size(); first = end) {
    end = endOfPass(points, first, most_points);
    if (points.starts[first] == points.starts[end]) continue;
    GBuffer gbuffer =
        timed(stats, Stage::kRasterize, [&] { return gatherPoints(sampled, points, first, end); });
    gbuffer.camera = settings.camera;
    const LitPlanes lit = lightGBuffer(device, scene, prepared.lighting, prepared.features, gbuffer,
                                       wantedCounts(settings, 1), stats);
    countPass(gbuffer, lit, settings.count_lights, stats);
    const auto add = [&](const Plane& color, const Plane& error, PixelSums& to) {
      timed(stats, Stage::kResolve,
            [&] { addPoints(layout, points, first, end, color, error, gbuffer.pixels(), to); });
    };
    add(lit.color, lit.light_error, sums.picture);
    for (std::size_t layer = 0; layer < sums.layers.size(); ++layer)
      add(lightLayer(device, scene, prepared.lighting, prepared.layers[layer], prepared.features, gbuffer,
                     stats),
          {}, sums.layers[layer]);
  }
}

/// Lights every sample of the chosen pixels, some bins after the other, and adds them to the pixels' sums.
void addEverySample(Device& device, const Scene& scene, const RenderSettings& settings, Prepared& prepared,
                    const SampledView& sampled, const SharedSamples& shared,
                    const std::vector<std::uint8_t>& chosen, PictureSums& sums, Stats& stats) {
  const GBuffer& layout = shared.gbuffer;
  const std::vector<std::size_t> in_bins = chosenInBins(sampled, chosen);
  const std::size_t most_points = pointsAPass(layout.pixels());
  std::uint64_t pixels = 0, points = 0;
  for (std::size_t first = 0, end; first < in_bins.size(); first = end) {
    std::size_t in_pass = in_bins[first];
    for (end = first + 1; end < in_bins.size(); ++end) {
      if ((in_pass + in_bins[end]) * std::size_t(settings.samples) > most_points) break;
      in_pass += in_bins[end];
    }
    pixels += in_pass;
    if (in_pass == 0) continue;
    const PointLists lists = timed(stats, Stage::kRasterize, [&] {
      return everySample(sampled, shared.labels, chosen, int(first), int(end));
    });
    points += lists.items.size();
    addLit(device, scene, settings, prepared, sampled, layout, lists, sums, stats);
  }
  addCount(stats, "refined_pixels", pixels);
  addCount(stats, "refined_points", points);
}

}  // namespace

PixelCounts wantedCounts(const RenderSettings& settings, int sample) {
  return {.evaluated = settings.count_lights,
          .in_range = settings.count_lights || (sample == 0 && wants(settings, Aov::kLightCount)),
          .list_length = sample == 0 && wants(settings, Aov::kListLength)};
}

std::vector<std::string> namesOf(const std::vector<LayerLighting>& layers) {
  std::vector<std::string> names;
  for (const LayerLighting& one : layers) names.push_back(one.layer.name);
  return names;
}

std::size_t channelOfLayer(const Image& picture, std::size_t layer, std::size_t layers) {
  return picture.channels.size() - 3 * (layers - layer);
}

Image renderAllSamples(Device& device, const Scene& scene, const RenderSettings& settings, Prepared& prepared,
                       const View& view, RasterCounts& triangles, Progress& progress, Stats& stats) {
  UsedMemory& used = prepared.used;
  Image picture;
  View of_sample = view;
  PixelSums sums;
  std::vector<Plane> layer_sums(prepared.layers.size());
  for (int sample = 0; sample < settings.samples; ++sample) {
    const TraceSpan span("sample", {{"sample", sample}, {"samples", settings.samples}});
    takeSample(of_sample, {sample, settings.samples});
    GBuffer gbuffer = timed(stats, Stage::kRasterize, [&] {
      return rasterize(scene, prepared.objects, of_sample, settings.shading, prepared.planes,
                       prepared.vertex_colors, &triangles, std::move(used.gbuffer));
    });
    gbuffer.camera = settings.camera;
    LitPlanes lit = lightGBuffer(device, scene, prepared.lighting, prepared.features, gbuffer,
                                 wantedCounts(settings, sample), stats, std::move(used.color));
    countPass(gbuffer, lit, settings.count_lights, stats);
    timed(stats, Stage::kResolve, [&] {
      if (sample == 0) {
        picture = startPicture(gbuffer, lit, settings, namesOf(prepared.layers), std::move(used.picture));
        sums.color = std::move(lit.color);
        sums.light_error = std::move(lit.light_error);
      } else {
        addPlanes(lit.color, 3 * gbuffer.pixels(), sums.color);
        addPlanes(lit.light_error, lit.light_error.size(), sums.light_error);
        used.color = std::move(lit.color);
      }
      if (countsCovered(settings)) countCovered(gbuffer, sums.covered);
      if (sample + 1 == settings.samples) setColors(gbuffer, sums, settings, picture);
    });
    for (std::size_t layer = 0; layer < layer_sums.size(); ++layer) {
      Plane& sum = layer_sums[layer];
      Plane color = lightLayer(device, scene, prepared.lighting, prepared.layers[layer], prepared.features,
                               gbuffer, stats, std::move(used.color));
      timed(stats, Stage::kResolve, [&] {
        if (sample > 0) addPlanes(color, 3 * gbuffer.pixels(), sum);
        (sample > 0 ? used.color : sum) = std::move(color);
        if (sample + 1 < settings.samples) return;
        setLightLayer(gbuffer, sum, settings, channelOfLayer(picture, layer, layer_sums.size()), picture);
        used.color = std::move(sum);
      });
    }
    used.gbuffer = std::move(gbuffer);
    progress.step(view.crop_size.y);
  }
  used.color = std::move(sums.color);
  return picture;
}

Image renderSharedSamples(Device& device, const Scene& scene, const RenderSettings& settings,
                          Prepared& prepared, const View& view, RasterCounts& triangles, Progress& progress,
                          Stats& stats) {
  SampledView sampled = timed(stats, Stage::kRasterize, [&] {
    const Margin margin = prepared.features.has(Feature::kClusteredLights) ? Margin::kTiles : Margin::kPixel;
    return setupSamples(scene, prepared.objects, view, margin, settings.samples, settings.shading,
                        prepared.planes, prepared.vertex_colors);
  });
  SharedSamples shared = timed(stats, Stage::kRasterize, [&] { return shareSamples(sampled, triangles); });
  sampled.setup = {};
  shared.gbuffer.camera = settings.camera;
  LitPlanes lit = lightGBuffer(device, scene, prepared.lighting, prepared.features, shared.gbuffer,
                               wantedCounts(settings, 0), stats);
  countPass(shared.gbuffer, lit, settings.count_lights, stats);
  PictureSums sums;
  std::vector<std::uint8_t> uneven;
  Image picture = timed(stats, Stage::kResolve, [&] {
    Image started = startPicture(shared.gbuffer, lit, settings, namesOf(prepared.layers),
                                 std::move(prepared.used.picture));
    uneven = unevenPixels(sampled, shared, lit.color);
    leaveOut(uneven, shared);
    sums.picture =
        firstPoints(shared.gbuffer, shared.samples, std::move(lit.color), std::move(lit.light_error));
    return started;
  });
  for (LayerLighting& layer : prepared.layers) {
    Plane color =
        lightLayer(device, scene, prepared.lighting, layer, prepared.features, shared.gbuffer, stats);
    timed(stats, Stage::kResolve, [&] {
      PixelSums first = firstPoints(shared.gbuffer, shared.samples, std::move(color), {});
      sums.layers.push_back({std::move(first.color), {}, {}, {}});
    });
  }
  freePlanes(shared.gbuffer);
  addLit(device, scene, settings, prepared, sampled, shared.gbuffer, shared.further, sums, stats);
  addEverySample(device, scene, settings, prepared, sampled, shared, uneven, sums, stats);
  Image cut = timed(stats, Stage::kResolve, [&] {
    const Plane& covered = sums.picture.covered;
    const auto addBare = [&](const ShadeFrame& frame, Plane& color) {
      const float4& background = frame.background;
      addBackground({background.x, background.y, background.z}, settings.samples, covered, color);
    };
    addBare(prepared.lighting.frame, sums.picture.color);
    setColors(shared.gbuffer, sums.picture, settings, picture);
    for (std::size_t layer = 0; layer < sums.layers.size(); ++layer) {
      addBare(prepared.layers[layer].frame, sums.layers[layer].color);
      setLightLayer(shared.gbuffer, sums.layers[layer].color, settings,
                    channelOfLayer(picture, layer, sums.layers.size()), picture);
    }
    return cutOut(std::move(picture), sampled.inner.first - sampled.view.crop_origin,
                  sampled.inner.end - sampled.inner.first);
  });
  progress.step(view.crop_size.y);
  return cut;
}

}  // namespace luciole
