#include "render/render.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>
#include <utility>

#include "base/machine_memory.hpp"
#include "base/trace.hpp"
#include "culling/exact_reason.hpp"
#include "culling/fog_cull.hpp"
#include "gbuffer/planes.hpp"
#include "raster/lift.hpp"
#include "raster/shading_points.hpp"
#include "raster/view.hpp"
#include "render/assemble.hpp"
#include "render/light_layers.hpp"
#include "render/lighting.hpp"
#include "render/memory.hpp"
#include "render/pixel_sums.hpp"
#include "render/shadow_ways.hpp"
#include "render/surface_ids.hpp"
#include "render/uneven_pixels.hpp"

namespace luciole {
namespace {

constexpr Feature kFogFeatures[] = {Feature::kFogLinear, Feature::kFogExp, Feature::kFogExp2,
                                    Feature::kFogPerChannel, Feature::kFogRadial};

/// Features of the pass that lights vertices for Gouraud shading: without fog, which is applied to pixels.
FeatureSet vertexFeatures(FeatureSet features) {
  for (const Feature fog : kFogFeatures) features.set(fog, false);
  features.set(Feature::kOutputShadow, false);
  // A vertex lies on the smooth surface already.
  features.set(Feature::kLift, false);
  return features;
}

/// Features of the pass that only applies fog, to lit colours in the emission planes.
FeatureSet fogOnly(const FeatureSet& features) {
  FeatureSet kept;
  kept.set(Feature::kEmission);
  for (const Feature fog : kFogFeatures) kept.set(fog, features.has(fog));
  return kept;
}

void addCount(Stats& stats, const std::string& name, std::uint64_t count) {
  for (auto& [known, sum] : stats.counts) {
    if (known == name) {
      sum += count;
      return;
    }
  }
  stats.counts.emplace_back(name, count);
}

/// Adds to the statistics what clusters of lights cost a pass.
void countClusters(const ClusteredLightCounts& counts, Stats& stats) {
  addCount(stats, "pixel_clusters_evaluated", counts.clusters);
  addCount(stats, "pixel_clustered_lights_evaluated", counts.lights);
  addCount(stats, "pixels_redone", counts.redone);
}

/// Adds to the statistics how far the light of clusters may be wrong.
void countLightErrors(const GBuffer& gbuffer, const LitPlanes& lit, Stats& stats) {
  const std::size_t n = gbuffer.pixels();
  const auto add = [&](const tbb::blocked_range<std::size_t>& some, LightErrorStats bounds) {
    for (std::size_t i = some.begin(); i < some.end(); ++i) {
      if (!std::isfinite(gbuffer.position[i + 2 * n])) continue;
      for (int c = 0; c < 3; ++c) {
        const double bound = lit.light_error[i + c * n];
        bounds.largest = std::max(bounds.largest, bound);
        bounds.sum += bound;
        bounds.least = std::max(bounds.least, bound / std::max(1.0, double(lit.color[i + c * n])));
      }
      bounds.values += 3;
    }
    return bounds;
  };
  const auto join = [](const LightErrorStats& a, const LightErrorStats& b) {
    return LightErrorStats{std::max(a.largest, b.largest), a.sum + b.sum, std::max(a.least, b.least),
                           a.values + b.values};
  };
  // The sum's order, and with it its last bits, doesn't depend on the threads.
  stats.light_error = join(stats.light_error, tbb::parallel_deterministic_reduce(
                                                  tbb::blocked_range<std::size_t>(0, n, kTilePixels),
                                                  LightErrorStats{}, add, join));
}

/// Says how many lights clusters stand for, and why not for the others. Nothing where that wasn't asked for.
void countLightUses(const Scene& scene, const ShadeSettings& settings, const Lighting& lighting,
                    Stats& stats) {
  if (!(settings.light_error > 0) || !scene.lighting) return;
  addCount(stats, "lights_stood_for", lighting.clustered_lights);
  addCount(stats, "lights_exact", scene.lights.size() - lighting.clustered_lights);
  const auto counts = countReasons(scene.lights, lightUse(settings));
  for (std::size_t reason = 1; reason < counts.size(); ++reason)
    if (counts[reason] > 0)
      addCount(stats, std::string("lights_exact_by_") + exactReasonName(ExactReason(reason)), counts[reason]);
  const std::size_t few = counts[0] - lighting.clustered_lights;
  if (few > 0) addCount(stats, "lights_exact_as_few", few);
}

/// The colours of the lit vertices, in the order of gatherVertices(), before fog.
std::vector<glm::vec3> lightVertices(Device& device, const Scene& scene,
                                     const std::vector<std::uint32_t>& objects, const View& view,
                                     Lighting& lighting, Stats& stats) {
  const FeatureSet features = vertexFeatures(lighting.features);
  const GBuffer vertices = timed(stats, Stage::kGatherVertices, [&] {
    return gatherVertices(scene, objects, view, neededPlanes(features));
  });
  const LitPlanes lit = lightGBuffer(device, scene, lighting, features, vertices, {}, stats);
  if (!lit.light_error.empty()) {
    countClusters(lit.clustered, stats);
    glm::vec3 largest(0.0f);
    for (std::size_t i = 0; i < lit.light_error.size(); ++i)
      largest[int(i / vertices.pixels())] = std::max(largest[int(i / vertices.pixels())], lit.light_error[i]);
    lighting.vertex_error = largest;
  }
  std::vector<glm::vec3> colors(vertices.pixels());
  for (std::size_t i = 0; i < colors.size(); ++i)
    colors[i] = {lit.color[i], lit.color[i + colors.size()], lit.color[i + 2 * colors.size()]};
  return colors;
}

std::uint64_t coveredPixels(const GBuffer& gbuffer) {
  const float* depth = gbuffer.position.data() + 2 * gbuffer.pixels();
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, gbuffer.pixels()), std::uint64_t(0),
      [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t sum) {
        return sum + std::count_if(depth + range.begin(), depth + range.end(),
                                   [](float z) { return z > -std::numeric_limits<float>::infinity(); });
      },
      std::plus<>());
}

