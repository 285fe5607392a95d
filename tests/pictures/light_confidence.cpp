// The experiment of light_confidence_test.cpp with more lights and pixels than tests have the time for, as a
// table: build/tests/light_confidence --lights 100000 --pixels 2000 city
#include "pictures/light_confidence.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "lighting/stats.hpp"

namespace luciole::test {
namespace {

struct Experiment {
  std::vector<std::size_t> lights{10'000};
  std::size_t pixels = 2000;
  std::vector<int> size{320, 180};
  bool highlights = false;
  std::vector<std::string> scenes{std::begin(kCertifiedScenes), std::end(kCertifiedScenes)}, placements;
  std::vector<double> parts{16, 64, 256}, confidences{0.9, 0.95, 0.99, 0.999};
  double floor = 1;
  unsigned seeds = 1;
  std::string device, truth_device;
};

/// Adds what another seed gave.
void add(const HeldShare& more, HeldShare& share) {
  share.values += more.values;
  share.held += more.held;
  share.within += more.within;
}

void printRow(const std::string& scene, const std::string& placement, std::size_t lights, double parts,
              const ShadeSettings& shade, const Experiment& experiment, OpenedDevice& device,
              const ShadowedTruth& truth) {
  ConfidenceCheck sum;
  double milliseconds = 0, biases = 0, squares = 0;
  for (unsigned seed = 0; seed < experiment.seeds; ++seed) {
    ShadeSettings seeded = shade;
    seeded.seed = seed;
    const ConfidenceCheck check = checkConfidence(device, truth, seeded);
    add(check.all, sum.all);
    add(check.penumbra, sum.penumbra);
    add(check.near_light, sum.near_light);
    add(check.grazing, sum.grazing);
    biases += check.bias / experiment.seeds;
    squares += check.rmse * check.rmse / experiment.seeds;
    sum.width += check.width / experiment.seeds;
    sum.proven += check.proven / experiment.seeds;
    milliseconds += stageTime(check.stats, Stage::kSampledLight) / experiment.seeds;
    sum.stats = check.stats;
  }
  const auto percent = [](const HeldShare& share) {
    return share.values == 0 ? std::string("-") : fmt::format("{:.2f}", 100 * share.share());
  };
  fmt::print(
      "| {} | {} | {} | 1/{:.0f} | {} | {} | {:.2f} ± {:.2f} | {:.2f} | {} | {} | {} | {:.3f} | {:.4f} ± "
      "{:.4f} "
      "| {:.3f} | {:.1f} | {:.0f} | {} |\n",
      scene, placement, lights, parts, 100 * shade.confidence, sum.all.values, 100 * sum.all.share(),
      100 * sum.all.margin(), 100 * double(sum.all.within) / double(sum.all.values), percent(sum.penumbra),
      percent(sum.near_light), percent(sum.grazing), std::sqrt(squares), biases,
      2 * std::sqrt(squares / double(sum.all.values)), sum.width, milliseconds / 1e3,
      double(countOf(sum.stats, "sampled_rays")) / double(countOf(sum.stats, "pixels_lit")),
      countOf(sum.stats, "pixels_beyond_light_error"));
  std::fflush(stdout);
}

void checkScene(OpenedDevice& device, OpenedDevice& truth_device, const Experiment& experiment,
                const std::string& name) {
  const std::string file =
      name.find('/') == name.npos ? LUCIOLE_SOURCE_DIR "/scenes/" + name + ".json" : name;
  Scene scene = loadScene(file);
  for (const auto& [placement, shape] : kCertifiedPlacements) {
    const auto& asked = experiment.placements;
    if (!asked.empty() && std::find(asked.begin(), asked.end(), placement) == asked.end()) continue;
    for (const std::size_t lights : experiment.lights) {
      lightWithoutRange(scene, shape, lights, experiment.highlights);
      for (Light& light : scene.lights) light.shadow = true;
      const ShadowedTruth truth =
          shadowedTruth(truth_device, scene, {experiment.size[0], experiment.size[1]}, experiment.pixels);
      for (const double parts : experiment.parts)
        for (const double confidence : experiment.confidences) {
          ShadeSettings shade;
          shade.light_error = float(1 / parts);
          shade.light_error_floor = float(experiment.floor);
          shade.confidence = confidence;
          printRow(name.substr(name.rfind('/') + 1), placement, lights, parts, shade, experiment, device,
                   truth);
        }
    }
  }
}

int run(int count, char** arguments) {
  Experiment experiment;
  CLI::App app("Holds the intervals of sampled light against every light by exact rays.");
  app.add_option("SCENE", experiment.scenes);
  app.add_option("--lights", experiment.lights)->delimiter(',')->allow_extra_args(false);
  app.add_option("--size", experiment.size, "WIDTHxHEIGHT")
      ->delimiter('x')
      ->expected(2)
      ->allow_extra_args(false);
  app.add_option("--pixels", experiment.pixels, "of each picture")->capture_default_str();
  app.add_option("--placement", experiment.placements, "box, clusters or surface (default: all)")
      ->allow_extra_args(false);
  app.add_option("--error", experiment.parts, "1/E")->delimiter(',')->allow_extra_args(false);
  app.add_option("--confidence", experiment.confidences)->delimiter(',')->allow_extra_args(false);
  app.add_option("--floor", experiment.floor, "least value of which E is a share")->capture_default_str();
  app.add_option("--seeds", experiment.seeds)->capture_default_str();
  app.add_flag("--highlights", experiment.highlights, "lights have a specular part");
  app.add_option("--device", experiment.device);
  app.add_option("--truth-device", experiment.truth_device, "traces every light's rays (default: the same)");
  CLI11_PARSE(app, count, arguments);
  OpenedDevice device, truth_device;
  openDevice(experiment.device, device);
  openDevice(experiment.truth_device.empty() ? experiment.device : experiment.truth_device, truth_device);
  fmt::print("| scene | placement | lights | E | C % | values | held % | within E % | penumbra % | near % ");
  fmt::print("| grazing % | RMSE/E | bias/E | width/E | s | rays a pixel | missed |\n");
  fmt::print("|---|---|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const std::string& scene : experiment.scenes) checkScene(device, truth_device, experiment, scene);
  return 0;
}

}  // namespace
}  // namespace luciole::test

int main(int count, char** arguments) { return luciole::test::run(count, arguments); }
