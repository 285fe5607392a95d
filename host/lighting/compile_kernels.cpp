#include "lighting/compile_kernels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/trace.hpp"
#include "cl/launch.hpp"
#include "kernels/shared.h"
#include "lighting/compile_helper.hpp"
#include "lighting/light_gbuffer.hpp"
#include "lighting/stages.hpp"

namespace luciole {
namespace {

/// Users who wait longer than this are told what for.
constexpr std::chrono::milliseconds kLongWait(300);

/// Pictures of more pairs of a point and a light take longer by programs that are compiled quickly than it
/// takes to optimize theirs, which is 1 to 2 s: this many take 0.1 s where they are optimized, else 0.6 s.
constexpr double kMostQuickPairs = 1e8;
/// Likewise by the general program, which runs 1.1 to 1.6 times as long as their own.
constexpr double kMostGeneralPairs = 1e9;

/// The pairs that take as long by 16 lanes as these do by the device's. Cornell in 4K takes quick
/// programs 1.2, 2.1 and 34 s by 8, 4 and 1 lanes, optimized ones 0.3, 0.3 and 1.7.
double pairsOf16Lanes(double pairs, const OpenedDevice& device) {
  return pairs * std::pow(16.0 / device.description.lanes, 1.5);
}

/// One tile of background, with all groups of planes: the kernels load a row's values before they know that
/// it is background.
GBuffer emptyTile() {
  GBuffer empty;
  empty.tiles_x = empty.tiles_y = 1;
  empty.position.assign(3 * kTilePixels, -std::numeric_limits<float>::infinity());
  for (Plane* group : {&empty.normal, &empty.diffuse, &empty.ambient, &empty.emission})
    group->assign(3 * kTilePixels, 0.0f);
  empty.specular.assign(4 * kTilePixels, 0.0f);
  return empty;
}

/// Whether PoCL has kept the optimized programs of beams and of shading.
bool isKept(const OpenedDevice& device, const FeatureSet& features, const ShadeSettings& settings) {
  return isCompiled(device, "shade/shade.cl", featureDefines(features) + mathDefines(settings),
                    userTextFor(features, settings.user_text)) &&
         (!features.has(Feature::kExact) ||
          isCompiled(device, "exact/beam_shadows.cl", featureDefines(featuresFor(kForBeams, features))));
}

/// Names what compileKernels() makes of its arguments.
std::string readyName(const OpenedDevice& device, const FeatureSet& features, const ShadeSettings& settings,
                      KernelChoice choice) {
  return fmt::format("{} {} {} {} {} {} {}\n{}", featureDefines(features), mathDefines(settings),
                     choice.beams, choice.others, choice.counts, device.compiles_quickly, settings.tile_size,
                     settings.user_text);
}

/// Starts the helper on those beams of the picture's programs that have to be compiled.
void startBeams(OpenedDevice& device, const CompileTask& picture, HelperProcess& helper) {
  if (device.helper.empty()) return;
  CompileTask beams{{}, picture.settings, {.others = false}, device.compiles_quickly};
  for (const FeatureSet& features : picture.programs)
    if (features.has(Feature::kExact) &&
        !device.ready.contains(readyName(device, features, picture.settings, {.others = false})) &&
        !isCompiled(device, "exact/beam_shadows.cl", featureDefines(featuresFor(kForBeams, features))))
      beams.programs.push_back(features);
  if (!beams.programs.empty()) helper.start(device, beams);
}

/// Prepares beams in a scene without triangles.
void prepareNoBeams(OpenedDevice& device, const FeatureSet& features, const ShadeSettings& settings,
                    BeamScene& beams) {
  prepareBeams(device, {}, std::make_shared<const TriangleTree>(buildTriangleTree({}, {})), nullptr,
               features.has(Feature::kSoftExact) ? settings.soft_samples : 0, beams);
}

/// Compiles the kernels for exact shadows: beams, and among the others rays for what they leave undecided.
void compileShadows(OpenedDevice& device, const LightPass& pass, const ShadeSettings& settings,
                    KernelChoice choice) {
  const FeatureSet& features = pass.features;
  const Scene nothing;
  Lighting lighting;
  prepareNoBeams(device, features, settings, lighting.beams);
  const Points points = pointsOnDevice(device, pass.gbuffer, features, features, false);
  LightLists empty_list;
  empty_list.tiles = 1;
  reserve(device, 2, empty_list.starts);
  fill(device, empty_list.starts, 0);
  const StageInput input{device, nothing, lighting, pass, features, points, empty_list};
  if (choice.beams) decideBeams(input);
  if (!choice.others || !(features.has(Feature::kHoles) || features.has(Feature::kSoftExact))) return;
  PairShadows pairs;
  pairs.counts = makeBuffer<TilePairs>(device, 1);
  fill(device, pairs.counts, {0, 0, 0, 0});
  traceUnsurePairs(input, pairs);
}

/// Calls the device's check of itself, with a kernel that is compiled as those of the picture are.
void checkItself(OpenedDevice& device) {
  if (!device.self_check) return;
  const bool compiles_quickly = std::exchange(device.compiles_quickly, hasQuickPrograms(device));
  std::exchange(device.self_check, nullptr)();
  device.compiles_quickly = compiles_quickly;
}

}  // namespace

void compileKernels(OpenedDevice& device, const FeatureSet& features, const ShadeSettings& settings,
                    KernelChoice choice) {
  std::string all_of_it = readyName(device, features, settings, choice);
  if (device.ready.contains(all_of_it)) return;
  const GBuffer empty = emptyTile();
  const Scene nothing;
  Lighting lighting;
  lighting.math_defines = mathDefines(settings);
  lighting.user_text = settings.user_text;
  lighting.group_log2 = groupLog2(settings.tile_size);
  // An empty map, so that find_needed.cl is launched, and compiled, too.
  if (features.shadowMaps()) {
    lighting.maps.host.maps.emplace_back();
    lighting.maps.host.faces.emplace_back();
    lighting.maps.host.bin_count = 1;
  }
  borrowMaps(device, lighting.maps);
  if (features.sampledLight()) prepareNoBeams(device, features, settings, lighting.beams);
  finishLightSet(device, lighting.lights);
  Stats ignored;
  LightPass pass{.lights = lighting.lights,
                 .features = features,
                 .gbuffer = empty,
                 .counts = {.in_range = choice.counts}};
  if (features.has(Feature::kExact))
    timed(ignored, Stage::kBeamShadows, [&] { compileShadows(device, pass, settings, choice); });
  if (choice.others) lightGBuffer(device, nothing, lighting, std::move(pass), ignored);
  listCompiled(device);
  device.ready.insert(std::move(all_of_it));
}

std::future<double> startCompiling(OpenedDevice& device, const std::vector<FeatureSet>& programs,
                                   const ShadeSettings& settings, double pairs,
                                   const SurfaceProgram& surfaces,
                                   const std::vector<ScreenProgram>& screens) {
  return std::async(std::launch::async, [&device, &programs, &settings, pairs, &surfaces, &screens] {
    awaitDevice(device);
    const TraceThread thread("kernel compiler");
    const std::int64_t begin = nanosecondsSinceStart();
    const auto is_ready = [&](const FeatureSet& features) {
      return device.ready.contains(readyName(device, features, settings, {.beams = false})) &&
             device.ready.contains(readyName(device, features, settings, {.others = false}));
    };
    // To ask what PoCL has kept takes as long as a small frame.
    const bool is_like_the_last = !device.lights_generally && surfaces.user_text.empty() && screens.empty();
    if (is_like_the_last && std::all_of(programs.begin(), programs.end(), is_ready))
      return endStage(Stage::kCompileKernels, begin);
    const double work = pairsOf16Lanes(pairs, device);
    const bool is_followed = !device.helper.empty() && device.makes_one_picture;
    const bool has_general = is_followed && isKept(device, generalFeatures(), settings);
    const bool awaits_own = has_general && work <= kMostGeneralPairs &&
                            std::all_of(programs.begin(), programs.end(), isGeneral) &&
                            !std::all_of(programs.begin(), programs.end(), [&](const FeatureSet& own) {
                              return isKept(device, own, settings);
                            });
    device.lights_generally = awaits_own || device.always_lights_generally;
    device.compiles_quickly = is_followed && work <= kMostQuickPairs;
    CompileTask picture{{}, settings, {.counts = true}};
    for (const FeatureSet& features : programs) picture.programs.push_back(programFor(device, features));
    HelperProcess helper;
    startBeams(device, picture, helper);
    for (const FeatureSet& features : picture.programs)
      compileKernels(device, features, settings, {.beams = false});
    if (GBuffer empty = emptyTile(); !surfaces.user_text.empty()) surface(device, surfaces, empty);
    for (const ScreenProgram& screen : screens) compileScreen(device, screen);
    checkItself(device);
    if (!helper.await() && device.warn)
      device.warn("a process that compiled kernels failed; they are compiled in this one");
    for (const FeatureSet& features : picture.programs)
      compileKernels(device, features, settings, {.others = false});
    CompileTask left{{}, settings, picture.choice};
    if (awaits_own)
      left.programs = programs;
    else if (hasQuickPrograms(device))
      left.programs = picture.programs;
    if (is_followed && !has_general) left.programs.push_back(generalFeatures());
    if (!left.programs.empty()) device.left_over = argumentsOf(device, left);
    return endStage(Stage::kCompileKernels, begin);
  });
}

void awaitKernels(std::future<double>& compiling, OpenedDevice& device, const RenderSettings& settings,
                  Stats& stats) {
  const double milliseconds = timed(stats, Stage::kWaitForKernels, [&] {
    if (settings.on_long_compile && compiling.wait_for(kLongWait) != std::future_status::ready)
      settings.on_long_compile();
    return compiling.get();
  });
  addStage(stats, Stage::kCompileKernels, milliseconds);
  addStage(stats, Stage::kOpenDevice, std::exchange(device.milliseconds_to_open, 0));
  stats.beside = {Stage::kCompileKernels, Stage::kOpenDevice};
  stats.device = device.description;
}

}  // namespace luciole