/// Adds a pass to the statistics. counted: whether lit.evaluated was counted.
void countPass(const GBuffer& gbuffer, const LitPlanes& lit, bool counted, Stats& stats) {
  addCount(stats, "pixels_lit", coveredPixels(gbuffer));
  if (counted) addCount(stats, "pixel_lights_evaluated", lit.evaluated);
  if (lit.by_beams > 0) addCount(stats, "shadow_pairs_exact", lit.by_beams);
  if (lit.by_maps > 0) addCount(stats, "shadow_pairs_by_maps", lit.by_maps);
  addCount(stats, "list_entries", lit.list_entries);
  if (!lit.light_error.empty()) {
    countClusters(lit.clustered, stats);
    countLightErrors(gbuffer, lit, stats);
  }
  if (lit.pairs.soft_lit + lit.pairs.soft_dark + lit.traced.soft > 0) {
    addCount(stats, "soft_pairs_lit", lit.pairs.soft_lit);
    addCount(stats, "soft_pairs_dark", lit.pairs.soft_dark);
    addCount(stats, "soft_pairs_by_rays", lit.traced.soft);
  }
  if (lit.traced.rays > 0) addCount(stats, "shadow_rays", lit.traced.rays);
  if (lit.light_count.empty()) return;
  double in_range = 0;
  for (const float count : lit.light_count) in_range += count;
  addCount(stats, "pixel_lights_in_range", static_cast<std::uint64_t>(in_range));
}

void countTriangles(const RasterCounts& counts, Stats& stats) {
  addCount(stats, "triangles_submitted", counts.submitted);
  addCount(stats, "triangles_back_facing", counts.back_facing);
  addCount(stats, "triangles_outside", counts.outside);
}

/// Says how many lights cast shadows, and by what.
void countShadows(const Lighting& lighting, Stats& stats) {
  const ShadowMaps& shadows = lighting.host_shadows;
  const std::vector<BeamLight>& lights = lighting.beams.lights;
  const std::size_t exact =
      std::count_if(lights.begin(), lights.end(), [](const BeamLight& light) { return light.casts != 0; });
  if (shadows.maps.size() + exact == 0) return;
  addCount(stats, "shadow_lights", shadows.maps.size() + exact);
  if (exact > 0) addCount(stats, "shadow_lights_exact", exact);
  if (shadows.maps.empty()) return;
  addCount(stats, "shadow_lights_by_maps", shadows.maps.size());
  addCount(stats, "shadow_lights_reduced", shadows.reduced_lights);
  std::uint64_t drawn = 0;
  for (const PlannedFace& face : shadows.planned) drawn += face.count.x > 0;
  addCount(stats, "shadow_faces_drawn", drawn);
  addCount(stats, "shadow_bytes", shadows.texels.size() * sizeof(ShadowTexel));
}

