#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/write_file.hpp"
#include "load/no_light_warning.hpp"
#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "raster/visible_points.hpp"
#include "scene/bounds.hpp"
#include "scene/json/light_list.hpp"
#include "scene/json/mesh_file.hpp"
#include "scene/json/write_scene.hpp"
#include "scene/lights/light_field.hpp"
#include "scene/lights/light_range.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/picture_options.hpp"

namespace luciole {
namespace {

/// The options as typed; empty if they weren't.
struct LightsOptions {
  std::string scene, output = "-", shape, csv;
  std::optional<std::uint64_t> count, clusters;
  std::uint64_t seed = 0;
  std::vector<double> low, high, center, points, colors, range;
  std::optional<double> radius, offset, density, cutoff;
  double intensity = 1;
  bool no_range = false, shadow = false;
  LoadSettings load;
};

constexpr std::uint64_t kDefaultCount = 1000;

const Bounds kDefaultBox{{-10, 0, -10}, {10, 10, 10}};

glm::dvec3 vectorAt(const std::vector<double>& numbers, std::size_t i) {
  return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}

/// Throws InputError for options that have no meaning for this shape.
void checkShapeOptions(const LightsOptions& options, const std::string& shape) {
  const std::pair<const char*, bool> given[]{
      {"--min", !options.low.empty()},          {"--max", !options.high.empty()},
      {"--center", !options.center.empty()},    {"--radius", options.radius.has_value()},
      {"--offset", options.offset.has_value()}, {"--clusters", options.clusters.has_value()},
      {"--points", !options.points.empty()},    {"--color", !options.colors.empty()}};
  static const std::map<std::string, std::string> kMeaningful{
      {"box", "--min --max --color"},
      {"ball", "--center --radius --color"},
      {"sphere", "--center --radius --color"},
      {"surface", "--offset --color"},
      {"clusters", "--min --max --radius --clusters --color"},
      {"curve", "--radius --points --color"},
      {"csv", ""}};
  for (const auto& [option, is_given] : given) {
    if (is_given && kMeaningful.at(shape).find(option) == std::string::npos) {
      throw InputError(fmt::format("generate lights: {} means nothing {}", option,
                                   shape == "csv" ? "beside --csv" : "for --shape " + shape));
    }
  }
}

/// The box that a field fills: as typed, otherwise around what is seen of the scene.
Bounds fieldBox(const LightsOptions& options, const Scene& scene, const std::vector<glm::dvec3>& seen) {
  Bounds box = kDefaultBox;
  const bool is_typed = !options.low.empty() && !options.high.empty();
  if (!options.scene.empty() && !is_typed) {
    if (seen.empty())
      throw InputError(options.scene + ": its first camera sees nothing that lights could be put around");
    box = seenBox(seen, glm::dvec3(scene.cameras.front().camera_to_world[3]));
  }
  if (!options.low.empty()) box.low = vectorAt(options.low, 0);
  if (!options.high.empty()) box.high = vectorAt(options.high, 0);
  for (int i = 0; i < 3; ++i) {
    if (!(box.low[i] <= box.high[i])) {
      throw InputError(
          fmt::format("generate lights: the box's {} is from {} to {}; --min must not exceed --max", "xyz"[i],
                      box.low[i], box.high[i]));
    }
  }
  return box;
}

LightField shapedField(const LightsOptions& options, const std::string& shape, const Scene& scene,
                       const std::vector<glm::dvec3>& seen) {
  LightField field;
  if (shape == "csv") {
    field.shape = FieldShape::kList;
    field.list = readLightList(options.csv, options.count);
    field.count = field.list.size();
    return field;
  }
  const auto known = fieldShapeNamed(shape);
  if (!known)
    throw InputError(fmt::format("generate lights: --shape {}: expected {}", shape, kFieldShapeNames));
  field = fieldInBox(*known, fieldBox(options, scene, seen));
  field.count = options.count.value_or(kDefaultCount);
  if (!options.center.empty()) field.center = vectorAt(options.center, 0);
  if (options.radius) field.radius = *options.radius;
  if (options.offset) field.offset = *options.offset;
  if (options.clusters) field.clusters = *options.clusters;
  if (!options.points.empty()) {
    field.points.clear();
    for (std::size_t i = 0; 3 * i < options.points.size(); ++i)
      field.points.push_back(vectorAt(options.points, i));
  }
  return field;
}

void setColors(const LightsOptions& options, LightField& field) {
  if (options.colors.empty()) return;
  field.colors.clear();
  for (std::size_t i = 0; 3 * i < options.colors.size(); ++i)
    field.colors.emplace_back(vectorAt(options.colors, i));
}

/// Points at which density and brightness are measured: what the camera sees, or without a scene, places in
/// the field.
std::vector<glm::dvec3> measuredPoints(const LightsOptions& options, const LightField& field,
                                       const std::vector<glm::dvec3>& seen) {
  if (!options.scene.empty()) {
    if (seen.empty())
      throw InputError(options.scene + ": its first camera sees nothing to measure a density at");
    return seen;
  }
  if (field.shape == FieldShape::kList)
    throw InputError(fmt::format("generate lights: {} needs a SCENE beside --csv",
                                 options.no_range ? "--no-range" : "--density"));
  return fieldPlaces(field, {});
}

void generateLights(const LightsOptions& options) {
  const std::string shape = !options.csv.empty() ? "csv" : options.shape.empty() ? "box" : options.shape;
  if (!fieldShapeNamed(shape) && shape != "csv")
    throw InputError(fmt::format("generate lights: --shape {}: expected {}", shape, kFieldShapeNames));
  checkShapeOptions(options, shape);
  Scene scene;
  std::vector<glm::dvec3> seen;
  if (!options.scene.empty()) {
    scene = loadScene(options.scene, 1, options.load);
    std::erase(scene.warnings, noLightWarning(scene));
    reportWarnings(scene.warnings);
    clearLights(scene);
    seen = visiblePoints(scene, scene.cameras.front(), scene.size.value_or(glm::ivec2(1280, 720)),
                         kMeasuredPlaces, 0);
  }
  LightField field = shapedField(options, shape, scene, seen);
  field.seed = options.seed;
  setColors(options, field);
  field.intensity = glm::vec2(float(options.intensity));
  if (!options.range.empty()) field.range = {float(options.range.front()), float(options.range.back())};
  if (options.cutoff) {
    field.cutoff = *options.cutoff;
    field.attenuation = glm::vec3(0, 0, 1);
  }
  field.shadow = options.shadow;
  expandLightField(field, scene);
  const bool is_ranged = !options.range.empty() || options.cutoff || shape == "csv";
  if (options.density || options.no_range || !is_ranged) {
    if (std::any_of(scene.lights.begin(), scene.lights.end(),
                    [](const Light& light) { return light.kind == LightKind::kDirectional; }))
      throw InputError(fmt::format("generate lights: {}: a directional light of {} has no place to fade from",
                                   options.no_range ? "--no-range" : "--density", options.csv));
    const std::vector<glm::dvec3> points = measuredPoints(options, field, seen);
    if (options.density || !is_ranged) {
      const float range = rangeForDensity(scene.lights, points, options.density.value_or(kUsualDensity));
      for (Light& light : scene.lights) light.range = range;
    }
    if (options.no_range) removeRanges(scene.lights, points);
  }

  // Paths in a scene file are relative to it.
  const std::string folder =
      options.output == "-" ? "." : std::filesystem::absolute(options.output).parent_path().string();
  if (options.scene.empty()) {
    writeTextFile(options.output, lightsScene(scene.lights));
    return;
  }
  const Camera& camera = scene.cameras.front();
  writeTextFile(options.output, isMeshFile(options.scene)
                                    ? meshWithLights(pathFrom(folder, options.scene), camera, scene.lights)
                                    : sceneWithLights(options.scene, folder, camera, scene.lights));
}

/// Checks that CLI11 can't do. Throws InputError.
void checkOptions(const LightsOptions& options) {
  if (options.scene == "-")
    throw InputError("SCENE: expected a file, got standard input, which can't be read twice");
  if (options.colors.size() % 3 != 0) throw InputError("--color: expected r,g,b, or several times r,g,b");
  if (options.points.size() % 3 != 0 || options.points.size() == 3)
    throw InputError("--points: expected x,y,z of two points or more");
  if (options.range.size() > 2) throw InputError("--range: expected metres, or LOW,HIGH");
  if (options.range.size() == 2 && options.range[0] > options.range[1])
    throw InputError("--range: the lowest is above the highest");
}

void addLightsCommand(CLI::App& command) {
  CLI::App* lights =
      command.add_subcommand("lights", "point lights spread at random, the same for the same seed");
  auto options = std::make_shared<LightsOptions>();
  const CLI::Range any(-1e18, 1e18), positive(1e-18, 1e18), not_negative(0.0, 1e18);
  const auto vectorOption = [&](const char* name, std::vector<double>& value, const char* help) {
    return lights->add_option(name, value, help)->delimiter(',')->check(any);
  };
  lights->add_option("SCENE", options->scene,
                     "light what this file's first camera sees; its own lights are left out");
  auto* shape = lights->add_option(
      "--shape", options->shape,
      "box (default), ball, sphere, surface (on the scene's triangles), clusters or curve");
  lights
      ->add_option(
          "--csv", options->csv,
          "take the lights from lines x,y,z,r,g,b,range instead, or of the columns that the first line names "
          "(scenes/FORMATS.md)")
      ->excludes(shape);
  lights->add_option("--count", options->count, "lights (default: 1000, or all of --csv)");
  lights->add_option("--seed", options->seed, "what the random numbers begin with")->capture_default_str();
  vectorOption("--min", options->low,
               "x,y,z of the box (default: what the camera sees; without SCENE -10,0,-10)")
      ->expected(3);
  vectorOption("--max", options->high, "(without SCENE 10,10,10)")->expected(3);
  vectorOption("--center", options->center, "x,y,z of a ball or sphere (default: the middle of the box)")
      ->expected(3);
  lights
      ->add_option("--radius", options->radius,
                   "metres: a ball's, a sphere's, a cluster's, or around a curve")
      ->check(not_negative);
  lights->add_option("--offset", options->offset, "metres in front of surfaces (default: 1 % of the box)")
      ->check(any);
  lights->add_option("--clusters", options->clusters, "how many (default: 32)")
      ->check(CLI::Range(std::uint64_t(1), kMostLights));
  vectorOption("--points", options->points, "x,y,z,x,y,z,... that a curve goes through")
      ->allow_extra_args(false);
  auto* range = lights->add_option("--range", options->range, "metres, or LOW,HIGH")
                    ->delimiter(',')
                    ->allow_extra_args(false)
                    ->check(positive);
  auto* density =
      lights
          ->add_option("--density", options->density,
                       "the range with which that many lights reach a visible pixel on average (default: 8)")
          ->check(positive)
          ->excludes(range);
  auto* cutoff =
      lights
          ->add_option("--cutoff", options->cutoff,
                       "fade with the square of the distance; the range is where the light has faded to this")
          ->check(positive)
          ->excludes(range)
          ->excludes(density);
  lights
      ->add_flag(
          "--no-range", options->no_range,
          "reach everywhere, faded with the square of the distance; as bright on average as without this")
      ->excludes(range)
      ->excludes(density)
      ->excludes(cutoff);
  lights->add_option("--intensity", options->intensity, "of each light")
      ->check(not_negative)
      ->capture_default_str();
  lights->add_option("--color", options->colors, "r,g,b; several: each light picks one")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(not_negative);
  lights->add_flag("--shadow", options->shadow, "all lights cast shadows");
  addLoadOptions(*lights, options->load);
  addThreadsOption(*lights);
  lights->add_option("-o,--output", options->output, "scene file (- : standard output)")
      ->capture_default_str();
  lights->callback([options] {
    checkOptions(*options);
    generateLights(*options);
  });
}

}  // namespace

void addGenerateCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command =
      app.add_subcommand("generate", "seeded light fields as scene files, and glTF files with many lights");
  command->require_subcommand(1);
  addLightsCommand(*command);
  addGltfLightsCommand(*command, context);
}

}  // namespace luciole
