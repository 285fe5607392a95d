#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "lights/light_tree.hpp"
#include "pictures/light_certificate.hpp"
#include "raster/opacity.hpp"
#include "render/plan.hpp"
#include "shade/points.hpp"
#include "shadow/exact/light_rays.hpp"

// What --light-error promises of lights that cast shadows, held against every light by exact rays and in
// double precision.
namespace luciole::test {

/// Kinds of pixels in which sampling errs most.
struct PixelKind {
  bool penumbra = false;    ///< between a tenth and nine tenths of the light arrive
  bool near_light = false;  ///< one light gives more than a tenth of what it gets
  bool grazing = false;     ///< it is seen at more than 78 degrees
};

/// A scene with the light that truly leaves some of its pixels for the eye, fog included, before exposure.
struct ShadowedTruth {
  Scene scene;
  Model model = Model::kPhong;
  GBuffer gbuffer;
  std::vector<glm::ivec2> pixels;
  std::vector<glm::dvec3> radiance;  ///< of each of `pixels`
  std::vector<PixelKind> kinds;
};

namespace truth {

/// The scene's triangles, lights and points on the device.
struct Rays {
  const Scene& scene;
  const GBuffer& gbuffer;
  BeamScene beams;
  FeatureSet features;
  RawArray<BeamLight> lights;
  Plane starts;

  Rays(OpenedDevice& device, const Scene& lit, const GBuffer& points) : scene(lit), gbuffer(points) {
    const auto tree = std::make_shared<const TriangleTree>(
        buildTriangleTree(scene, glm::dvec3(gbuffer.camera.camera_to_world[3])));
    const bool holes = std::any_of(scene.materials.begin(), scene.materials.end(),
                                   [](const Material& material) { return material.alpha_cutoff > 0; });
    features.set(Feature::kHoles, holes);
    features.set(Feature::kLift, !gbuffer.lift.empty());
    prepareBeams(device, gbuffer.camera, tree,
                 holes ? std::make_shared<const HoleMasks>(makeHoleMasks(scene, *tree)) : nullptr, 0, beams);
    for (const Light& light : scene.lights) lights.push_back(beamLight(light, true, beams));
    const Points on_device = pointsOnDevice(device, gbuffer, features, features, false);
    starts.resize(3 * gbuffer.pixels());
    const Buffer<float> buffer = borrowedForOutput(device, starts);
    rayStarts(device, featureDefines(features),
              {.plane_stride = gbuffer.pixels(),
               .position = on_device.buffers.position,
               .normal = on_device.buffers.normal,
               .lift = on_device.buffers.lift,
               .beams = beams},
              buffer);
    download(device, buffer, starts);
  }

