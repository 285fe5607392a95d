#include "tools/bench/memory_use.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/write_file.hpp"
#include "luciole/load_scene.hpp"
#include "render/memory.hpp"
#include "render/plan.hpp"
#include "tools/bench/child_process.hpp"

namespace luciole {
namespace {

/// A picture's size and its number of lights: the difference of two cases says what a pixel or a light costs.
struct Case {
  glm::ivec2 size;
  std::uint64_t lights;
};

struct Growth {
  const char* name;
  Case small, large;

  double count() const {
    return double(large.size.x) * large.size.y - double(small.size.x) * small.size.y +
           double(large.lights - small.lights);
  }
};

constexpr int kRuns = 3;  ///< repeats of other measurements for each run of this one, which is slow

std::string sceneText(std::uint64_t lights) {
  return fmt::format(
      R"({{"camera": {{"eye": [0, 3, 8], "target": [0, 0, 0]}}, "ambient": 0.1,
      "materials": {{"stone": {{"diffuse": 0.5, "specular": 0.5, "shininess": 32, "emission": 0.1}}}},
      "objects": [{{"primitive": "plane", "scale": 40, "material": "stone"}}],
      "light_fields": [{{"count": {}, "min": [-20, 0, -20], "max": [20, 2, 20], "range": 0.1}}]}})",
      lights);
}

/// Bytes of a run: the process's peak, and the device's buffers as the program counts them.
std::vector<double> bytesOf(const SpeedInput& input, const ScratchFolder& folder, const Case& which) {
  writeTextFile(folder / "scene.json", sceneText(which.lights));
  std::vector<std::string> arguments{
      "render",   folder / "scene.json",  "--size",  fmt::format("{}x{}", which.size.x, which.size.y),
      "-o",       folder / "picture.exr", "--stats", folder / "stats.json",
      "--device", input.device_selector,  "--quiet"};
  for (const std::string& option : sameThreads()) arguments.push_back(option);
  runChild(input.program, arguments, {});
  std::ifstream file(folder / "stats.json");
  const auto memory = nlohmann::json::parse(file)["memory"];
  return {memory["peak_bytes"], memory["device_bytes"]};
}

/// The bytes that a pixel of the scene takes by its plan.
double statedBytesPerPixel(const ScratchFolder& folder) {
  const Scene scene = loadScene(folder / "scene.json");
  RenderSettings settings;
  settings.count_lights = true;  // as --stats asks for
  settings.camera = scene.cameras.front();
  return double(planPicture(scene, settings).pixel_bytes);
}

}  // namespace

SpeedTable measureMemory(const SpeedInput& input) {
  const glm::ivec2 size = input.size.value_or(glm::ivec2(1024));
  const Growth growths[] = {
      {"pixel", {size, 100}, {2 * size, 100}},
      {"light", {glm::ivec2(64), input.most_lights / 10}, {glm::ivec2(64), input.most_lights}}};
  const ScratchFolder folder;
  // Compiles the kernels, which takes memory of its own.
  bytesOf(input, folder, growths[0].small);
  bytesOf(input, folder, growths[1].small);
  const auto rounds = runInRounds(std::size(growths), (input.repeats + kRuns - 1) / kRuns, "memory",
                                  input.on_progress, [&](std::size_t row) {
                                    const Growth& growth = growths[row];
                                    std::vector<double> bytes = bytesOf(input, folder, growth.large);
                                    const std::vector<double> less = bytesOf(input, folder, growth.small);
                                    for (std::size_t i = 0; i < bytes.size(); ++i)
                                      bytes[i] = (bytes[i] - less[i]) / growth.count();
                                    return bytes;
                                  });
  SpeedTable table{
      .name = "memory",
      .measured = fmt::format(
          "bytes by which luciole render grows with a pixel, from {} x {} to twice as many a "
          "side, and with a light, from {} to {}; buffers: those of OpenCL among them; stated: what the "
          "program reckons with",
          size.x, size.y, growths[1].small.lights, growths[1].large.lights),
      .columns = {{"peak_bytes", "bytes", 1}, {"device_bytes", "buffers", 1}, {"stated_bytes", "stated", 0}}};
  const double stated[] = {statedBytesPerPixel(folder), double(kBytesPerLight)};
  for (std::size_t row = 0; row < rounds.size(); ++row)
    table.rows.push_back({growths[row].name, {rounds[row].summary(0), rounds[row].summary(1), stated[row]}});
  return table;
}

}  // namespace luciole
