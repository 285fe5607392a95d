// luciole shadow-map: what a light's shadow map shows.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "base/text_file.hpp"
#include "image/file_format.hpp"
#include "luciole/error.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/picture_output.hpp"
#include "tools/cli/suggest.hpp"
#include "tools/viewing/light_map.hpp"

namespace luciole {
namespace {

/// Of a scene's lights, in the message about one that isn't there.
constexpr std::size_t kNamesTold = 12;

struct ShadowMapOptions : PictureOptions {
  std::string scene;
  std::string light;
};

std::uint32_t lightNamed(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (scene.lights[i].name.empty()) continue;
    if (scene.lights[i].name == name) return std::uint32_t(i);
    names.push_back(forMessage(scene.lights[i].name));
  }
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool is_number = error == std::errc() && end == name.data() + name.size();
  if (is_number && number < scene.lights.size()) return std::uint32_t(number);
  const std::string guess = is_number ? "" : didYouMean(name, names);
  const std::size_t told = std::min(names.size(), kNamesTold);
  const std::string list =
      names.empty() || !guess.empty()
          ? ""
          : fmt::format("; names are {}{}",
                        fmt::join(names.begin(), names.begin() + std::ptrdiff_t(told), ", "),
                        told < names.size() ? " ..." : "");
  throw InputError(fmt::format("--light {}: {} has {}{}{}", forMessage(name), scene.name,
                               scene.lights.empty() ? "no lights"
                               : scene.lights.size() == 1
                                   ? "light 0 alone"
                                   : fmt::format("the lights 0 to {}", scene.lights.size() - 1),
                               guess, list));
}

/// All faces as layers of floats: Z, or NAME.Z of each.
Image faceLayers(const LightMap& map) {
  Image image{map.size, map.size, {}, {}};
  for (const LightFace& face : map.faces)
    image.channels.push_back(face.name.empty() ? "Z" : face.name + ".Z");
  image.pixels.reserve(std::size_t(map.size) * map.size * map.faces.size());
  for (std::size_t texel = 0; texel < map.faces[0].metres.size(); ++texel)
    for (const LightFace& face : map.faces) image.pixels.push_back(face.metres[texel]);
  return image;
}

void shadowMap(const CommandContext& context, ShadowMapOptions& options) {
  const int frame = useFrame(options, "shadow-map");
  checkOutput(options);
  Stats stats;
  stats.command = context.command_line;
  const Scene scene =
      timed(stats, Stage::kLoadScene, [&] { return openScene(options.scene, frame, options); });
  const std::uint32_t number = lightNamed(scene, options.light);
  const Light& light = scene.lights[number];
  if (!light.shadow)
    throw InputError(fmt::format("--light {}: casts no shadow in {}; with --cast-shadows all it does",
                                 forMessage(options.light), scene.name));
  const RenderSettings settings = renderSettings(options, scene);
  logEvent("frame_begun", {{"frame", frame}});
  const LightMap map = timed(stats, Stage::kShadowMaps, [&] {
    return drawLightMap(scene, cameraView(settings.camera, settings.size), number,
                        settings.shade.shadow_limits);
  });
  if (map.faces.empty()) throw InputError(scene.name + ": has no surface, so shadow maps show nothing");
  timed(stats, Stage::kWrite, [&] {
    const bool has_layers = outputFormat(options.output, options.value("format")).extension == "exr";
    const std::string name = light.name.empty() ? fmt::format("light {}", number) : light.name;
    WriteOptions how = fileOptions(options);
    how.dither = false;
    writeImage(has_layers ? faceLayers(map) : lightMapPicture(map, fmt::format("{}, metres", name)),
               options.output, pictureMetadata(stats, nullptr), how);
  });
  stats.width = stats.height = map.size;
  if (!options.stats.empty() || logsEvents()) return reportStats(options, stats, frame);
  if (!options.quiet)
    fmt::print(stderr, "{}: {} face{} of {}x{} texels, {:.0f} ms\n", options.output, map.faces.size(),
               map.faces.size() == 1 ? "" : "s", map.size, map.size, millisecondsSinceStart());
}

}  // namespace

void addShadowMapCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "shadow-map", "what a light's shadow map shows, in metres: a picture, or an EXR with a layer a face");
  auto options = std::make_shared<ShadowMapOptions>();
  command
      ->add_option("SCENE", options->scene, "a .json, .obj, .gltf or .glb file (- : JSON on standard input)")
      ->required();
  command
      ->add_option("--light", options->light,
                   "which: its name, or its number among the scene's lights, from 0")
      ->required()
      ->type_name("NAME");
  command->add_option(
      "--size", options->settings["size"],
      "of the picture that the map is for: it says how fine the map is (default: the scene's, or 1280x720)");
  command->add_option("--camera", options->camera, "of that picture: by name or index");
  addSetting(*command, *options, "shadow_size");
  addPictureOptions(*command, *options, kCastOption | kFrameOption);
  command->callback([&context, options] { shadowMap(context, *options); });
}

}  // namespace luciole
