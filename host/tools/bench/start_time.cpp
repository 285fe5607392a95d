#include "tools/bench/start_time.hpp"

#include <fmt/format.h>

#include "base/write_file.hpp"
#include "tools/bench/child_process.hpp"

namespace luciole {
namespace {

/// Lights of two kinds, highlights, a range and fog.
constexpr const char* kScene = R"({
  "camera": {"eye": [3, 2, 5], "target": [0, 0.5, 0]}, "size": [64, 64],
  "background": [0.2, 0.3, 0.4], "ambient": [0.1, 0.1, 0.1],
  "fog": {"mode": "exp2", "density": 0.05, "color": [0.2, 0.3, 0.4]},
  "materials": {"stone": {"diffuse": [0.6, 0.5, 0.4], "specular": 0.5, "shininess": 32}},
  "objects": [{"primitive": "plane", "scale": 10, "material": "stone"},
              {"primitive": "sphere", "translate": [0, 1, 0], "material": "stone"}],
  "lights": [{"type": "directional", "direction": [-1, -2, -1], "color": 0.5},
             {"type": "point", "position": [1, 2, 2], "range": 4, "color": [1, 0.5, 0.2]}]
})";

constexpr int kWarmRuns = 3;  ///< after each cold one

}  // namespace

SpeedTable measureStart(const SpeedInput& input) {
  const ScratchFolder folder;
  writeTextFile(folder / "scene.json", kScene);
  std::vector<std::string> arguments{"render",   folder / "scene.json", "-o",     folder / "picture.png",
                                     "--device", input.device_selector, "--quiet"};
  for (const std::string& option : sameThreads()) arguments.push_back(option);
  const int rounds = (input.repeats + kWarmRuns - 1) / kWarmRuns;
  std::vector<double> cold, warm;
  for (int round = 0; round < rounds; ++round) {
    if (input.on_progress) input.on_progress("start", std::size_t(round), std::size_t(rounds));
    const ScratchFolder cache;
    const auto run = [&] { return runChild(input.program, arguments, kernelCacheIn(cache)); };
    cold.push_back(run());
    for (int i = 0; i < kWarmRuns; ++i) warm.push_back(run());
  }
  return {.name = "start",
          .measured =
              "luciole render from its start to its end, a picture of 64 x 64 pixels; cold: with an empty "
              "cache of kernels; warm: with the one that a cold run left",
          .columns = {{"milliseconds", "ms", 0}, {"runs", "runs", 0}},
          .rows = {{"cold", {summarize(cold), double(cold.size())}},
                   {"warm", {summarize(warm), double(warm.size())}}}};
}

}  // namespace luciole