/// Compiles the kernels of these passes in a thread of its own, once the device is open. The future's value
/// is the milliseconds that compiling took.
std::future<double> startCompiling(Device& device, const std::vector<FeatureSet>& passes,
                                   const ShadeSettings& settings) {
  return std::async(std::launch::async, [&device, passes, settings] {
    awaitDevice(device);
    const TraceThread thread("kernel compiler");
    const std::int64_t begin = nanosecondsSinceStart();
    for (const FeatureSet& features : passes) compileKernels(device, features, settings);
    return endStage(Stage::kCompileKernels, begin);
  });
}

/// Adds the features that layers of light need beside those of the picture.
void addPassesOf(const std::vector<LightLayer>& layers, const FeatureSet& features,
                 std::vector<FeatureSet>& passes) {
  for (const LightLayer& layer : layers) {
    const FeatureSet needed = layerFeatures(features, layer);
    if (std::find(passes.begin(), passes.end(), needed) == passes.end()) passes.push_back(needed);
  }
}

void awaitKernels(std::future<double>& compiling, Device& device, Stats& stats) {
  const double milliseconds = timed(stats, Stage::kWaitForKernels, [&] { return compiling.get(); });
  addStage(stats, Stage::kCompileKernels, milliseconds);
  addStage(stats, Stage::kOpenDevice, std::exchange(device.milliseconds_to_open, 0));
  stats.beside = {Stage::kCompileKernels, Stage::kOpenDevice};
  stats.device = device.description;
}

/// Adds to a picture's statistics what buffers cost from its beginning to its end.
struct TrafficMeter {
  Device& device;
  Stats& stats;
  Traffic before = trafficOf(device);

  ~TrafficMeter() {
    const Traffic after = trafficOf(device);
    stats.traffic.bytes_up += after.bytes_up - before.bytes_up;
    stats.traffic.bytes_down += after.bytes_down - before.bytes_down;
    stats.traffic.bytes_made += after.bytes_made - before.bytes_made;
  }
};

/// What to count for this sample: for layers only in the first one, for statistics in all.
PixelCounts wantedCounts(const RenderSettings& settings, int sample) {
  return {.evaluated = settings.count_lights,
          .in_range = settings.count_lights || (sample == 0 && wants(settings, Aov::kLightCount)),
          .list_length = sample == 0 && wants(settings, Aov::kListLength)};
}

/// Memory of a band that is done with, for the next one: the system takes as long to clear fresh memory as
/// its pixels take to be shaded.
struct UsedMemory {
  GBuffer gbuffer;
  Plane color;
  Image picture;
};

/// What the bands of a picture share.
struct Prepared {
  FeatureSet features;  ///< of the pass that shades pixels
  std::vector<std::uint32_t> objects;
  Lighting lighting;
  std::vector<LayerLighting> layers;  ///< of light
  std::vector<glm::vec3> vertex_colors;
  PlaneSet planes;
  UsedMemory used;
};

/// Counts passes, and reports each.
struct Progress {
  const std::function<void(int, int)>& report;
  int passes;
  int done = 0;

  void step() {
    ++done;
    if (report) report(done, passes);
  }
};

/// The names of layers of light.
std::vector<std::string> namesOf(const std::vector<LayerLighting>& layers) {
  std::vector<std::string> names;
  for (const LayerLighting& one : layers) names.push_back(one.layer.name);
  return names;
}

/// The first channel of a layer of light: they come last.
std::size_t channelOfLayer(const Image& picture, std::size_t layer, std::size_t layers) {
  return picture.channels.size() - 3 * (layers - layer);
}

void addPlanes(const Plane& more, std::size_t count, Plane& sum) {
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) { sum[i] += more[i]; });
}

/// The pixels that `view` shows, with each sample rasterized and shaded by itself.
Image renderAllSamples(Device& device, const Scene& scene, const RenderSettings& settings, Prepared& prepared,
                       const View& view, RasterCounts& triangles, Progress& progress, Stats& stats) {
  UsedMemory& used = prepared.used;
  Image picture;
  View of_sample = view;
  PixelSums sums;
  std::vector<Plane> layer_sums(prepared.layers.size());
  for (int sample = 0; sample < settings.samples; ++sample) {
    const TraceSpan span("sample", {{"sample", sample}, {"samples", settings.samples}});
    of_sample.sample = samplePoint(sample, settings.samples);
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
    progress.step();
  }
  used.color = std::move(sums.color);
  return picture;
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

/// The pixels that `view` shows, with one shading for the samples that see the same surface.
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
  progress.step();
  return cut;
}

