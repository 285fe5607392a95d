// The experiment of light_certificate_test.cpp with more lights and pixels than tests have the time for, as a
// table: build/tests/light_certificate --size 320x180 city
#include "pictures/light_certificate.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

namespace luciole::test {
namespace {

struct Experiment {
  std::size_t lights = 10'000, pixels = std::size_t(-1);
  std::vector<int> size{320, 180};
  bool highlights = false;
  std::vector<std::string> scenes{std::begin(kCertifiedScenes), std::end(kCertifiedScenes)}, placements;
};

void checkScene(OpenedDevice& device, const Experiment& experiment, const std::string& name) {
  Scene scene = loadScene(LUCIOLE_SOURCE_DIR "/scenes/" + name + ".json");
  for (const auto& [placement, shape] : kCertifiedPlacements) {
    const auto& asked = experiment.placements;
    if (!asked.empty() && std::find(asked.begin(), asked.end(), placement) == asked.end()) continue;
    lightWithoutRange(scene, shape, experiment.lights, experiment.highlights);
    const TrueLight truth = trueLight(scene, {experiment.size[0], experiment.size[1]}, experiment.pixels);
    for (const float light_error : kCertifiedErrors) {
      const CertificateCheck check = checkCertificate(device, truth, light_error);
      fmt::print("| {} | {} | {} | 1/{:.0f} | {} | {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n",
                 name, placement, countOf(check.stats, "lights_stood_for"), 1 / light_error, check.values,
                 check.broken, check.unmet, check.worst, check.mean, check.largest_error, check.largest_bound,
                 check.mean_bound);
      std::fflush(stdout);
    }
  }
}

int run(int count, char** arguments) {
  Experiment experiment;
  CLI::App app("Holds pictures of --light-error against double precision.");
  app.add_option("SCENE", experiment.scenes);
  app.add_option("--lights", experiment.lights)->capture_default_str();
  app.add_option("--size", experiment.size, "WIDTHxHEIGHT")
      ->delimiter('x')
      ->expected(2)
      ->allow_extra_args(false);
  app.add_option("--pixels", experiment.pixels, "of each picture (default: all)");
  app.add_option("--placement", experiment.placements, "box, clusters or surface (default: all)");
  app.add_flag("--highlights", experiment.highlights, "lights have a specular part");
  CLI11_PARSE(app, count, arguments);
  OpenedDevice device;
  openDevice("", device);
  fmt::print("| scene | placement | stood for | E | values | broken | unmet | true/bound, worst | mean ");
  fmt::print("| true/E, worst | bound/E, worst | mean |\n");
  fmt::print("|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  for (const std::string& scene : experiment.scenes) checkScene(device, experiment, scene);
  return 0;
}

}  // namespace
}  // namespace luciole::test

int main(int count, char** arguments) { return luciole::test::run(count, arguments); }
