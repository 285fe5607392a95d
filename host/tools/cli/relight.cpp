// The commands that light a file of surfaces: shade and relight.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "base/split.hpp"
#include "gbuffer/camera_header.hpp"
#include "gbuffer/gbuffer_input.hpp"
#include "image/exposure.hpp"
#include "image/light_names.hpp"
#include "image/picture_hash.hpp"
#include "luciole/error.hpp"
#include "raster/surface_ids.hpp"
#include "render/measure_exposure.hpp"
#include "render/render.hpp"
#include "scene/json/mesh_file.hpp"
#include "scene/light_groups.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/open_devices.hpp"
#include "tools/cli/option_names.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/picture_output.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/suggest.hpp"
#include "tools/viewing/light_mixer.hpp"

namespace luciole {
namespace {

struct RelightOptions : PictureOptions {
  std::string input;
  std::string scene;
  std::string channels;
  std::string space;
  std::string camera_to_world;
  bool albedo = false;
  bool add = false;
};

/// The layers that --channels names. Throws InputError.
ChosenLayers typedLayers(const std::string& text) {
  ChosenLayers layers;
  if (text.empty()) return layers;
  std::vector<std::string> roles;
  for (const char* role : kRoleNames)
    if (!std::string_view(role).starts_with("view_")) roles.emplace_back(role);
  for (const std::string& pair : split(text, ',')) {
    const std::size_t equals = pair.find('=');
    const std::string name = pair.substr(0, equals);
    const auto role = std::find(kRoleNames.begin(), kRoleNames.end(), name);
    const bool is_role = std::find(roles.begin(), roles.end(), name) != roles.end();
    if (!is_role || equals == std::string::npos || equals + 1 == pair.size())
      throw InputError(fmt::format("--channels {}: expected ROLE=NAME,... with a ROLE of {}{}", pair,
                                   fmt::join(roles, ", "), is_role ? "" : didYouMean(name, roles)));
    layers[Role(role - kRoleNames.begin())] = pair.substr(equals + 1);
  }
  return layers;
}

/// The rigid motion that 16 numbers say, row by row, or column by column where only that is one. Throws
/// InputError.
glm::dmat4 typedMatrix(const std::string& text) {
  std::array<double, 16> numbers{};
  std::size_t count = 0;
  const char *at = text.data(), *end = at + text.size();
  const auto isBetween = [](char c) { return c == ' ' || c == ',' || c == '\t' || c == '\n'; };
  while (at != end) {
    if (isBetween(*at)) {
      ++at;
      continue;
    }
    double number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc() || (next != end && !isBetween(*next))) break;
    if (count < numbers.size()) numbers[count] = number;
    ++count;
    at = next;
  }
  glm::dmat4 rows;
  for (int i = 0; i < 16; ++i) rows[i % 4][i / 4] = numbers[std::size_t(i)];
  if (!isRigid(rows)) rows = glm::transpose(rows);
  if (at != end || count != numbers.size() || !isRigid(rows))
    throw InputError(fmt::format(
        "--camera-to-world {}: expected 16 numbers, row by row, of a rotation and a translation", text));
  return rows;
}

GBufferRequest requestOf(const RelightOptions& options, const Scene& scene) {
  GBufferRequest request{
      .layers = typedLayers(options.channels), .albedo = options.albedo, .color = options.add};
  if (!options.space.empty())
    request.space = options.space == "camera" ? FileSpace::kCamera : FileSpace::kWorld;
  if (!options.camera_to_world.empty()) request.camera_to_world = typedMatrix(options.camera_to_world);
  if (!scene.adds_camera) request.camera = scene.cameras.front();
  return request;
}

/// Light alone is added to a picture: it has its own background, emission and fog's colour already.
void leaveLightAlone(Scene& scene, GBuffer& gbuffer) {
  scene.background = scene.fog.color = glm::vec3(0.0f);
  gbuffer.emission = {};
}

/// Adds a picture's channels to those of the same names of another of its size, or to new ones.
Image sumOf(const Image& picture, const Image& more) {
  Image sum{picture.width, picture.height, picture.channels, {}};
  std::vector<std::size_t> places;  // in the sum, of the channels of `more`
  for (const std::string& channel : more.channels) {
    const auto found = std::find(sum.channels.begin(), sum.channels.end(), channel);
    places.push_back(std::size_t(found - sum.channels.begin()));
    if (found == sum.channels.end()) sum.channels.push_back(channel);
  }
  const std::size_t own = picture.channels.size(), channels = sum.channels.size();
  sum.pixels.resize(std::size_t(sum.width) * std::size_t(sum.height) * channels);
  tbb::parallel_for(0, sum.height, [&](int y) {
    const std::size_t first = std::size_t(y) * std::size_t(sum.width);
    for (std::size_t pixel = first; pixel < first + std::size_t(sum.width); ++pixel) {
      float* const out = sum.pixels.data() + pixel * channels;
      std::copy_n(picture.pixels.data() + pixel * own, own, out);
      for (std::size_t c = 0; c < places.size(); ++c)
        out[places[c]] += more.pixels[pixel * places.size() + c];
    }
  });
  return sum;
}

/// A picture with the layers of its groups of lights that its file has, or where it has none, with all of it
/// as the layer of what no light gives. Throws InputError.
Image withGroups(const Image& picture, const std::string& path) {
  Image groups = readLightGroups(path);
  if (groups.channels.empty()) {
    groups = {picture.width, picture.height, {}, {}};
    for (const char* component : {".R", ".G", ".B"})
      groups.channels.push_back(std::string(kLightGroups) + kRestOfLight + component);
    for (std::size_t at = 0; at < picture.pixels.size(); at += picture.channels.size())
      groups.pixels.insert(groups.pixels.end(), &picture.pixels[at], &picture.pixels[at] + 3);
  }
  if (groups.width != picture.width || groups.height != picture.height)
    throw InputError(fmt::format("{}: layers {}NAME are of {}x{} pixels, and its picture of {}x{}", path,
                                 kLightGroups, groups.width, groups.height, picture.width, picture.height));
  return sumOf(picture, groups);
}

/// Throws InputError for layers of --aov that a file of surfaces doesn't know.
void refuseSurfaceIds(const PictureOptions& options) {
  RenderSettings layers;
  layers.aovs = aovsOf(options);
  if (wantsSurfaceIds(layers))
    throw InputError(
        "--aov: a G-buffer knows no objects and materials; render makes object_id, material_id and "
        "cryptomatte");
}

/// Lights surfaces and writes the picture. picture: that to which light is added, or empty.
void lightAndWrite(CommandContext& context, const PictureOptions& options, const Scene& scene,
                   const std::string& scene_path, const GBuffer& gbuffer, const Image& picture, int frame,
                   Stats& stats) {
  OpenedDevice& device = context.device;
  RenderSettings settings = renderSettings(options, scene);
  const bool adds = !picture.pixels.empty();
  if (adds && !settings.screens.empty())
    throw InputError("--screen: changes a whole picture, and --add makes the light that is added alone");
  const float exposure = settings.exposure;
  if (adds) settings.exposure = 0;
  logEvent("frame_begun", {{"frame", frame}});
  ProgressLine progress(options.quiet);
  settings.on_long_compile = compileReporter(progress);
  const bool measures = measuresExposure(options, scene_path);
  if (measures && !settings.screens.empty()) {
    // Screens see colours after exposure, which is measured without them.
    RenderSettings without = settings;
    without.screens.clear();
    timed(stats, Stage::kMeasureExposure, [&] {
      Stats of_measuring;
      stats.measured_exposure =
          measureExposure(shadeGBuffer(device, scene, gbuffer, without, of_measuring), gbuffer);
    });
    settings.exposure = float(*stats.measured_exposure);
  }
  Image image = shadeGBuffer(device, scene, gbuffer, settings, stats);
  progress.clear();
  logDevice(device.description);
  if (adds) {
    image = sumOf(picture, image);
    expose(image, exposure);
  }
  if (measures && settings.screens.empty()) {
    timed(stats, Stage::kMeasureExposure, [&] {
      stats.measured_exposure = measureExposure(image, gbuffer);
      expose(image, *stats.measured_exposure);
    });
  }
  const std::uint64_t limited = timed(stats, Stage::kWrite, [&] {
    if (options.hash) stats.hash = pictureHash(image);
    if (showsAov(options)) {
      writeAov(options, image, stats, &device);
      return std::uint64_t(0);
    }
    return writeImage(image, options.output, pictureMetadata(stats, &device), writeOptions(options, gbuffer));
  });
  reportHalves(options, limited, stats);
  reportFaults(options, stats);
  reportLightError(options, stats);
  reportStats(options, stats, frame);
}

void reportNotes(const std::vector<std::string>& notes, bool quiet) {
  for (const std::string& note : notes) {
    const std::string line = withOptionNames(note);
    if (logsEvents())
      logEvent("layers", {{"message", line}});
    else if (!quiet)
      writeError(fmt::format("{}\n", line));
  }
}

void relight(CommandContext& context, RelightOptions& options) {
  const int frame = useFrame(options, "relight");
  checkOutput(options);
  refuseSurfaceIds(options);
  if (options.add && (options.isOn("alpha") || !options.value("aov").empty()))
    throw InputError(
        "--add: keeps the picture's own A and makes no layers but those of --light-groups, without --alpha "
        "or "
        "--aov");
  if (options.albedo && isMeshFile(options.scene))
    throw InputError(
        fmt::format("--albedo: the lights of {} are divided by pi already, as every glTF's", options.scene));
  Stats stats;
  stats.command = context.command_line;
  startCheckedDevice(options, context, true);
  Scene scene = timed(stats, Stage::kLoadScene, [&] { return openScene(options.scene, frame, options); });
  if (scene.adds_lights) throw InputError(options.scene + ": no lights, expected a scene that has some");
  GBufferInput input = timed(stats, Stage::kReadGBuffer,
                             [&] { return readGBuffer(options.input, requestOf(options, scene)); });
  reportNotes(input.notes, options.quiet);
  if (options.add) leaveLightAlone(scene, input.gbuffer);
  if (options.add && options.isOn("light_groups")) input.color = withGroups(input.color, options.input);
  lightAndWrite(context, options, scene, options.scene, input.gbuffer, input.color, frame, stats);
}

}  // namespace

void addShadeCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("shade", "light a G-buffer, from here or from another renderer");
  auto options = std::make_shared<PictureOptions>();
  auto gbuffer_path = std::make_shared<std::string>();
  auto scene_path = std::make_shared<std::string>();
  command->add_option("GBUFFER", *gbuffer_path, "an EXR with channels P and N, or Z and N and a camera")
      ->required();
  command->add_option("--scene", *scene_path, "the scene whose lights, ambient, fog and shadow casters count")
      ->required();
  addPictureOptions(
      *command, *options,
      kModelOptions | kShadeOptions | kCastOption | kDeviceOption | kFrameOption | kExactOption);
  addScreenOption(*command, *options);
  command->callback([&context, options, gbuffer_path, scene_path] {
    const int frame = useFrame(*options, "shade");
    checkOutput(*options);
    refuseSurfaceIds(*options);
    Stats stats;
    stats.command = context.command_line;
    startCheckedDevice(*options, context, true);
    const Scene scene =
        timed(stats, Stage::kLoadScene, [&] { return openScene(*scene_path, frame, *options); });
    const GBufferInput input =
        timed(stats, Stage::kReadGBuffer, [&] { return readGBuffer(*gbuffer_path, GBufferRequest{}); });
    lightAndWrite(context, *options, scene, *scene_path, input.gbuffer, {}, frame, stats);
  });
}

void addRelightCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "relight", "light another program's picture again, by its layers of positions and normals");
  auto options = std::make_shared<RelightOptions>();
  command
      ->add_option("IN", options->input,
                   "an EXR of Blender, pbrt, Mitsuba, RenderMan, Arnold, 3Delight or here")
      ->required();
  command
      ->add_option(
          "--lights", options->scene,
          "the scene whose lights, ambient, fog and shadow casters count, and its camera where IN has none")
      ->required()
      ->type_name("SCENE");
  command
      ->add_option(
          "--channels", options->channels,
          "ROLE=NAME,...: which layers are which, such as position=Pw,normal=Nw, or shininess=40; a ROLE is "
          "position, normal, depth, diffuse, specular, shininess, ambient, emission, geometric_normal, lift "
          "or color (default: by the names that programs give them)")
      ->type_name("ROLE=NAME,...");
  command
      ->add_option(
          "--space", options->space,
          "of IN's positions and normals (default: what fits its pixels, else what its program usually has)")
      ->check(CLI::IsMember(std::vector<std::string>{"world", "camera"}));
  command
      ->add_option(
          "--camera-to-world", options->camera_to_world,
          "16 numbers, row by row: where the camera is, x to its right, y up and -z ahead (default: IN's)")
      ->type_name("NUMBERS");
  command->add_flag("--albedo", options->albedo,
                    "diffuse is an albedo and lights are in watts a steradian: Kd = albedo / pi, and "
                    "Ks = specular (n + 2) / 2 pi");
  command->add_flag("--add", options->add, "add the light to IN's own picture");
  addPictureOptions(
      *command, *options,
      kModelOptions | kShadeOptions | kCastOption | kDeviceOption | kFrameOption | kExactOption);
  addScreenOption(*command, *options);
  command->callback([&context, options] { relight(context, *options); });
}

}  // namespace luciole
