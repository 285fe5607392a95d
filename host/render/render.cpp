#include "render/render.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <utility>

#include "base/machine_memory.hpp"
#include "base/trace.hpp"
#include "culling/fog_cull.hpp"
#include "raster/lift.hpp"
#include "raster/view.hpp"
#include "render/assemble.hpp"
#include "render/lighting.hpp"
#include "render/memory.hpp"

namespace luciole {
namespace {

ShadeSettings shadeSettings(const RenderSettings& settings) {
  ShadeSettings shade = settings.shade;
  shade.shadow_layer = wants(settings, Aov::kShadow);
  return shade;
}

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

/// The colours of the lit vertices, in the order of gatherVertices(), before fog.
std::vector<glm::vec3> lightVertices(Device& device, const Scene& scene,
                                     const std::vector<std::uint32_t>& objects, const View& view,
                                     Lighting& lighting, Stats& stats) {
  const FeatureSet features = vertexFeatures(lighting.features);
  const GBuffer vertices = timed(stats, Stage::kGatherVertices, [&] {
    return gatherVertices(scene, objects, view, neededPlanes(features));
  });
  const LitPlanes lit = lightGBuffer(device, scene, lighting, features, vertices, {}, stats);
  std::vector<glm::vec3> colors(vertices.pixels());
  for (std::size_t i = 0; i < colors.size(); ++i)
    colors[i] = {lit.color[i], lit.color[i + colors.size()], lit.color[i + 2 * colors.size()]};
  return colors;
}

std::uint64_t coveredPixels(const GBuffer& gbuffer) {
  const float* depth = gbuffer.position.data() + 2 * gbuffer.pixels();
  return std::count_if(depth, depth + gbuffer.pixels(),
                       [](float z) { return z > -std::numeric_limits<float>::infinity(); });
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

/// Adds a pass to the statistics. counted: whether lit.evaluated was counted.
void countPass(const GBuffer& gbuffer, const LitPlanes& lit, bool counted, Stats& stats) {
  addCount(stats, "pixels_lit", coveredPixels(gbuffer));
  if (counted) addCount(stats, "pixel_lights_evaluated", lit.evaluated);
  addCount(stats, "list_entries", lit.list_entries);
  if (lit.traced > 0) addCount(stats, "shadow_rays", lit.traced);
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

void countShadows(const ShadowMaps& shadows, Stats& stats) {
  if (shadows.maps.empty()) return;
  addCount(stats, "shadow_lights", shadows.maps.size());
  addCount(stats, "shadow_lights_reduced", shadows.reduced_lights);
  std::uint64_t drawn = 0;
  for (const PlannedFace& face : shadows.planned) drawn += face.count.x > 0;
  addCount(stats, "shadow_faces_drawn", drawn);
  addCount(stats, "shadow_bytes",
           shadows.texels.size() * sizeof(ShadowTexel) + shadows.bounds.size() * sizeof(BoundTexel));
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

/// What the bands of a picture share.
struct Prepared {
  FeatureSet features;  ///< of the pass that shades pixels
  std::vector<std::uint32_t> objects;
  Lighting lighting;
  std::vector<glm::vec3> vertex_colors;
  PlaneSet planes;
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

/// All samples of the pixels that `view` shows.
Image renderBand(Device& device, const Scene& scene, const RenderSettings& settings, Prepared& prepared,
                 View view, RasterCounts& triangles, Progress& progress, Stats& stats) {
  Image picture;
  Plane sum, covered;
  const std::int64_t pixels = std::int64_t(view.crop_size.x) * view.crop_size.y;
  const TraceSpan band("band", {{"first_row", view.crop_origin.y}, {"pixels", pixels}});
  for (int sample = 0; sample < settings.samples; ++sample) {
    const TraceSpan span("sample", {{"sample", sample}, {"samples", settings.samples}});
    view.sample = samplePoint(sample, settings.samples);
    GBuffer gbuffer = timed(stats, Stage::kRasterize, [&] {
      return rasterize(scene, prepared.objects, view, settings.shading, prepared.planes,
                       prepared.vertex_colors, &triangles);
    });
    gbuffer.camera = settings.camera;
    LitPlanes lit = lightGBuffer(device, scene, prepared.lighting, prepared.features, gbuffer,
                                 wantedCounts(settings, sample), stats);
    countPass(gbuffer, lit, settings.count_lights, stats);
    timed(stats, Stage::kResolve, [&] {
      if (sample == 0) {
        picture = startPicture(gbuffer, lit, settings);
        sum = std::move(lit.color);
      } else {
        tbb::parallel_for(std::size_t(0), 3 * gbuffer.pixels(),
                          [&](std::size_t i) { sum[i] += lit.color[i]; });
      }
      if (settings.alpha) countCovered(gbuffer, covered);
      if (sample + 1 == settings.samples) setColors(gbuffer, sum, covered, settings, picture);
    });
    progress.step();
  }
  return picture;
}

}  // namespace

PictureFeatures pictureFeatures(const Scene& scene, const RenderSettings& settings) {
  SurfaceTraits surfaces = materialTraits(scene);
  surfaces.smooth &= settings.shading != Shading::kFlat;
  PictureFeatures result;
  result.all = neededFeatures(scene, settings.camera, surfaces, shadeSettings(settings));
  result.pixels = settings.shading == Shading::kGouraud ? fogOnly(result.all) : result.all;
  result.planes = neededPlanes(result.pixels);
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
                 Stats& stats) {
  const TrafficMeter meter{device, stats};
  const View view = cameraView(settings.camera, settings.size, settings.crop);
  const TraceSpan span("picture", {{"width", view.crop_size.x},
                                   {"height", view.crop_size.y},
                                   {"samples", settings.samples},
                                   {"objects", std::int64_t(scene.objects.size())},
                                   {"lights", std::int64_t(scene.lights.size())}});
  const ShadeSettings shade = shadeSettings(settings);
  const auto [features, pixel_features, planes] = pictureFeatures(scene, settings);
  const bool gouraud = settings.shading == Shading::kGouraud;
  Prepared prepared;
  prepared.features = pixel_features;
  prepared.planes = planes;
  std::vector<FeatureSet> passes{prepared.features};
  if (gouraud) passes.push_back(vertexFeatures(features));
  std::future<double> compiling = startCompiling(device, passes, shade);
  prepared.objects = settings.alpha ? allObjects(scene)
                                    : objectsInSight(scene, view, settings.exposure, settings.shade.model);
  prepareLighting(device, scene, settings.camera, view, features, shade, prepared.lighting, stats);
  if (settings.alpha) prepared.lighting.frame.background = {};
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
  Progress progress{settings.on_pass, (view.crop_size.y + height - 1) / height * settings.samples};
  RasterCounts triangles;
  View band = view;
  for (int y = 0; y < view.crop_size.y; y += height) {
    band.crop_origin.y = view.crop_origin.y + y;
    band.crop_size.y = std::min(height, view.crop_size.y - y);
    take(renderBand(device, scene, settings, prepared, band, triangles, progress, stats));
  }
  countShadows(prepared.lighting.host_shadows, stats);
  countTriangles(triangles, stats);
  addCount(stats, "objects_hidden_by_fog", scene.objects.size() - prepared.objects.size());
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
  const FeatureSet features = neededFeatures(scene, settings.camera, materialTraits(scene), settings.shade);
  describeScene(scene, features, stats);
  stats.width = view.crop_size.x;
  stats.height = view.crop_size.y;
  std::vector<glm::vec3> vertex_colors;
  if (settings.shading == Shading::kGouraud) {
    const TrafficMeter meter{*device, stats};
    Lighting lighting;
    prepareLighting(*device, scene, settings.camera, view, features, settings.shade, lighting, stats);
    vertex_colors = lightVertices(*device, scene, objects, view, lighting, stats);
  }
  RasterCounts triangles;
  GBuffer gbuffer = timed(stats, Stage::kRasterize, [&] {
    const bool smooth = settings.shading == Shading::kPhong && hasBentCorners(scene);
    return rasterize(scene, objects, view, settings.shading, {true, true, true, true, smooth}, vertex_colors,
                     &triangles);
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
  const ShadeSettings shade = shadeSettings(settings);
  const SurfaceTraits surfaces{!gbuffer.specular.empty(), !gbuffer.emission.empty(), !gbuffer.lift.empty()};
  const FeatureSet features = neededFeatures(scene, gbuffer.camera, surfaces, shade);
  std::future<double> compiling = startCompiling(device, {features}, shade);
  Lighting lighting;
  const View view = cameraView(gbuffer.camera, gbuffer.picture_size);
  prepareLighting(device, scene, gbuffer.camera, view, features, shade, lighting, stats);
  if (settings.alpha) lighting.frame.background = {};
  awaitKernels(compiling, device, stats);
  describeScene(scene, features, stats);
  stats.width = gbuffer.width;
  stats.height = gbuffer.height;
  const LitPlanes lit =
      lightGBuffer(device, scene, lighting, features, gbuffer, wantedCounts(settings, 0), stats);
  countPass(gbuffer, lit, settings.count_lights, stats);
  countShadows(lighting.host_shadows, stats);
  RenderSettings one_sample = settings;
  one_sample.samples = 1;
  return timed(stats, Stage::kResolve, [&] {
    Image picture = startPicture(gbuffer, lit, one_sample);
    Plane covered;
    if (settings.alpha) countCovered(gbuffer, covered);
    setColors(gbuffer, lit.color, covered, one_sample, picture);
    return picture;
  });
}

}  // namespace luciole
