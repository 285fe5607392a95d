#include "tools/bench/given_gbuffer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cl/buffer.hpp"
#include "lighting/stats.hpp"
#include "luciole/gbuffer.hpp"
#include "render/render.hpp"
#include "tools/bench/shading_rate.hpp"

namespace luciole {
namespace {

ShadeSettings shadeSettings(const GivenGBuffer& given) {
  return {.model = given.model, .shadows = ShadowMethod::kOff};
}

Stats shadeGiven(OpenedDevice& device, const GivenGBuffer& given, bool count_lights) {
  RenderSettings settings;
  settings.count_lights = count_lights;
  settings.shade = shadeSettings(given);
  Stats stats;
  shadeGBuffer(device, given.scene, given.gbuffer, settings, stats);
  return stats;
}

/// Bytes of the planes that are read and written, each once.
double planeBytes(const GivenGBuffer& given) {
  const GBuffer& gbuffer = given.gbuffer;
  const SurfaceTraits surfaces{!gbuffer.specular.empty(), !gbuffer.emission.empty(), false};
  const PlaneSet planes =
      neededPlanes(neededFeatures(given.scene, gbuffer.camera, surfaces, shadeSettings(given)));
  const int floats =
      3 + 3 + 3 + (planes.specular ? 4 : 0) + (planes.ambient ? 3 : 0) + (planes.emission ? 3 : 0) + 3;
  return double(gbuffer.pixels()) * floats * sizeof(float);
}

double copyMilliseconds(OpenedDevice& device, const Buffer<float>& from, const Buffer<float>& to) {
  finish(device);
  return millisecondsOf([&] {
    bytes::copy(device, from.memory, to.memory, from.count * sizeof(float));
    finish(device);
  });
}

}  // namespace

SpeedTable measureGivenGBuffer(const SpeedInput& input) {
  const GivenGBuffer& given = *input.given;
  const Stats counted = shadeGiven(input.device, given, true);  // compiles, too
  const auto pairs = double(countOf(counted, "pixel_lights_evaluated"));
  const double moved = planeBytes(given);
  const AllPairs roof = makeAllPairs(glm::ivec2(512), 64);
  const double roof_pairs = double(roof.gbuffer.pixels()) * double(roof.scene.lights.size());
  const Buffer<float> from = makeBuffer<float>(input.device, std::size_t(moved) / sizeof(float) / 2),
                      to = makeBuffer<float>(input.device, from.count);
  fill(input.device, from, 0.0f);
  copyMilliseconds(input.device, from, to);  // the system gives memory when it is first written
  roofMilliseconds(input.device, roof);      // compiles
  SpeedTable table{
      .name = "cull and shade",
      .measured = fmt::format("{} lights on a G-buffer of {} x {} pixels, {}; arithmetic: as many pairs with "
                              "nothing to load or to wait for; memory: a copy of as many bytes",
                              given.scene.lights.size(), given.gbuffer.width, given.gbuffer.height,
                              modelName(given.model)),
      .columns = {{"best_ms", "best, ms", 2},
                  {"median_ms", "median, ms", 2},
                  {"pairs_evaluated", "pairs", 0},
                  {"pairs_in_range", "in range", 0},
                  {"bytes", "bytes", 0},
                  {"million_pairs_per_second", "million pairs/s", 0},
                  {"gigabytes_per_second", "GB/s", 1}}};
  const auto rounds = runInRounds(3, input.repeats, table.name, input.on_progress, [&](std::size_t row) {
    if (row == 1) return std::vector{roofMilliseconds(input.device, roof) * pairs / roof_pairs};
    if (row == 2) return std::vector{copyMilliseconds(input.device, from, to)};
    const Stats stats = shadeGiven(input.device, given, false);
    return std::vector{stageTime(stats, Stage::kCull) + stageTime(stats, Stage::kShade)};
  });
  const NoValue no_pairs{"a copy has no pairs"}, no_bytes{"the roof loads nothing"};
  const char* too_short = "a time is too short to be measured";
  const char* names[] = {"cull and shade", "arithmetic", "memory"};
  for (std::size_t row = 0; row < rounds.size(); ++row) {
    const std::vector<double>& times = rounds[row].figures[0];
    const double best = *std::min_element(times.begin(), times.end());
    const bool has_pairs = row != 2, has_bytes = row != 1;
    table.rows.push_back({names[row],
                          {best, rounds[row].summary(0).median, has_pairs ? SpeedCell(pairs) : no_pairs,
                           row == 0 ? SpeedCell(double(countOf(counted, "pixel_lights_in_range")))
                                    : NoValue{"only shading has a range"},
                           has_bytes ? SpeedCell(moved) : no_bytes,
                           has_pairs ? quotient(1e-3 * pairs, best, too_short) : no_pairs,
                           has_bytes ? quotient(1e-6 * moved, best, too_short) : no_bytes}});
  }
  return table;
}

}  // namespace luciole