  /// A bit for each ray that nothing blocks.
  std::vector<uint> trace(OpenedDevice& device, const RawArray<LightRay>& rays) {
    RawArray<uint> lit(wordsForRays(rays.size())), unsure(lit.size(), 0);
    const Buffer<uint> lit_buffer = borrowedForOutput(device, lit),
                       unsure_buffer = borrowedForOutput(device, unsure);
    traceLightRays(device, featureDefines(features),
                   {borrowed(device, rays), rays.size(), borrowed(device, starts), gbuffer.pixels(),
                    borrowed(device, lights), beams},
                   lit_buffer, unsure_buffer);
    download(device, lit_buffer, lit);
    if (features.has(Feature::kHoles)) {
      download(device, unsure_buffer, unsure);
      const std::vector<PlacedObject> objects = placeObjects(scene, allObjects(scene), glm::dmat4(1));
      settleRays(
          beams, rays, starts, lights,
          [&](std::uint32_t triangle, const glm::dvec3& weights) {
            const PlacedObject& object = objectOfTriangle(objects, triangle);
            return isHoleAt(scene, object, triangle - object.first_triangle, weights);
          },
          unsure, lit);
    }
    return {lit.begin(), lit.end()};
  }
};

/// A pixel whose rays are to be traced.
struct AskedPixel {
  PixelTerms terms;  ///< but for lights
  std::vector<LightRay> rays;
  std::vector<glm::dvec3> light;  ///< what each gives if nothing is in its way
  glm::dvec3 sure{0.0};           ///< of lights that no ray asks for
  std::size_t first_ray = 0;
};

inline void askPixel(const Rays& rays, const glm::ivec2& pixel, const ReferenceSettings& settings,
                     AskedPixel& asked) {
  asked.rays.clear();
  asked.light.clear();
  asked.sure = glm::dvec3(0.0);
  const uint point = uint(rays.gbuffer.index(pixel.x, pixel.y));
  asked.terms = *referenceTerms(rays.scene, rays.gbuffer, pixel, settings, [&](const LightTerm& term) {
    if (term.visibility > 0 && rays.scene.lights[term.light].shadow) {
      asked.rays.push_back({point, uint(term.light)});
      asked.light.push_back(term.sum());
    } else {
      asked.sure += term.sum();
    }
  });
}

/// Sets what reaches the eye, and what kind of pixel that is.
inline void sumPixel(const Rays& rays, const std::vector<uint>& lit, const AskedPixel& asked,
                     glm::dvec3& radiance, PixelKind& kind) {
  const auto sum = [](const glm::dvec3& v) { return v.x + v.y + v.z; };
  glm::dvec3 light = asked.sure;
  double all = sum(light), largest = 0;
  for (std::size_t i = 0; i < asked.rays.size(); ++i) {
    const std::size_t ray = asked.first_ray + i;
    all += sum(asked.light[i]);
    if ((lit[ray / 32] >> ray % 32 & 1) == 0) continue;
    light += asked.light[i];
    largest = std::max(largest, sum(asked.light[i]));
  }
  const double reached = sum(light);
  const PixelTerms& terms = asked.terms;
  const Camera& camera = rays.gbuffer.camera;
  radiance =
      referenceFog(rays.scene.fog, camera, terms.point.position, terms.own + terms.point.emission + light);
  const glm::dvec3 to_eye = glm::normalize(glm::dvec3(camera.camera_to_world[3]) - terms.point.position);
  kind.penumbra = reached > 0.1 * all && reached < 0.9 * all;
  kind.near_light = largest > 0.1 * reached;
  kind.grazing = std::abs(glm::dot(terms.point.normal, to_eye)) < 0.2;
}

}  // namespace truth

/// Covered pixels of the scene's picture, spread evenly: all of them, or `most`. All lights count as casting
/// exact shadows if they cast any.
inline ShadowedTruth shadowedTruth(OpenedDevice& device, const Scene& scene, glm::ivec2 size,
                                   std::size_t most, Model model = Model::kPhong) {
  ShadowedTruth result;
  result.scene = scene;
  result.model = model;
  // Rays to neighbours follow each other.
  const std::vector<std::uint32_t> order = spatialOrder(scene.lights);
  for (std::size_t i = 0; i < order.size(); ++i) result.scene.lights[i] = scene.lights[order[i]];
  RenderSettings settings;
  settings.size = size;
  settings.camera = scene.cameras.front();
  Stats stats;
  result.gbuffer = rasterizeScene(nullptr, result.scene, settings, stats);
  const GBuffer& gbuffer = result.gbuffer;
  std::vector<glm::ivec2> covered;
  for (const glm::ivec2& pixel : allPixels(size))
    if (std::isfinite(gbuffer.position[gbuffer.index(pixel.x, pixel.y) + 2 * gbuffer.pixels()]))
      covered.push_back(pixel);
  const std::size_t count = std::min(most, covered.size());
  for (std::size_t i = 0; i < count; ++i)
    result.pixels.push_back(covered[(2 * i + 1) * covered.size() / (2 * count)]);
  result.radiance.resize(count);
  result.kinds.resize(count);
  truth::Rays rays(device, result.scene, gbuffer);
  // The rays of some pixels fit into memory.
  const std::size_t batch = std::clamp<std::size_t>(32'000'000 / (scene.lights.size() + 1), 1, 256);
  std::vector<truth::AskedPixel> pixels(std::min(batch, count));
  RawArray<LightRay> asked;
  for (std::size_t first = 0; first < count; first += batch) {
    const std::size_t some = std::min(batch, count - first);
    tbb::parallel_for(std::size_t(0), some, [&](std::size_t i) {
      askPixel(rays, result.pixels[first + i], {.model = model}, pixels[i]);
    });
    asked.clear();
    for (std::size_t i = 0; i < some; ++i) {
      pixels[i].first_ray = asked.size();
      asked.insert(asked.end(), pixels[i].rays.begin(), pixels[i].rays.end());
    }
    const std::vector<uint> lit = rays.trace(device, asked);
    tbb::parallel_for(std::size_t(0), some, [&](std::size_t i) {
      sumPixel(rays, lit, pixels[i], result.radiance[first + i], result.kinds[first + i]);
    });
  }
  return result;
}

/// How often intervals held.
struct HeldShare {
  std::size_t values = 0, held = 0, within = 0;  ///< within: the error asked for, whatever is stated
  double share() const { return values > 0 ? double(held) / double(values) : 1; }
  /// Half of the width of its own 95 % interval, if values were independent.
  double margin() const {
    const double p = share();
    return values > 0 ? 1.96 * std::sqrt(p * (1 - p) / double(values)) : 1;
  }
};

/// How a picture kept what its intervals state.
struct ConfidenceCheck {
  HeldShare all, penumbra, near_light, grazing;
  double bias = 0;    ///< the mean of signed errors, as a share of those allowed
  double rmse = 0;    ///< the root of the mean square of these shares
  double width = 0;   ///< the mean of stated half widths as such shares
  double proven = 0;  ///< the mean share of half widths that is proven
  Stats stats;
};

/// The picture with its lights sampled within `shade.light_error`. Channels R G B light_error.R .G .B
/// light_proof.R .G .B.
inline Image sampledPicture(OpenedDevice& device, const ShadowedTruth& truth, const ShadeSettings& shade,
                            Stats& stats) {
  RenderSettings settings;
  settings.shade = shade;
  settings.shade.shadows = ShadowMethod::kExact;
  settings.shade.always_clusters = true;
  settings.shade.model = truth.model;
  settings.aovs = {Aov::kLightError, Aov::kLightProof};
  return shadeGBuffer(device, truth.scene, truth.gbuffer, settings, stats);
}

/// Samples the pixels' lights, and compares. Channels of a pixel err together, so each pixel counts once: by
/// the channel of the largest radiance.
inline ConfidenceCheck checkConfidence(OpenedDevice& device, const ShadowedTruth& truth,
                                       const ShadeSettings& shade) {
  ConfidenceCheck check;
  const Image image = sampledPicture(device, truth, shade, check.stats);
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    const glm::ivec2 pixel = truth.pixels[i];
    const float* value = &image.pixels[9 * (std::size_t(pixel.y) * image.width + pixel.x)];
    const glm::dvec3& true_light = truth.radiance[i];
    const int c = true_light.x >= true_light.y && true_light.x >= true_light.z ? 0
                  : true_light.y >= true_light.z                               ? 1
                                                                               : 2;
    const double error = double(value[c]) - true_light[c], bound = value[3 + c];
    const double allowed =
        double(shade.light_error) * std::max(double(shade.light_error_floor), true_light[c]);
    const auto count = [&](HeldShare& share) {
      ++share.values;
      share.held += std::abs(error) <= bound;
      share.within += std::abs(error) <= allowed;
    };
    count(check.all);
    if (truth.kinds[i].penumbra) count(check.penumbra);
    if (truth.kinds[i].near_light) count(check.near_light);
    if (truth.kinds[i].grazing) count(check.grazing);
    check.bias += error / allowed;
    check.rmse += error * error / (allowed * allowed);
    check.width += bound / allowed;
    check.proven += value[6 + c];
  }
  const double n = std::max<double>(double(truth.pixels.size()), 1);
  check.bias /= n;
  check.rmse = std::sqrt(check.rmse / n);
  check.width /= n;
  check.proven /= n;
  return check;
}

}  // namespace luciole::test
