#include "render/render.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <future>
#include <utility>

#include "base/machine_memory.hpp"
#include "base/trace.hpp"
#include "cl/device_error.hpp"
#include "culling/fog_cull.hpp"
#include "gbuffer/planes.hpp"
#include "gbuffer/validate_gbuffer.hpp"
#include "raster/bins.hpp"
#include "raster/lift.hpp"
#include "raster/view.hpp"
#include "render/assemble.hpp"
#include "render/count_picture.hpp"
#include "render/light_layers.hpp"
#include "render/lighting.hpp"
#include "render/memory.hpp"
#include "render/pixel_sums.hpp"
#include "render/sample_passes.hpp"
#include "render/shadow_ways.hpp"
#include "render/surface_ids.hpp"
#include "render/validate.hpp"
#include "scene/validate_scene.hpp"

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

void awaitKernels(std::future<double>& compiling, Device& device, const RenderSettings& settings,
                  Stats& stats) {
  const double milliseconds = timed(stats, Stage::kWaitForKernels, [&] {
    if (settings.on_long_compile && compiling.wait_for(std::chrono::seconds(1)) != std::future_status::ready)
      settings.on_long_compile();
    return compiling.get();
  });
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
  for (const Warning& warning : scene.warnings) stats.warnings.push_back(warning.text);
  stats.features = featureNames(features);
}

int bandEnd(int first, const BandLimits& limits) {
  const int end = first + limits.tallest;
  if (end >= limits.bottom) return limits.bottom;
  const int whole_bins = limits.origin + (end - limits.origin) / kBinSize * kBinSize;
  return whole_bins > first ? whole_bins : end;
}

void renderChosenBands(Device& device, const Scene& scene, const RenderSettings& settings,
                       const NextBand& next, const BandSink& take, Stats& stats, KeptShadows* kept) {
  // What an earlier picture kept is of this scene, so that was valid, and stays so at every pose.
  if (!kept || kept->maps_objects.empty()) validateScene(scene);
  validateSettings(settings, scene.lights.size());
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
  awaitKernels(compiling, device, settings, stats);
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
  Progress progress{settings.on_pass, view.crop_size.y * (shared ? 1 : settings.samples)};
  RasterCounts triangles;
  const MatteIds matte_ids = matteIds(scene, settings);
  // Points of a bin are lit by the same clusters, so there no band may end within a bin. Bins are counted
  // from the picture's corner, and other pixels' tiles from the crop's.
  const bool whole_bins = shared && prepared.features.has(Feature::kClusteredLights);
  BandLimits limits{height, whole_bins ? 0 : view.crop_origin.y, view.crop_origin.y + view.crop_size.y};
  const auto makeBand = [&](const Band& rows) {
    View band = view;
    band.crop_origin.y = rows.first;
    band.crop_size.y = rows.height;
    const TraceSpan of_band("band", {{"first_row", band.crop_origin.y},
                                     {"pixels", std::int64_t(band.crop_size.x) * band.crop_size.y}});
    const auto render = shared ? renderSharedSamples : renderAllSamples;
    Image picture = render(device, scene, settings, prepared, band, triangles, progress, stats);
    if (wantsSurfaceIds(settings))
      timed(stats, Stage::kRasterize, [&] { setSurfaceIds(scene, band, settings, matte_ids, picture); });
    return picture;
  };
  while (const std::optional<Band> asked = next(limits)) {
    for (Band left = *asked; left.height > 0;) {
      const Band rows{
          left.first,
          bandEnd(left.first, {limits.tallest, limits.origin, left.first + left.height}) - left.first};
      const Stats stats_before = stats;
      const RasterCounts triangles_before = triangles;
      const int done_before = progress.done;
      try {
        prepared.used.picture = makeBand(rows);
      } catch (const DeviceError& error) {
        // How long light lists are only turns out while they are made. Fewer rows have shorter ones.
        if (!error.is_out_of_memory || rows.height <= kBinSize) throw;
        stats = stats_before;
        triangles = triangles_before;
        progress.done = done_before;
        limits.tallest = std::max(rows.height / 2, kBinSize);
        continue;
      }
      take(rows, prepared.used.picture);
      left = {rows.first + rows.height, left.height - rows.height};
    }
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

void renderBands(Device& device, const Scene& scene, const RenderSettings& settings, const RowSink& take,
                 Stats& stats, KeptShadows* kept) {
  std::optional<int> begun;
  const auto next = [&](const BandLimits& limits) -> std::optional<Band> {
    const int first = begun.value_or(settings.crop ? settings.crop->y : 0);
    if (first == limits.bottom) return std::nullopt;
    begun = bandEnd(first, limits);
    return Band{first, *begun - first};
  };
  renderChosenBands(
      device, scene, settings, next, [&](const Band&, const Image& rows) { take(rows); }, stats, kept);
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
  validate(scene, settings);
  if (settings.shading == Shading::kGouraud && !device)
    throw InputError("settings.shading: kGouraud lights vertices, expected a device for that");
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
  validateGBuffer(gbuffer);
  RenderSettings one_sample = settings;
  one_sample.samples = 1;
  one_sample.camera = gbuffer.camera;
  one_sample.size = gbuffer.picture_size;
  validate(scene, one_sample);
  const TrafficMeter meter{device, stats};
  const TraceSpan span(
      "picture",
      {{"width", gbuffer.width}, {"height", gbuffer.height}, {"lights", std::int64_t(scene.lights.size())}});
  const SurfaceTraits surfaces{anyShines(gbuffer), !gbuffer.emission.empty(), !gbuffer.lift.empty(),
                               gbuffer.knows_unbent, modelChoices(gbuffer)};
  ShadeSettings shade = pictureShading(scene, one_sample);
  shade.model = settings.shade.model;
  chooseModel(surfaces.models, shade);
  const View view = cameraView(gbuffer.camera, gbuffer.picture_size, {}, gbuffer.display.pixel_aspect);
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
  awaitKernels(compiling, device, settings, stats);
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
