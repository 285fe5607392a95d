#include "tools/bench/anti_aliasing.hpp"

#include <fmt/format.h>

#include "lighting/stats.hpp"
#include "luciole/compare.hpp"
#include "render/render.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/bench_scene.hpp"

namespace luciole {
namespace {

constexpr glm::ivec2 kAntiAliasedSize(640, 360);
constexpr int kTruthSamples = 256;

struct AntiAliasedRow {
  std::string name;
  int samples;
  SampleShading shading;
  std::size_t whole;  ///< the row of as many samples, all shaded
};

Image makeAntiAliased(OpenedDevice& device, const Scene& scene, glm::ivec2 size, int samples,
                      SampleShading shading, Stats& stats) {
  RenderSettings settings;
  settings.size = size;
  settings.camera = scene.cameras.front();
  settings.samples = samples;
  settings.sample_shading = shading;
  settings.shade.shadows = ShadowMethod::kPcf;
  return renderScene(device, scene, settings, stats);
}

}  // namespace

SpeedTable measureAntiAliasing(const SpeedInput& input) {
  const Scene built_in = input.scene ? Scene{} : makeBenchScene();
  const Scene& scene = input.scene ? *input.scene : built_in;
  const glm::ivec2 size = input.size.value_or(kAntiAliasedSize);
  std::vector<AntiAliasedRow> rows{{"1 sample", 1, SampleShading::kAll, 0}};
  for (const int samples : {4, 16, 64}) {
    const std::size_t whole = rows.size();
    rows.push_back({fmt::format("{} samples, all", samples), samples, SampleShading::kAll, whole});
    rows.push_back({fmt::format("{} samples, shared", samples), samples, SampleShading::kShared, whole});
  }
  SpeedTable table{
      .name = "anti-aliasing",
      .measured = fmt::format("{}, whole pictures of {} x {} pixels, errors against {} samples that are all "
                              "shaded, in 8-bit steps of linear light",
                              scene.name, size.x, size.y, kTruthSamples),
      .columns = {{"milliseconds", "ms", 1},
                  {"times_all", "times all", 2},
                  {"times_one_sample", "times 1 sample", 2},
                  {"shadings_per_pixel", "shadings per pixel", 2},
                  {"rmse_steps", "RMSE, steps", 3},
                  {"max_steps", "max, steps", 1},
                  {"rmse_times_all", "RMSE times all", 2},
                  {"relmse", "relMSE", 6},
                  {"smape", "SMAPE", 5}}};
  if (input.on_progress) input.on_progress(table.name + ": the truth", 0, rows.size());
  Stats ignored;
  const Image truth = makeAntiAliased(input.device, scene, size, kTruthSamples, SampleShading::kAll, ignored);
  std::vector<double> errors;
  for (const AntiAliasedRow& row : rows) {
    if (input.on_progress) input.on_progress(table.name + ": errors", table.rows.size(), rows.size());
    Stats stats;  // the first picture compiles, too
    const ImageDifference error =
        compareImages(truth, makeAntiAliased(input.device, scene, size, row.samples, row.shading, stats));
    errors.push_back(error.rmse);
    table.rows.push_back({row.name,
                          {{},
                           {},
                           {},
                           double(countOf(stats, "pixels_lit")) / (double(size.x) * size.y),
                           error.rmse * k8BitSteps,
                           error.max_abs * k8BitSteps,
                           quotient(error.rmse, errors[row.whole], "all samples have no error"),
                           error.relmse,
                           error.smape}});
  }
  const auto rounds =
      runInRounds(rows.size(), input.repeats, table.name, input.on_progress, [&](std::size_t row) {
        Stats stats;
        return std::vector{millisecondsOf([&] {
          makeAntiAliased(input.device, scene, size, rows[row].samples, rows[row].shading, stats);
        })};
      });
  for (std::size_t row = 0; row < rounds.size(); ++row) {
    table.rows[row].cells[0] = rounds[row].summary(0);
    table.rows[row].cells[1] = ratio(rounds[row].figures[0], rounds[rows[row].whole].figures[0]);
    table.rows[row].cells[2] = ratio(rounds[row].figures[0], rounds[0].figures[0]);
  }
  return table;
}

}  // namespace luciole