/// The models that surfaces choose.
ModelChoices modelChoices(const GBuffer& gbuffer) {
  ModelChoices choices;
  if (gbuffer.model.empty()) choices.set(0);
  for (std::size_t i = 0; i < gbuffer.model.size(); ++i)
    if (std::isfinite(gbuffer.position[i + 2 * gbuffer.pixels()])) choices.set(gbuffer.model[i]);
  return choices;
}

/// Whether any pixel reflects specular light.
bool anyShines(const GBuffer& gbuffer) {
  const auto colors = std::ptrdiff_t(gbuffer.specular.empty() ? 0 : 3 * gbuffer.pixels());
  return std::any_of(gbuffer.specular.begin(), gbuffer.specular.begin() + colors,
                     [](float color) { return color > 0; });
}

}  // namespace

ShadeSettings pictureShading(const Scene& scene, const RenderSettings& settings) {
  ShadeSettings shade = settings.shade;
  shade.shadow_layer = wants(settings, Aov::kShadow);
  chooseModel(modelChoices(scene), shade);
  if (wantsLightLayers(settings)) shade.light_error = 0;
  if (shade.shadows != ShadowMethod::kAuto || !shade.shadow_ways.empty() || !scene.lighting) return shade;
  const double points = shadedPoints(scene, settings.size, settings.samples, sharesSamples(settings));
  shade.shadow_ways =
      shadowWays(scene, cameraView(settings.camera, settings.size), points, shade.shadow_limits);
  return shade;
}

PictureFeatures pictureFeatures(const Scene& scene, const RenderSettings& settings) {
  SurfaceTraits surfaces = materialTraits(scene);
  surfaces.smooth &= settings.shading != Shading::kFlat;
  surfaces.normal_maps &= settings.shading == Shading::kPhong;
  PictureFeatures result;
  const ShadeSettings shade = pictureShading(scene, settings);
  const View view = cameraView(settings.camera, settings.size);
  result.all =
      neededFeatures(scene, settings.camera, surfaces, shade, standsForLights(scene, view, surfaces, shade));
  result.pixels = settings.shading == Shading::kGouraud ? fogOnly(result.all) : result.all;
  result.planes = neededPlanes(result.pixels);
  // The light of clusters has planes of its own.
  if (result.pixels.has(Feature::kClusteredLights)) result.planes.emission = surfaces.emission;
  if (!scene.lighting) result.planes.ambient = false;  // diffuse takes its place
  if (wants(settings, Aov::kMaterial))
    result.planes.specular = result.planes.ambient = result.planes.emission = true;
  return result;
}

void describeScene(const Scene& scene, const FeatureSet& features, Stats& stats) {
  stats.triangles = 0;
  for (const Object& object : scene.objects) stats.triangles += scene.meshes[object.mesh].triangles.size();
  stats.lights = scene.lights.size();
  stats.warnings = scene.warnings;
  stats.features = featureNames(features);
}

