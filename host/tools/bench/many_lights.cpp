#include "tools/bench/many_lights.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kernels/shared.h"
#include "lighting/stats.hpp"
#include "render/render.hpp"
#include "tools/bench/speed_scenes.hpp"

namespace luciole {
namespace {

constexpr glm::ivec2 kManyLightsSize(1920, 1080);

struct ManyLightsRow {
  std::string name;
  Scene scene;
  const GBuffer* gbuffer = nullptr;
};

/// Bytes of light lists: their entries, and where each starts.
double listBytes(const GBuffer& gbuffer, double entries) {
  const std::size_t starts = gbuffer.pixels() / kTilePixels + 1;
  return entries * sizeof(ListEntry) + double(starts) * sizeof(cl_uint);
}

Stats shadeRow(OpenedDevice& device, const ManyLightsRow& row, bool count_lights) {
  RenderSettings settings;
  settings.count_lights = count_lights;
  Stats stats;
  shadeGBuffer(device, row.scene, *row.gbuffer, settings, stats);
  return stats;
}

}  // namespace

SpeedTable measureManyLights(const SpeedInput& input) {
  const glm::ivec2 size = input.size.value_or(kManyLightsSize);
  std::vector<ManyLightsRow> rows;
  rows.push_back({"sphere", makeLightSphere(std::min<std::uint64_t>(input.most_lights, 100'000))});
  for (std::uint64_t lights = 1; lights <= input.most_lights; lights *= 10)
    rows.push_back({"city", makeCity(lights)});
  const GBuffer sphere = gbufferOf(rows.front().scene, size), city = gbufferOf(rows.back().scene, size);
  for (ManyLightsRow& row : rows) row.gbuffer = row.name == "city" ? &city : &sphere;

  SpeedTable table{
      .name = "many lights",
      .measured = fmt::format(
          "point lights with ranges, {} x {} pixels; sphere: lights of range 0.3 on a sphere of radius 50 "
          "around the camera; city: lights that fill it evenly, whose ranges shrink as they become more",
          size.x, size.y),
      .columns = {{"lights", "lights", 0},
                  {"milliseconds", "ms", 1},
                  {"prepare_lights_milliseconds", "prepare lights, ms", 1},
                  {"cull_milliseconds", "cull, ms", 1},
                  {"shade_milliseconds", "shade, ms", 1},
                  {"list_entries", "list entries", 0},
                  {"list_bytes", "list bytes", 0},
                  {"million_pairs_evaluated", "million pairs", 2},
                  {"million_pairs_in_range", "in range", 2},
                  {"lights_in_range_per_pixel", "in range per pixel", 2}}};
  for (const ManyLightsRow& row : rows) {
    if (input.on_progress) input.on_progress(table.name + ": counts", table.rows.size(), rows.size());
    const Stats stats = shadeRow(input.device, row, true);  // compiles, too
    const double entries = double(countOf(stats, "list_entries")),
                 in_range = double(countOf(stats, "pixel_lights_in_range"));
    table.rows.push_back(
        {row.name,
         {double(row.scene.lights.size()),
          {},
          {},
          {},
          {},
          entries,
          stageTime(stats, Stage::kCull) > 0 ? listBytes(*row.gbuffer, entries) : 0.0,
          1e-6 * double(countOf(stats, "pixel_lights_evaluated")),
          1e-6 * in_range,
          quotient(in_range, double(countOf(stats, "pixels_lit")), "no pixel shows a surface")}});
  }
  const auto rounds =
      runInRounds(rows.size(), input.repeats, table.name, input.on_progress, [&](std::size_t row) {
        const Stats stats = shadeRow(input.device, rows[row], false);
        const double prepare = stageTime(stats, Stage::kPrepareLights), cull = stageTime(stats, Stage::kCull),
                     shade = stageTime(stats, Stage::kShade);
        return std::vector{prepare + cull + shade, prepare, cull, shade};
      });
  for (std::size_t row = 0; row < rounds.size(); ++row)
    for (std::size_t i = 0; i < 4; ++i) table.rows[row].cells[1 + i] = rounds[row].summary(i);
  return table;
}

}  // namespace luciole
