#include "tools/bench/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "reference/reference.hpp"
#include "tools/figures/truth.hpp"

namespace luciole {
namespace {

/// The chosen device, opened for each lane width that a variant asks for.
using Devices = std::map<int, OpenedDevice>;

Devices openDevices(const std::string& selector, const std::vector<VariantGroup>& groups) {
  Devices devices;
  const std::string name = selector.substr(0, selector.find(",lanes="));
  for (const VariantGroup& group : groups)
    for (const Variant& variant : group.variants)
      if (const auto [place, is_new] = devices.try_emplace(variant.lanes); is_new)
        openDevice(fmt::format("{},lanes={}", name, variant.lanes), place->second);
  return devices;
}

/// Milliseconds of the stages that count for the group.
double countedTime(const Stats& stats, const VariantGroup& group) {
  double sum = 0;
  for (const auto& [stage, milliseconds] : stats.stages) {
    const bool counts = group.stages.empty() ? stage != Stage::kCompileKernels
                                             : std::find(group.stages.begin(), group.stages.end(), stage) !=
                                                   group.stages.end();
    if (counts) sum += milliseconds;
  }
  return sum;
}

/// What the runs of a group share.
struct Bench {
  const Scene& scene;
  const BenchSettings& settings;
  Devices& devices;
  const GBuffer& gbuffer;
};

/// Makes a variant's picture.
Image runVariant(const Bench& bench, const VariantGroup& group, const Variant& variant, Stats& stats) {
  RenderSettings picture = bench.settings.picture;
  picture.shade = variant.shade;
  picture.samples = variant.samples;
  picture.sample_shading = SampleShading::kAll;
  OpenedDevice& device = bench.devices.at(variant.lanes);
  return group.samples ? renderScene(device, bench.scene, picture, stats)
                       : shadeGBuffer(device, bench.scene, bench.gbuffer, picture, stats);
}

void report(const BenchSettings& settings, const std::string& what, std::size_t done, std::size_t total) {
  if (settings.on_progress) settings.on_progress(what, done, total);
}

/// The scene with all its lights without a size: points, or parallel light.
Scene withoutLightSizes(Scene scene) {
  for (Light& light : scene.lights) light.radius = light.half_angle = 0;
  return scene;
}

Truth makeTruth(const Bench& bench, const VariantGroup& group, Model model) {
  ReferenceSettings settings{.model = model};
  // Finer than any row's samples of a light.
  if (group.shadows == TruthShadows::kSoft) settings.shadow_samples = 4 * kSoftSamples.back();
  const Scene sharp = group.shadows == TruthShadows::kSharp ? withoutLightSizes(bench.scene) : Scene();
  const Scene& scene = group.shadows == TruthShadows::kSharp ? sharp : bench.scene;
  std::optional<RayScene> rays;
  if (group.shadows != TruthShadows::kNone)
    settings.shadow_rays =
        &rays.emplace(buildShadowRays(scene, glm::dvec3(bench.gbuffer.camera.camera_to_world[3])));
  settings.on_progress = [&](std::size_t done, std::size_t total) {
    report(bench.settings, group.name + ": the truth", done, total);
  };
  const RenderSettings& picture = bench.settings.picture;
  if (group.samples) return sampledTruth(scene, cameraView(picture.camera, picture.size), settings);
  return {referenceShade(scene, bench.gbuffer, settings)};
}

BenchGroup measureGroup(const Bench& bench, const VariantGroup& group) {
  std::map<Model, Truth> truths;
  for (const Variant& variant : group.variants)
    if (!truths.contains(variant.shade.model))
      truths[variant.shade.model] = makeTruth(bench, group, variant.shade.model);
  BenchGroup result{.group = group, .truth_error = truths.begin()->second.own_error};
  const std::size_t count = group.variants.size();
  // The first run compiles the kernels. Its picture is the one that is compared: all runs give the same.
  for (const Variant& variant : group.variants) {
    report(bench.settings, group.name + ": errors", result.rows.size(), count);
    Stats ignored;
    const Image picture = runVariant(bench, group, variant, ignored);
    const Image& truth = truths.at(variant.shade.model).image;
    const float brightest = *std::max_element(truth.pixels.begin(), truth.pixels.end());
    result.rows.push_back(
        {.variant = variant, .error = compareImages(truth, picture), .brightest = brightest});
  }
  const auto rounds = runInRounds(count, bench.settings.repeats, group.name + ": times",
                                  bench.settings.on_progress, [&](std::size_t row) {
                                    Stats stats;
                                    runVariant(bench, group, group.variants[row], stats);
                                    return std::vector{countedTime(stats, group)};
                                  });
  std::vector<SpeedAndError> figures;
  for (std::size_t i = 0; i < count; ++i) {
    result.rows[i].time = rounds[i].summary(0);
    figures.push_back({result.rows[i].time, result.rows[i].error.mean_abs});
  }
  const std::vector<bool> front = paretoFront(figures);
  for (std::size_t i = 0; i < count; ++i) result.rows[i].front = haveOneTruth(group) && front[i];
  return result;
}

}  // namespace

std::vector<BenchGroup> measureVariants(const Scene& scene, const std::vector<VariantGroup>& groups,
                                        const BenchSettings& settings) {
  Devices devices = openDevices(settings.device, groups);
  Stats ignored;
  const GBuffer gbuffer = rasterizeScene(nullptr, scene, settings.picture, ignored);
  const Bench bench{scene, settings, devices, gbuffer};
  std::vector<BenchGroup> measured;
  for (const VariantGroup& group : groups) measured.push_back(measureGroup(bench, group));
  return measured;
}

}  // namespace luciole
