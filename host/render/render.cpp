#include "render/render.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "raster/view.hpp"
#include "render/assemble.hpp"
#include "render/fog_cull.hpp"
#include "render/lighting.hpp"

namespace luciole {
namespace {

ShadeSettings shadeSettings(const RenderSettings& settings) {
  ShadeSettings shade = settings.shade;
  shade.shadow_layer = wants(settings, Aov::kShadow);
  return shade;
}

constexpr Feature kFogFeatures[] = {Feature::kFogLinear, Feature::kFogExp, Feature::kFogExp2,
                                    Feature::kFogPerChannel, Feature::kFogRadial};

/// Features of the pass that lights vertices (Gouraud's way): no fog, which is for pixels.
FeatureSet vertexFeatures(FeatureSet features) {
  for (const Feature fog : kFogFeatures) features.set(fog, false);
  features.set(Feature::kOutputShadow, false);
  return features;
}

/// Features of the pass that fogs colours which are lit already, and stand in the emission planes.
FeatureSet fogOnly(const FeatureSet& features) {
  FeatureSet kept;
  kept.set(Feature::kEmission);
  for (const Feature fog : kFogFeatures) kept.set(fog, features.has(fog));
  return kept;
}

/// The scene's vertices, lit.
std::vector<glm::vec3> lightVertices(Device& device, const Scene& scene,
                                     const std::vector<std::uint32_t>& objects, const View& view,
                                     const Lighting& lighting, Stats& stats) {
  const FeatureSet features = vertexFeatures(lighting.features);
  const GBuffer vertices = timed(
      stats, "gather vertices", [&] { return gatherVertices(scene, objects, view, neededPlanes(features)); });
  const LitPlanes lit = lightGBuffer(device, lighting, features, vertices, false, stats);
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

void countPass(const GBuffer& gbuffer, const LitPlanes& lit, Stats& stats) {
  addCount(stats, "pixels_lit", coveredPixels(gbuffer));
  addCount(stats, "pixel_lights_evaluated", lit.evaluated);
  addCount(stats, "list_entries", lit.list_entries);
  if (lit.light_count.empty()) return;
  double in_range = 0;
  for (const float count : lit.light_count) in_range += count;
  addCount(stats, "pixel_lights_in_range", static_cast<std::uint64_t>(in_range));
}

}  // namespace

void describeScene(const Scene& scene, const FeatureSet& features, Stats& stats) {
  stats.triangles = 0;
  for (const Object& object : scene.objects) stats.triangles += scene.meshes[object.mesh].triangles.size();
  stats.lights = scene.lights.size();
  stats.features.clear();
  for (std::size_t i = 0; i < kFeatureCount; ++i)
    if (features.has(static_cast<Feature>(i))) stats.features.push_back(kFeatureTable[i].name);
}

Image renderScene(Device& device, const Scene& scene, const RenderSettings& settings, Stats& stats) {
  View view = cameraView(settings.camera, settings.size, settings.crop);
  const ShadeSettings shade = shadeSettings(settings);
  const FeatureSet features = neededFeatures(scene, settings.camera, materialTraits(scene), shade);
  const bool gouraud = settings.shading == Shading::kGouraud;
  const FeatureSet pixel_features = gouraud ? fogOnly(features) : features;
  compileKernels(device, pixel_features, shade, stats);
  if (gouraud) compileKernels(device, vertexFeatures(features), shade, stats);
  const std::vector<std::uint32_t> objects = objectsInSight(scene, view, settings.exposure);
  Lighting lighting;
  prepareLighting(device, scene, settings.camera, view, features, shade, lighting, stats);
  std::vector<glm::vec3> vertex_colors;
  if (gouraud) vertex_colors = lightVertices(device, scene, objects, view, lighting, stats);

  describeScene(scene, features, stats);
  stats.width = view.crop_size.x;
  stats.height = view.crop_size.y;
  stats.samples = settings.samples;
  PlaneSet planes = neededPlanes(pixel_features);
  if (!scene.lighting) planes.ambient = false;  // diffuse takes its place
  if (wants(settings, Aov::kMaterial)) planes = {true, true, true};

  GBuffer first_gbuffer;
  LitPlanes first;
  Plane sum;
  for (int sample = 0; sample < settings.samples; ++sample) {
    view.sample = samplePoint(sample, settings.samples);
    RasterCounts raster_counts;
    GBuffer gbuffer = timed(stats, "rasterize", [&] {
      return rasterize(scene, objects, view, settings.shading, planes, vertex_colors, &raster_counts);
    });
    gbuffer.camera = settings.camera;
    const bool count = settings.count_lights || (sample == 0 && wants(settings, Aov::kLightCount));
    LitPlanes lit = lightGBuffer(device, lighting, pixel_features, gbuffer, count, stats);
    countPass(gbuffer, lit, stats);
    addCount(stats, "triangles_submitted", raster_counts.submitted);
    addCount(stats, "triangles_back_facing", raster_counts.back_facing);
    addCount(stats, "triangles_outside", raster_counts.outside);
    timed(stats, "resolve", [&] {
      if (sample == 0) {
        sum = lit.color;
        first_gbuffer = std::move(gbuffer);
        first = std::move(lit);
      } else {
        tbb::parallel_for(std::size_t(0), 3 * first_gbuffer.pixels(),
                          [&](std::size_t i) { sum[i] += lit.color[i]; });
      }
    });
    if (settings.on_sample) settings.on_sample(sample + 1, settings.samples);
  }
  addCount(stats, "objects_hidden_by_fog", scene.objects.size() - objects.size());
  return timed(stats, "resolve", [&] { return assemblePicture(first_gbuffer, first, sum, settings); });
}

GBuffer rasterizeScene(Device* device, const Scene& scene, const RenderSettings& settings, Stats& stats) {
  const View view = cameraView(settings.camera, settings.size, settings.crop);
  const std::vector<std::uint32_t> objects = objectsInSight(scene, view, settings.exposure);
  const FeatureSet features = neededFeatures(scene, settings.camera, materialTraits(scene), settings.shade);
  describeScene(scene, features, stats);
  stats.width = view.crop_size.x;
  stats.height = view.crop_size.y;
  std::vector<glm::vec3> vertex_colors;
  if (settings.shading == Shading::kGouraud) {
    Lighting lighting;
    prepareLighting(*device, scene, settings.camera, view, features, settings.shade, lighting, stats);
    vertex_colors = lightVertices(*device, scene, objects, view, lighting, stats);
  }
  RasterCounts counts;
  GBuffer gbuffer = timed(stats, "rasterize", [&] {
    return rasterize(scene, objects, view, settings.shading, {true, true, true}, vertex_colors, &counts);
  });
  gbuffer.camera = settings.camera;
  addCount(stats, "pixels_lit", coveredPixels(gbuffer));
  addCount(stats, "triangles_submitted", counts.submitted);
  addCount(stats, "triangles_back_facing", counts.back_facing);
  addCount(stats, "triangles_outside", counts.outside);
  addCount(stats, "objects_hidden_by_fog", scene.objects.size() - objects.size());
  return gbuffer;
}

Image shadeGBuffer(Device& device, const Scene& scene, const GBuffer& gbuffer, const RenderSettings& settings,
                   Stats& stats) {
  const ShadeSettings shade = shadeSettings(settings);
  const SurfaceTraits surfaces{!gbuffer.specular.empty(), !gbuffer.emission.empty()};
  const FeatureSet features = neededFeatures(scene, gbuffer.camera, surfaces, shade);
  compileKernels(device, features, shade, stats);
  Lighting lighting;
  const View view = cameraView(gbuffer.camera, gbuffer.picture_size);
  prepareLighting(device, scene, gbuffer.camera, view, features, shade, lighting, stats);
  describeScene(scene, features, stats);
  stats.width = gbuffer.width;
  stats.height = gbuffer.height;
  const bool count = settings.count_lights || wants(settings, Aov::kLightCount);
  const LitPlanes lit = lightGBuffer(device, lighting, features, gbuffer, count, stats);
  countPass(gbuffer, lit, stats);
  RenderSettings one_sample = settings;
  one_sample.samples = 1;
  return timed(stats, "resolve", [&] { return assemblePicture(gbuffer, lit, lit.color, one_sample); });
}

}  // namespace luciole