void renderBands(Device& device, const Scene& scene, const RenderSettings& settings, const RowSink& take,
                 Stats& stats, KeptShadows* kept) {
  const TrafficMeter meter{device, stats};
  const View view = cameraView(settings.camera, settings.size, settings.crop);
  const TraceSpan span("picture", {{"width", view.crop_size.x},
                                   {"height", view.crop_size.y},
                                   {"samples", settings.samples},
                                   {"objects", std::int64_t(scene.objects.size())},
                                   {"lights", std::int64_t(scene.lights.size())}});
  const ShadeSettings shade = pictureShading(scene, settings);
  const auto [features, pixel_features, planes] = pictureFeatures(scene, settings);
  const bool gouraud = settings.shading == Shading::kGouraud;
  Prepared prepared;
  prepared.features = pixel_features;
  prepared.planes = planes;
  std::vector<FeatureSet> passes{prepared.features};
  if (gouraud) passes.push_back(vertexFeatures(features));
  std::vector<LightLayer> layers = lightLayers(scene, settings);
  addPassesOf(layers, prepared.features, passes);
  std::future<double> compiling = startCompiling(device, passes, shade);
  prepared.objects = settings.alpha ? allObjects(scene)
                                    : objectsInSight(scene, view, settings.exposure, settings.shade.model);
  prepareLighting(device, scene, settings.camera, view, features, shade, prepared.lighting, stats, kept);
  prepared.lighting.host_shadows.expects_more = settings.samples > 1;
  if (settings.alpha) prepared.lighting.frame.background = {};
  prepared.layers = timed(stats, Stage::kPrepareLights,
                          [&] { return prepareLayers(device, scene, prepared.lighting, std::move(layers)); });
  awaitKernels(compiling, device, stats);
  if (gouraud)
    prepared.vertex_colors = lightVertices(device, scene, prepared.objects, view, prepared.lighting, stats);

  describeScene(scene, features, stats);
  stats.width = view.crop_size.x;
  stats.height = view.crop_size.y;
  stats.samples = settings.samples;
  const std::size_t pixel_bytes = bytesPerPixel(settings, prepared.planes, prepared.features, scene);
  const int height =
      settings.band_height > 0 ? settings.band_height : bandHeight(view.crop_size, pixel_bytes);
  const int tallest = std::min(height, view.crop_size.y);
  requireMemory(double(pixel_bytes) * view.crop_size.x * tallest,
                fmt::format("a band of {}x{} pixels", view.crop_size.x, tallest));
  const bool shared = sharesSamples(settings);
  // The row from which bands are counted. Points of a bin are lit by the same clusters, so there no band may
  // end within a bin. Bins are counted from the picture's corner, and other pixels' tiles from the crop's.
  const bool whole_bins = shared && prepared.features.has(Feature::kClusteredLights);
  const int top = view.crop_origin.y, bottom = top + view.crop_size.y, origin = whole_bins ? 0 : top;
  const int bands = (bottom - 1 - origin) / height - (top - origin) / height + 1;
  Progress progress{settings.on_pass, bands * (shared ? 1 : settings.samples)};
  RasterCounts triangles;
  const MatteIds matte_ids = matteIds(scene, settings);
  View band = view;
  for (int y = top; y < bottom; y += band.crop_size.y) {
    const int end = std::min(origin + ((y - origin) / height + 1) * height, bottom);
    band.crop_origin.y = y;
    band.crop_size.y = end - y;
    const TraceSpan of_band("band", {{"first_row", band.crop_origin.y},
                                     {"pixels", std::int64_t(band.crop_size.x) * band.crop_size.y}});
    const auto render = shared ? renderSharedSamples : renderAllSamples;
    prepared.used.picture = render(device, scene, settings, prepared, band, triangles, progress, stats);
    if (wantsSurfaceIds(settings))
      timed(stats, Stage::kRasterize,
            [&] { setSurfaceIds(scene, band, settings, matte_ids, prepared.used.picture); });
    take(prepared.used.picture);
  }
  countLightUses(scene, shade, prepared.lighting, stats);
  countShadows(prepared.lighting, stats);
  countTriangles(triangles, stats);
  addCount(stats, "objects_hidden_by_fog", scene.objects.size() - prepared.objects.size());
  if (!kept) return;
  giveBack(prepared.lighting.shadow_faces);
  giveBack(prepared.lighting.shadow_texels);
  keepMaps(scene, std::move(prepared.lighting.host_shadows), *kept);
}

Image renderScene(Device& device, const Scene& scene, const RenderSettings& settings, Stats& stats) {
  Image picture;
  renderBands(
      device, scene, settings,
      [&](const Image& rows) {
        picture.width = rows.width;
        picture.height += rows.height;
        picture.channels = rows.channels;
        picture.pixels.insert(picture.pixels.end(), rows.pixels.begin(), rows.pixels.end());
      },
      stats);
  return picture;
}

