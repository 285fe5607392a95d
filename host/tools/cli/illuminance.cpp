// luciole illuminance: how much light arrives at the points of a grid.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "base/split.hpp"
#include "base/write_file.hpp"
#include "gbuffer/packed_normal.hpp"
#include "luciole/error.hpp"
#include "raster/empty_gbuffer.hpp"
#include "raster/view.hpp"
#include "render/render.hpp"
#include "scene/place_limits.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/open_devices.hpp"
#include "tools/cli/picture_options.hpp"

namespace luciole {
namespace {

/// Points of a grid, at most.
constexpr double kMostPoints = 1e7;

struct IlluminanceOptions : PictureOptions {
  std::string scene, plane, grid = "1x1";
};

/// A grid of points in the middles of equal rectangles, which fill a parallelogram.
struct MeasuredGrid {
  glm::dvec3 corner{0.0}, right{0.0}, down{0.0};  ///< of the parallelogram, and its sides
  glm::dvec3 normal{0.0};
  glm::ivec2 count{0};

  glm::dvec3 at(int x, int y) const {
    return corner + right * ((x + 0.5) / count.x) + down * ((y + 0.5) / count.y);
  }
};

std::vector<double> numbersIn(const std::string& text, char between, std::size_t count, const char* option) {
  std::vector<double> numbers;
  for (const std::string& word : split(text, between)) {
    std::size_t used = 0;
    try {
      numbers.push_back(std::stod(word, &used));
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || used != word.size() || !(std::abs(numbers.back()) <= kLargestNumber))
      throw InputError(fmt::format("--{}: expected a number, got \"{}\"", option, word));
  }
  if (numbers.size() != count)
    throw InputError(fmt::format("--{}: {} numbers, expected {}", option, numbers.size(), count));
  return numbers;
}

MeasuredGrid gridOf(const IlluminanceOptions& options) {
  const std::vector<std::string> corners = split(options.plane, ':');
  if (corners.size() != 3)
    throw InputError(fmt::format("--plane: {} corners, expected three as X,Y,Z:X,Y,Z:X,Y,Z", corners.size()));
  glm::dvec3 place[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double> v = numbersIn(corners[i], ',', 3, "plane");
    place[i] = {v[0], v[1], v[2]};
  }
  MeasuredGrid grid{place[1], place[0] - place[1], place[2] - place[1]};
  grid.normal = glm::cross(grid.down, grid.right);
  if (!(glm::length(grid.normal) > 1e-12 * glm::length(grid.right) * glm::length(grid.down)))
    throw InputError("--plane: its corners lie on one line");
  grid.normal = glm::normalize(grid.normal);
  const std::vector<double> spacing = numbersIn(options.grid, 'x', 2, "grid");
  if (!(spacing[0] > 0 && spacing[1] > 0))
    throw InputError(fmt::format("--grid {}: expected metres above 0", options.grid));
  const auto steps = [](double length, double step) { return std::max(std::round(length / step), 1.0); };
  const double columns = steps(glm::length(grid.right), spacing[0]),
               rows = steps(glm::length(grid.down), spacing[1]);
  if (columns * rows > kMostPoints)
    throw InputError(fmt::format("--grid {}: {:.3g} points, expected {:.0e} at most", options.grid,
                                 columns * rows, kMostPoints));
  grid.count = {int(columns), int(rows)};
  return grid;
}

/// White surfaces at the grid's points, as a camera above its middle sees them.
GBuffer whiteSurfaces(const MeasuredGrid& grid) {
  Camera camera;
  const glm::dvec3 middle = grid.corner + 0.5 * (grid.right + grid.down);
  const double extent = glm::length(grid.right) + glm::length(grid.down);
  const glm::dvec3 across = glm::normalize(grid.right);
  camera.camera_to_world = {glm::dvec4(across, 0), glm::dvec4(glm::cross(grid.normal, across), 0),
                            glm::dvec4(grid.normal, 0), glm::dvec4(middle + grid.normal * extent, 1)};
  camera.orthographic = true;
  camera.half_height = extent;
  camera.near = extent / 2;
  camera.far = 2 * extent;
  GBuffer gbuffer = emptyGBuffer(cameraView(camera, grid.count), {.geometric_normal = true});
  gbuffer.camera = camera;
  const glm::dmat4 to_view = worldToView(camera);
  const std::size_t n = gbuffer.pixels();
  for (int y = 0; y < grid.count.y; ++y)
    for (int x = 0; x < grid.count.x; ++x) {
      const std::size_t i = gbuffer.index(x, y);
      const glm::dvec3 place(to_view * glm::dvec4(grid.at(x, y), 1));
      for (int c = 0; c < 3; ++c) {
        gbuffer.position[i + std::size_t(c) * n] = float(place[c]);
        gbuffer.normal[i + std::size_t(c) * n] = c == 2 ? 1.0f : 0.0f;
        gbuffer.diffuse[i + std::size_t(c) * n] = 1.0f;
      }
      gbuffer.geometric_normal[i] = packNormal({0, 0, 1});
    }
  return gbuffer;
}

void measure(CommandContext& context, const IlluminanceOptions& options) {
  const MeasuredGrid grid = gridOf(options);
  if (!options.output.empty() && options.output != "-") checkPlace(options.output);
  Scene scene = openScene(options.scene, 1, options);
  scene.fog = {};
  scene.ambient = glm::vec3(0.0f);
  for (Light& light : scene.lights) {
    light.ambient = glm::vec3(0.0f);
    light.diffuse *= luxOfColor(light);
  }
  scene.sources.clear();  // their lights stay
  scene.lighting = true;
  RenderSettings settings;
  applySettings(options.settings, settings);
  if (settings.shade.shadows == ShadowMethod::kAuto) settings.shade.shadows = ShadowMethod::kExact;
  startCheckedDevice(options, context, true);
  Stats stats;
  const Image lit = shadeGBuffer(context.device, scene, whiteSurfaces(grid), settings, stats);
  std::string csv = "x,y,z,lux\n";
  std::vector<double> lux;
  for (int y = 0; y < grid.count.y; ++y)
    for (int x = 0; x < grid.count.x; ++x) {
      const float* pixel = &lit.pixels[(std::size_t(y) * lit.width + x) * lit.channels.size()];
      lux.push_back(0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2]);
      const glm::dvec3 place = grid.at(x, y);
      csv += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g}\n", place.x, place.y, place.z, lux.back());
    }
  const auto [least, most] = std::minmax_element(lux.begin(), lux.end());
  const double mean = std::accumulate(lux.begin(), lux.end(), 0.0) / double(lux.size());
  const std::string summary =
      *most > 0 ? fmt::format(
                      "{} points: mean {:.6g} lux, least {:.6g}, most {:.6g}; least/mean {:.4f}, "
                      "least/most {:.4f}\n",
                      lux.size(), mean, *least, *most, *least / mean, *least / *most)
                : fmt::format("{} points: 0 lux, from where the corners of --plane run counter-clockwise\n",
                              lux.size());
  if (options.output.empty() || options.output == "-")
    fmt::print("{}", csv);
  else
    writeTextFile(options.output, csv);
  if (!options.quiet) fmt::print(stderr, "{}", summary);
}

}  // namespace

void addIlluminanceCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "illuminance",
      "how much light arrives at the points of a grid, as CSV: lux where lights' colours are candela");
  auto options = std::make_shared<IlluminanceOptions>();
  command->add_option("SCENE", options->scene, "a .json, .obj, .gltf or .glb file")->required();
  command
      ->add_option(
          "--plane", options->plane,
          "three corners of a parallelogram, metres: the end of one side, the corner between, and the end "
          "of the other; light arrives where these three run counter-clockwise")
      ->required()
      ->type_name("X,Y,Z:X,Y,Z:X,Y,Z");
  command
      ->add_option(
          "--grid", options->grid,
          "metres between its points along the sides, about: points lie in the middles of equal parts")
      ->type_name("DXxDY")
      ->capture_default_str();
  command->add_option("-o,--output", options->output, "a .csv file (default: standard output)")
      ->type_name("FILE");
  addPictureOptions(*command, *options, kShadeOptions | kCastOption | kDeviceOption | kManyPictures);
  command->callback([&context, options] { measure(context, *options); });
}

}  // namespace luciole
