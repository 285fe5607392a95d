#include "render/render.hpp"

#include <fmt/format.h>

#include <future>
#include <utility>

#include "base/machine_memory.hpp"
#include "base/trace.hpp"
#include "gbuffer/validate_gbuffer.hpp"
#include "lighting/compile_kernels.hpp"
#include "lighting/count_picture.hpp"
#include "lights/fog_cull.hpp"
#include "luciole/error.hpp"
#include "raster/lift.hpp"
#include "raster/view.hpp"
#include "render/bands.hpp"
#include "render/change_surfaces.hpp"
#include "render/light_points.hpp"
#include "render/memory.hpp"
#include "render/validate.hpp"
#include "scene/count_triangles.hpp"

namespace luciole {

void describeScene(const Scene& scene, const FeatureSet& features, Stats& stats) {
  stats.triangles = countTriangles(scene);
  stats.lights = scene.lights.size();
  for (const Warning& warning : scene.warnings) stats.warnings.push_back(warning.text);
  stats.features = featureNames(features);
}

void renderBands(OpenedDevice& device, const Scene& scene, const RenderSettings& settings,
                 const RowSink& take, Stats& stats, KeptPicture* kept) {
  validate(scene, settings, kept);
  const PicturePlan plan = planPicture(scene, settings);
  std::optional<int> begun;
  const auto next = [&](const BandLimits& limits) -> std::optional<Band> {
    const int first = begun.value_or(settings.crop ? settings.crop->y : 0);
    if (first == limits.bottom) return std::nullopt;
    begun = bandEnd(first, limits);
    return Band{first, *begun - first};
  };
  makeBands(
      device, scene, settings, plan, next, [&](const Band&, const Image& rows) { take(rows); }, stats, kept);
}

void appendRows(const Image& rows, Image& picture) {
  picture.width = rows.width;
  picture.height += rows.height;
  picture.channels = rows.channels;
  picture.pixels.insert(picture.pixels.end(), rows.pixels.begin(), rows.pixels.end());
}

Image renderScene(OpenedDevice& device, const Scene& scene, const RenderSettings& settings, Stats& stats,
                  KeptPicture* kept) {
  Image picture;
  renderBands(
      device, scene, settings, [&](const Image& rows) { appendRows(rows, picture); }, stats, kept);
  return picture;
}

GBuffer rasterizeScene(OpenedDevice* device, const Scene& scene, const RenderSettings& settings,
                       Stats& stats) {
  validate(scene, settings);
  const bool gouraud = settings.shading == Shading::kGouraud;
  if (gouraud && !device)
    throw InputError("settings.shading: kGouraud lights vertices, expected a device for that");
  if (!settings.surfaces.empty() && !device)
    throw InputError("settings.surfaces: functions of surfaces, expected a device for them");
  const PicturePlan plan = planPicture(scene, settings);
  const glm::ivec2 size = plan.view.crop_size;
  requireMemory(double(kGBufferBytesPerPixel) * size.x * size.y,
                fmt::format("a G-buffer of {}x{} pixels", size.x, size.y));
  const std::vector<std::uint32_t> objects =
      objectsInSight(scene, plan.view, settings.exposure, settings.shade.model);
  describeScene(scene, plan.features, stats);
  stats.width = size.x;
  stats.height = size.y;
  std::vector<glm::vec3> vertex_colors;
  if (gouraud) {
    const TrafficMeter meter{*device, stats};
    ReadyPicture picture{*device, scene, settings, plan, stats, objects};
    prepareLights(picture, settings.camera, nullptr);
    lightVertices(picture);
    vertex_colors = std::move(picture.vertex_colors);
  }
  RasterCounts triangles;
  GBuffer gbuffer = timed(stats, Stage::kRasterize, [&] {
    const bool smooth = settings.shading == Shading::kPhong && hasBentCorners(scene);
    const SurfaceTraits surfaces = materialTraits(scene);
    const bool bent = (settings.shading == Shading::kPhong && surfaces.normal_maps) ||
                      (!gouraud && plan.surface.changes(kNormalGroup));
    PlaneSet planes{.specular = true,
                    .ambient = true,
                    .emission = true,
                    .geometric_normal = !bent,
                    .unbent_normal = bent,
                    .lift = smooth,
                    .model = surfaces.models.to_ulong() > 1};
    if (!gouraud) addGroups(plan.surface, planes);
    return rasterize(scene, objects, plan.view, settings.shading, planes, vertex_colors, &triangles);
  });
  gbuffer.camera = settings.camera;
  if (!gouraud && device) changeSurfaces(*device, plan.surface, gbuffer, stats);
  addCount(stats, "pixels_lit", coveredPixels(gbuffer));
  addRasterCounts(triangles, stats);
  addCount(stats, "objects_hidden_by_fog", scene.objects.size() - objects.size());
  return gbuffer;
}

/// shadeGBuffer() after the functions of surfaces.
static Image lightGBufferAsIs(OpenedDevice& device, const Scene& scene, const GBuffer& gbuffer,
                              const RenderSettings& settings, Stats& stats) {
  RenderSettings one_sample = settings;
  one_sample.surfaces.clear();
  one_sample.samples = 1;
  one_sample.camera = gbuffer.camera;
  one_sample.size = gbuffer.picture_size;
  validate(scene, one_sample);
  const TrafficMeter meter{device, stats};
  const TraceSpan span(
      "picture",
      {{"width", gbuffer.width}, {"height", gbuffer.height}, {"lights", std::int64_t(scene.lights.size())}});
  const PicturePlan plan = planShading(scene, gbuffer, one_sample);
  const std::size_t layers = plan.layers.size() + 1;
  requireMemory(double(gbuffer.width) * gbuffer.height * 3 * double(layers) * sizeof(float),
                fmt::format("{} layers of {}x{} pixels", layers, gbuffer.width, gbuffer.height));
  ReadyPicture picture{device, scene, one_sample, plan, stats};
  std::future<double> compiling =
      startCompiling(device, plan.programs, plan.shade, plan.pairs, plan.surface, plan.screens);
  prepareLights(picture, gbuffer.camera, nullptr);
  awaitKernels(compiling, device, settings, stats);
  describePicture(picture, {gbuffer.width, gbuffer.height});
  Image image = lightGivenPoints(picture, gbuffer);
  countLighting(picture);
  return image;
}

Image shadeGBuffer(OpenedDevice& device, const Scene& scene, const GBuffer& gbuffer,
                   const RenderSettings& settings, Stats& stats) {
  validateGBuffer(gbuffer);
  const SurfaceProgram program = surfaceProgram(settings.surfaces);
  if (settings.surfaces.empty()) return lightGBufferAsIs(device, scene, gbuffer, settings, stats);
  GBuffer changed = gbuffer;
  prepareForSurfaces(program, changed);
  changeSurfaces(device, program, changed, stats);
  return lightGBufferAsIs(device, scene, changed, settings, stats);
}

}  // namespace luciole
