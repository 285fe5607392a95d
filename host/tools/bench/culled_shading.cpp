#include "tools/bench/culled_shading.hpp"

#include <fmt/format.h>

#include "lighting/stats.hpp"
#include "render/render.hpp"
#include "tools/bench/speed_scenes.hpp"

namespace luciole {
namespace {

struct CullingRow {
  const char* name;
  Culling culling;
  int tile_size;
};
constexpr CullingRow kRows[] = {{"in one, no lists", Culling::kTiles, 4},
                                {"lists of 8 x 8 pixels", Culling::kTiles, 8},
                                {"lists of 16 x 16 pixels", Culling::kTiles, 16},
                                {"no culling", Culling::kNone, 16}};

}  // namespace

SpeedTable measureCulledShading(const SpeedInput& input) {
  const Scene scene = makeHall();
  const GBuffer gbuffer = gbufferOf(scene, input.size.value_or(glm::ivec2(1280, 720)));
  const auto shadeRow = [&](std::size_t row, bool count_lights) {
    RenderSettings settings;
    settings.shade.culling = kRows[row].culling;
    settings.shade.tile_size = kRows[row].tile_size;
    settings.count_lights = count_lights;
    Stats stats;
    shadeGBuffer(input.device, scene, gbuffer, settings, stats);
    return stats;
  };
  SpeedTable table{.name = "culling and shading",
                   .measured = fmt::format("{} point lights with ranges in a hall, {} x {} pixels",
                                           scene.lights.size(), gbuffer.width, gbuffer.height),
                   .columns = {{"milliseconds", "ms", 2},
                               {"cull_milliseconds", "cull, ms", 2},
                               {"shade_milliseconds", "shade, ms", 2},
                               {"list_entries", "list entries", 0},
                               {"million_pairs_evaluated", "million pairs", 2},
                               {"million_pairs_in_range", "in range", 2},
                               {"evaluated_per_pair_in_range", "pairs per pair in range", 2},
                               {"lights_in_range_per_pixel", "in range per pixel", 2}}};
  for (std::size_t i = 0; i < std::size(kRows); ++i) {
    const Stats stats = shadeRow(i, true);  // compiles, too
    const double evaluated = double(countOf(stats, "pixel_lights_evaluated")),
                 in_range = double(countOf(stats, "pixel_lights_in_range"));
    table.rows.push_back(
        {kRows[i].name,
         {{},
          {},
          {},
          double(countOf(stats, "list_entries")),
          1e-6 * evaluated,
          1e-6 * in_range,
          quotient(evaluated, in_range, "no light is in range of a pixel"),
          quotient(in_range, double(countOf(stats, "pixels_lit")), "no pixel shows a surface")}});
  }
  const auto rounds =
      runInRounds(std::size(kRows), input.repeats, table.name, input.on_progress, [&](std::size_t row) {
        const Stats stats = shadeRow(row, false);
        const double cull = stageTime(stats, Stage::kCull), shade = stageTime(stats, Stage::kShade);
        return std::vector{cull + shade, cull, shade};
      });
  for (std::size_t row = 0; row < rounds.size(); ++row)
    for (std::size_t i = 0; i < 3; ++i) table.rows[row].cells[i] = rounds[row].summary(i);
  return table;
}

}  // namespace luciole