GBuffer rasterizeScene(Device* device, const Scene& scene, const RenderSettings& settings, Stats& stats) {
  const View view = cameraView(settings.camera, settings.size, settings.crop);
  requireMemory(double(kGBufferBytesPerPixel) * view.crop_size.x * view.crop_size.y,
                fmt::format("a G-buffer of {}x{} pixels", view.crop_size.x, view.crop_size.y));
  const std::vector<std::uint32_t> objects =
      objectsInSight(scene, view, settings.exposure, settings.shade.model);
  const ShadeSettings shade = pictureShading(scene, settings);
  const SurfaceTraits surfaces = materialTraits(scene);
  const FeatureSet features =
      neededFeatures(scene, settings.camera, surfaces, shade, standsForLights(scene, view, surfaces, shade));
  describeScene(scene, features, stats);
  stats.width = view.crop_size.x;
  stats.height = view.crop_size.y;
  std::vector<glm::vec3> vertex_colors;
  if (settings.shading == Shading::kGouraud) {
    const TrafficMeter meter{*device, stats};
    Lighting lighting;
    prepareLighting(*device, scene, settings.camera, view, features, shade, lighting, stats);
    vertex_colors = lightVertices(*device, scene, objects, view, lighting, stats);
  }
  RasterCounts triangles;
  GBuffer gbuffer = timed(stats, Stage::kRasterize, [&] {
    const bool smooth = settings.shading == Shading::kPhong && hasBentCorners(scene);
    return rasterize(scene, objects, view, settings.shading,
                     {.specular = true,
                      .ambient = true,
                      .emission = true,
                      .geometric_normal = true,
                      .lift = smooth,
                      .unbent = settings.shading == Shading::kPhong && surfaces.normal_maps,
                      .model = surfaces.models.to_ulong() > 1},
                     vertex_colors, &triangles);
  });
  gbuffer.camera = settings.camera;
  addCount(stats, "pixels_lit", coveredPixels(gbuffer));
  countTriangles(triangles, stats);
  addCount(stats, "objects_hidden_by_fog", scene.objects.size() - objects.size());
  return gbuffer;
}

Image shadeGBuffer(Device& device, const Scene& scene, const GBuffer& gbuffer, const RenderSettings& settings,
                   Stats& stats) {
  const TrafficMeter meter{device, stats};
  const TraceSpan span(
      "picture",
      {{"width", gbuffer.width}, {"height", gbuffer.height}, {"lights", std::int64_t(scene.lights.size())}});
  RenderSettings one_sample = settings;
  one_sample.samples = 1;
  one_sample.camera = gbuffer.camera;
  one_sample.size = gbuffer.picture_size;
  const SurfaceTraits surfaces{anyShines(gbuffer), !gbuffer.emission.empty(), !gbuffer.lift.empty(),
                               gbuffer.knows_unbent, modelChoices(gbuffer)};
  ShadeSettings shade = pictureShading(scene, one_sample);
  shade.model = settings.shade.model;
  chooseModel(surfaces.models, shade);
  const View view = cameraView(gbuffer.camera, gbuffer.picture_size);
  const FeatureSet features =
      neededFeatures(scene, gbuffer.camera, surfaces, shade, standsForLights(scene, view, surfaces, shade));
  std::vector<LightLayer> layers = lightLayers(scene, one_sample);
  requireMemory(double(gbuffer.width) * gbuffer.height * 3 * double(layers.size() + 1) * sizeof(float),
                fmt::format("{} layers of {}x{} pixels", layers.size() + 1, gbuffer.width, gbuffer.height));
  std::vector<FeatureSet> passes{features};
  addPassesOf(layers, features, passes);
  std::future<double> compiling = startCompiling(device, passes, shade);
  Lighting lighting;
  prepareLighting(device, scene, gbuffer.camera, view, features, shade, lighting, stats);
  if (settings.alpha) lighting.frame.background = {};
  std::vector<LayerLighting> layer_lightings = timed(stats, Stage::kPrepareLights, [&] {
    return prepareLayers(device, scene, lighting, std::move(layers));
  });
  awaitKernels(compiling, device, stats);
  describeScene(scene, features, stats);
  stats.width = gbuffer.width;
  stats.height = gbuffer.height;
  LitPlanes lit = lightGBuffer(device, scene, lighting, features, gbuffer, wantedCounts(settings, 0), stats);
  countPass(gbuffer, lit, settings.count_lights, stats);
  countLightUses(scene, shade, lighting, stats);
  countShadows(lighting, stats);
  Image picture = timed(stats, Stage::kResolve, [&] {
    Image started = startPicture(gbuffer, lit, one_sample, namesOf(layer_lightings));
    PixelSums sums{std::move(lit.color), {}, {}, std::move(lit.light_error)};
    if (countsCovered(settings)) countCovered(gbuffer, sums.covered);
    setColors(gbuffer, sums, one_sample, started);
    return started;
  });
  for (std::size_t layer = 0; layer < layer_lightings.size(); ++layer) {
    const Plane color = lightLayer(device, scene, lighting, layer_lightings[layer], features, gbuffer, stats);
    timed(stats, Stage::kResolve, [&] {
      setLightLayer(gbuffer, color, one_sample, channelOfLayer(picture, layer, layer_lightings.size()),
                    picture);
    });
  }
  return picture;
}

}  // namespace luciole
