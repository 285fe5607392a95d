#include "reference/reference_picture.hpp"

#include <cmath>

#include "image/exposure.hpp"
#include "luciole/reference.hpp"
#include "luciole/validate_scene.hpp"
#include "rays/shadow_rays.hpp"
#include "scene/tangents.hpp"
#include "shaders/shader_text.hpp"

namespace luciole {
namespace {

/// Radiance of the scene's vertices, in the order of gatherVertices(), before fog: that is applied to pixels.
std::vector<glm::vec3> lightVertices(const Scene& scene, const std::vector<std::uint32_t>& objects,
                                     const View& view, const ReferenceSettings& settings) {
  ReferenceSettings clear = settings;
  clear.fog = false;
  PlaneSet planes = settings.surface_planes;
  planes.specular = planes.ambient = planes.emission = planes.model = true;
  GBuffer vertices = gatherVertices(scene, objects, view, planes);
  if (settings.change_surfaces) {
    vertices.camera = viewCamera(view);
    settings.change_surfaces(vertices);
  }
  const std::vector<glm::ivec2> places = allPixels({vertices.width, vertices.height});
  const std::vector<glm::dvec3> colors = referencePixels(scene, vertices, places, clear);
  std::vector<glm::vec3> of_vertex(vertices.pixels());
  for (std::size_t i = 0; i < places.size(); ++i)
    of_vertex[vertices.index(places[i].x, places[i].y)] = glm::vec3(colors[i]);
  return of_vertex;
}

}  // namespace

std::vector<glm::dvec3> referencePicture(const Scene& scene, const View& view, Shading shading, int samples,
                                         std::span<const glm::ivec2> pixels,
                                         const ReferenceSettings& settings) {
  validateScene(scene);
  const std::vector<std::uint32_t> objects = allObjects(scene);
  std::vector<glm::vec3> vertex_colors;
  if (shading == Shading::kGouraud) vertex_colors = lightVertices(scene, objects, view, settings);
  std::vector<glm::dvec3> sum(pixels.size());
  View sample_view = view;
  for (int sample = 0; sample < samples; ++sample) {
    takeSample(sample_view, {sample, samples});
    PlaneSet planes = settings.surface_planes;
    planes.specular = planes.ambient = planes.emission = planes.model = true;
    planes.unbent_normal |= shading == Shading::kPhong && hasNormalMaps(scene);
    planes.tangent |= usesTangents(scene.user_models);
    planes.lift = settings.shadow_rays != nullptr;
    GBuffer gbuffer = rasterize(scene, objects, sample_view, shading, planes, vertex_colors);
    if (settings.change_surfaces && shading != Shading::kGouraud) settings.change_surfaces(gbuffer);
    ReferenceSettings of_sample = settings;
    if (settings.on_progress)
      of_sample.on_progress = [&](std::size_t done, std::size_t count) {
        settings.on_progress(sample * count + done, samples * count);
      };
    const std::vector<glm::dvec3> colors = referencePixels(scene, gbuffer, pixels, of_sample);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += colors[i] / double(samples);
  }
  return sum;
}

double referenceExposure(const Scene& scene, const Camera& camera, glm::ivec2 size, Shading shading,
                         const ReferenceSettings& settings) {
  validateScene(scene);
  const View view = cameraView(camera, measuringSize(size));
  const std::vector<glm::ivec2> pixels = allPixels(view.crop_size);
  const GBuffer surfaces = rasterize(scene, allObjects(scene), view, Shading::kPhong, {});
  return referenceExposure(surfaces, pixels, referencePicture(scene, view, shading, 1, pixels, settings));
}

double referenceExposure(const GBuffer& gbuffer, std::span<const glm::ivec2> pixels,
                         std::span<const glm::dvec3> colors) {
  const float* depth = gbuffer.position.data() + 2 * gbuffer.pixels();
  std::vector<glm::vec3> covered;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!std::isfinite(depth[gbuffer.index(pixels[i].x, pixels[i].y)])) continue;
    covered.emplace_back(pictureValue(colors[i].r), pictureValue(colors[i].g), pictureValue(colors[i].b));
  }
  return suitableExposure(covered);
}

std::vector<double> referenceCoverage(const GBuffer& gbuffer, std::span<const glm::ivec2> pixels) {
  const float* z = gbuffer.position.data() + 2 * gbuffer.pixels();
  std::vector<double> coverage;
  coverage.reserve(pixels.size());
  for (const glm::ivec2& pixel : pixels)
    coverage.push_back(std::isfinite(z[gbuffer.index(pixel.x, pixel.y)]) ? 1 : 0);
  return coverage;
}

std::vector<double> referenceCoverage(const Scene& scene, const View& view, int samples,
                                      std::span<const glm::ivec2> pixels) {
  validateScene(scene);
  std::vector<double> covered(pixels.size());
  View sample_view = view;
  for (int sample = 0; sample < samples; ++sample) {
    takeSample(sample_view, {sample, samples});
    const GBuffer gbuffer = rasterize(scene, allObjects(scene), sample_view, Shading::kFlat, {});
    const std::vector<double> of_sample = referenceCoverage(gbuffer, pixels);
    for (std::size_t i = 0; i < covered.size(); ++i) covered[i] += of_sample[i];
  }
  for (double& share : covered) share /= samples;
  return covered;
}

std::vector<glm::dvec3> referencePicture(const Scene& scene, const RenderSettings& settings,
                                         std::span<const glm::ivec2> pixels) {
  validateScene(scene);
  const View view = cameraView(settings.camera, settings.size, settings.crop);
  ReferenceSettings reference{.model = settings.shade.model};
  if (settings.on_pass)
    reference.on_progress = [&](std::size_t done, std::size_t count) {
      settings.on_pass(int(done), int(count));
    };
  RayScene rays;
  if (settings.shade.shadows != ShadowMethod::kOff) {
    rays = buildShadowRays(scene, glm::dvec3(settings.camera.camera_to_world[3]));
    reference.shadow_rays = &rays;
  }
  return referencePicture(scene, view, settings.shading, settings.samples, pixels, reference);
}

}  // namespace luciole
