#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "cli/commands.hpp"
#include "cli/picture_options.hpp"
#include "error.hpp"
#include "image/write_file.hpp"
#include "scene/light_field.hpp"
#include "scene/load_scene.hpp"
#include "scene/write_scene.hpp"

namespace luciole {
namespace {

constexpr glm::vec3 kLampColors[]{
    {1.0f, 0.55f, 0.2f}, {1.0f, 0.8f, 0.5f}, {0.4f, 0.6f, 1.0f}, {0.5f, 1.0f, 0.6f}, {1.0f, 0.35f, 0.5f}};

struct LightsOptions {
  std::string mesh, output = "-";
  std::uint64_t count = 1000, seed = 0;
  std::vector<double> low{-10, 0, -10}, high{10, 10, 10}, colors;
  double range = 0, intensity = 1;
};

/// Lights in range of a point inside the field, on average, when no range is given.
constexpr double kLightsPerPoint = 8;

void generateLights(const LightsOptions& options) {
  LightField field;
  field.count = options.count;
  field.seed = options.seed;
  field.low = {options.low[0], options.low[1], options.low[2]};
  field.high = {options.high[0], options.high[1], options.high[2]};
  if (!options.mesh.empty()) {
    const Bounds bounds = sceneBounds(loadScene(options.mesh));
    field.low = bounds.low;
    field.high = bounds.high;
  }
  if (options.colors.empty()) {
    field.colors.assign(std::begin(kLampColors), std::end(kLampColors));
  } else {
    field.colors.clear();
    for (std::size_t i = 0; i + 2 < options.colors.size(); i += 3)
      field.colors.emplace_back(options.colors[i], options.colors[i + 1], options.colors[i + 2]);
  }
  const glm::dvec3 sides = field.high - field.low;
  if (!(sides.x >= 0 && sides.y >= 0 && sides.z >= 0))
    throw InputError("generate lights: --min must not exceed --max");
  double range = options.range;
  if (range == 0) {
    const double volume = std::max(sides.x, 1e-3) * std::max(sides.y, 1e-3) * std::max(sides.z, 1e-3);
    range = std::cbrt(kLightsPerPoint * volume / std::max<double>(double(options.count), 1) * 3 /
                      (4 * 3.14159265358979));
  }
  field.range = glm::vec2(float(range));
  field.intensity = glm::vec2(float(options.intensity));
  std::vector<Light> lights;
  expandLightField(field, lights);
  std::string mesh = options.mesh;
  if (!mesh.empty() && options.output != "-") {
    // Paths in a scene file are relative to it.
    const auto folder = std::filesystem::absolute(options.output).parent_path();
    mesh = std::filesystem::absolute(mesh).lexically_proximate(folder).string();
  }
  writeTextFile(options.output, lightsScene(mesh, lights));
}

}  // namespace

void addGenerateCommand(CLI::App& app, CommandContext&) {
  CLI::App* command = app.add_subcommand("generate", "seeded light fields, as scene files");
  command->require_subcommand(1);
  CLI::App* lights =
      command->add_subcommand("lights", "point lights spread at random, the same for the same seed");
  auto options = std::make_shared<LightsOptions>();
  lights->add_option("MESH", options->mesh, "fill this file's bounding box, and place it in the scene");
  lights->add_option("--count", options->count, "lights")->capture_default_str();
  lights->add_option("--seed", options->seed)->capture_default_str();
  lights->add_option("--min", options->low, "x,y,z of the box, without MESH")->delimiter(',')->expected(3);
  lights->add_option("--max", options->high)->delimiter(',')->expected(3);
  lights->add_option("--range", options->range, "metres (default: about 8 lights reach a point)")
      ->check(CLI::PositiveNumber);
  lights->add_option("--intensity", options->intensity)->check(CLI::NonNegativeNumber)->capture_default_str();
  lights->add_option("--color", options->colors, "r,g,b; several: each light picks one")
      ->delimiter(',')
      ->check(CLI::NonNegativeNumber);
  lights->add_option("-o,--output", options->output, "scene file (- : standard output)")
      ->capture_default_str();
  lights->callback([options] {
    if (options->colors.size() % 3 != 0) throw InputError("--color: expected r,g,b, or several times r,g,b");
    generateLights(*options);
  });
}

}  // namespace luciole
