#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "luciole/load_scene.hpp"
#include "raster/visible_points.hpp"
#include "reference/reference.hpp"
#include "render/render.hpp"
#include "scene/lights/light_field.hpp"
#include "scene/lights/light_range.hpp"

// What --light-error promises, held against sums of all lights in double precision at pixels of the shipped
// scenes.
namespace luciole::test {

inline constexpr const char* kCertifiedScenes[] = {"fireflies", "underwater", "colonnade",
                                                   "city",      "spheres",    "cornell"};
inline constexpr std::pair<const char*, FieldShape> kCertifiedPlacements[] = {
    {"box", FieldShape::kBox}, {"clusters", FieldShape::kClusters}, {"surface", FieldShape::kSurface}};
inline constexpr float kCertifiedErrors[] = {1.0f / 16, 1.0f / 64, 1.0f / 256, 1.0f / 1024};

/// Replaces a scene's lights by such as `generate lights SCENE --no-range` puts around what is seen of it.
/// highlights: whether they have a specular part.
inline void lightWithoutRange(Scene& scene, FieldShape placement, std::size_t count, bool highlights) {
  const Camera& camera = scene.cameras.front();
  const std::vector<glm::dvec3> seen = visiblePoints(scene, camera, {320, 180}, kMeasuredPlaces, 0);
  LightField field = fieldInBox(placement, seenBox(seen, glm::dvec3(camera.camera_to_world[3])));
  field.count = count;
  scene.lights.clear();
  expandLightField(field, scene);
  const float range = rangeForDensity(scene.lights, seen, kUsualDensity);
  for (Light& light : scene.lights) light.range = range;
  removeRanges(scene.lights, seen);
  if (!highlights)
    for (Light& light : scene.lights) light.specular = glm::vec3(0.0f);
}

/// A scene with the light that truly leaves its pixels for the eye, fog included, before exposure.
struct TrueLight {
  Scene scene;
  Model model = Model::kPhong;
  GBuffer gbuffer;
  std::vector<glm::ivec2> pixels;
  std::vector<glm::dvec3> radiance;  ///< of each of `pixels`
};

/// Covered pixels of the scene's picture, spread evenly: all of them, or `most`.
inline TrueLight trueLight(const Scene& scene, glm::ivec2 size, std::size_t most,
                           Model model = Model::kPhong) {
  TrueLight truth;
  truth.scene = scene;
  truth.model = model;
  RenderSettings settings;
  settings.size = size;
  settings.camera = scene.cameras.front();
  Stats stats;
  truth.gbuffer = rasterizeScene(nullptr, scene, settings, stats);
  const float* depth = truth.gbuffer.position.data() + 2 * truth.gbuffer.pixels();
  std::vector<glm::ivec2> covered;
  for (const glm::ivec2& pixel : allPixels(size))
    if (std::isfinite(depth[truth.gbuffer.index(pixel.x, pixel.y)])) covered.push_back(pixel);
  const std::size_t count = std::min(most, covered.size());
  for (std::size_t i = 0; i < count; ++i) truth.pixels.push_back(covered[i * covered.size() / count]);
  truth.radiance = referencePixels(scene, truth.gbuffer, truth.pixels, {.model = model});
  return truth;
}

/// How a picture kept what --light-error promised of it.
struct CertificateCheck {
  std::size_t values = 0;  ///< channels of pixels that were compared
  std::size_t broken = 0;  ///< of these farther from the truth than their bound says
  std::size_t unmet = 0;   ///< whose bound is above E·max(1, picture)
  /// Shares that true errors have of their bounds: the largest, where it is, and the mean.
  double worst = 0, mean = 0;
  glm::ivec2 worst_pixel{0};
  /// The largest true error, and the largest and the mean bound, as shares of E·max(1, picture).
  double largest_error = 0, largest_bound = 0, mean_bound = 0;
  Stats stats;
};

/// Lights the pixels by clusters within `light_error`, and compares.
inline CertificateCheck checkCertificate(OpenedDevice& device, const TrueLight& truth, float light_error) {
  RenderSettings settings;
  settings.shade.light_error = light_error;
  settings.shade.always_clusters = true;
  settings.shade.model = truth.model;
  settings.aovs = {Aov::kLightError};
  CertificateCheck check;
  const Image image = shadeGBuffer(device, truth.scene, truth.gbuffer, settings, check.stats);
  for (std::size_t i = 0; i < truth.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      // Channels R G B light_error.R light_error.G light_error.B.
      const glm::ivec2 pixel = truth.pixels[i];
      const float* value = &image.pixels[6 * (std::size_t(pixel.y) * image.width + pixel.x) + c];
      const double color = value[0], bound = value[3], error = std::abs(color - truth.radiance[i][c]);
      const double allowed = double(light_error) * std::max(1.0, color);
      ++check.values;
      check.broken += !(error <= bound);
      check.unmet += !(bound <= allowed);
      const double share = bound > 0 ? error / bound : error > 0 ? 1e30 : 0;
      if (share > check.worst) check.worst_pixel = pixel;
      check.worst = std::max(check.worst, share);
      check.mean += share;
      check.largest_error = std::max(check.largest_error, error / allowed);
      check.mean_bound += bound / allowed;
      check.largest_bound = std::max(check.largest_bound, bound / allowed);
    }
  if (check.values > 0) {
    check.mean /= double(check.values);
    check.mean_bound /= double(check.values);
  }
  return check;
}

}  // namespace luciole::test
