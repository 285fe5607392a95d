// luciole bake: an object's light as a map in texture space.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/write_file.hpp"
#include "image/picture_hash.hpp"
#include "image/png_bytes.hpp"
#include "image/srgb.hpp"
#include "luciole/error.hpp"
#include "raster/surface_ids.hpp"
#include "raster/texture_space.hpp"
#include "render/bake.hpp"
#include "scene/gltf/write_gltf.hpp"
#include "tools/bake/write_baked.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/open_devices.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/picture_output.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/suggest.hpp"

namespace luciole {
namespace {

struct BakeOptions : PictureOptions {
  std::string scene;
  std::string object;
  std::string gltf;
  std::vector<double> eye;
  bool irradiance = false;
};

/// Of a scene's objects, in the message about one that isn't there.
constexpr std::size_t kNamesShown = 12;

/// Throws InputError for a name that no object has, or several have.
std::uint32_t objectNamed(const Scene& scene, const std::string& name) {
  const std::vector<std::string> names = objectNames(scene);
  const auto count = std::count(names.begin(), names.end(), name);
  if (count == 0) {
    const std::string hint = didYouMean(name, names);
    const std::size_t shown = std::min(names.size(), kNamesShown);
    throw InputError(fmt::format("--object {}: {} has no object of that name{}; it has {}{}", name,
                                 scene.name, hint,
                                 fmt::join(names.begin(), names.begin() + std::ptrdiff_t(shown), ", "),
                                 shown < names.size() ? " ..." : ""));
  }
  if (count > 1) throw InputError(fmt::format("--object {}: {} objects have that name", name, count));
  return std::uint32_t(std::find(names.begin(), names.end(), name) - names.begin());
}

/// The map as sRGB codes of its share of the brightest, which is returned.
float encodeMap(const Image& map, std::vector<std::uint8_t>& codes) {
  const std::size_t channels = map.channels.size(), texels = map.pixels.size() / channels;
  float most = 0;
  for (std::size_t i = 0; i < texels; ++i)
    for (std::size_t c = 0; c < 3; ++c) most = std::max(most, map.pixels[i * channels + c]);
  if (!(most > 0)) most = 1;
  codes.resize(3 * texels);
  for (std::size_t i = 0; i < texels; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      codes[3 * i + c] = std::uint8_t(std::lround(255 * encodeSrgb(map.pixels[i * channels + c] / most)));
  return most;
}

void checkOptions(const BakeOptions& options) {
  checkOutput(options);
  if (options.exposure == "auto")
    throw InputError("--exposure auto: a map keeps the scene's units, expected stops");
  if (!options.gltf.empty()) {
    checkGltfPath(options.gltf);
    if (options.gltf == "-") throw InputError("--to-gltf -: expected a file's name, standard output is -o's");
    checkPlace(options.gltf);
  }
  const std::string& shadows = options.value("shadows");
  if (!options.eye.empty() && (shadows == "hard" || shadows == "pcf" || shadows == "soft"))
    throw InputError(fmt::format(
        "--shadows {}: maps of a sun follow a camera, which --eye isn't; expected exact, soft-exact or off",
        shadows));
}

void bake(CommandContext& context, BakeOptions& options) {
  const int frame = useFrame(options, "bake");
  checkOptions(options);
  Stats stats;
  stats.command = context.command_line;
  startDevice(options.device, context.device);
  Scene scene = timed(stats, Stage::kLoadScene, [&] { return openLitScene(options.scene, frame, options); });
  scene.fog = {};
  scene.background = glm::vec3(0.0f);
  scene.sources.clear();  // their lights stay
  RenderSettings settings = renderSettings(options, scene);
  const std::uint32_t object = objectNamed(scene, options.object);
  logEvent("frame_begun", {{"frame", frame}});
  ProgressLine progress(options.quiet);
  settings.on_long_compile = compileReporter(progress);
  BakeSettings light{.irradiance = options.irradiance};
  if (!options.eye.empty()) light.eye = {options.eye[0], options.eye[1], options.eye[2]};
  const Image map = bakeMap(context.device, scene, object, light, settings, stats);
  progress.clear();
  for (std::size_t i = scene.warnings.size(); i < stats.warnings.size() && !options.quiet; ++i)
    reportWarning(stats.warnings[i]);
  logDevice(context.device.description);
  const std::uint64_t limited = timed(stats, Stage::kWrite, [&] {
    if (!options.gltf.empty()) {
      std::vector<std::uint8_t> codes;
      const float strength = encodeMap(map, codes);
      const Object& shown = scene.objects[object];
      writeBakedGltf(scene, shown, lightMapUvs(scene, scene.meshes[shown.mesh]),
                     pngBytes(map.width, map.height, codes), strength, options.gltf);
    }
    if (options.hash) stats.hash = pictureHash(map);
    if (showsAov(options)) {
      writeAov(options, map, stats, &context.device);
      return std::uint64_t(0);
    }
    return writeImage(map, options.output, pictureMetadata(stats, &context.device),
                      writeOptions(options, std::nullopt, settings.size, {0, 0}));
  });
  reportHalves(options, limited, stats);
  reportFaults(options, stats);
  reportLightError(options, stats);
  reportStats(options, stats, frame);
}

}  // namespace

void addBakeCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("bake", "write the light on an object as a map in texture space");
  auto options = std::make_shared<BakeOptions>();
  options->settings["size"] = "1024x1024";
  command->add_option("SCENE", options->scene, "a scene file, or - for standard input")->required();
  command->add_option("--object", options->object, "whose light: its name, as in Cryptomattes")
      ->required()
      ->type_name("NAME");
  command->add_option("--size", options->settings["size"], "texels of the map (default: 1024x1024)")
      ->type_name("WxH");
  command
      ->add_option("--eye", options->eye,
                   "with the highlights that are seen from this place of the world (default: none)")
      ->expected(3)
      ->type_name("X Y Z");
  command->add_flag("--irradiance", options->irradiance,
                    "the light that arrives, to be multiplied by the surface's own colours: diffuse and "
                    "ambient count as 1, emission as 0");
  command
      ->add_option("--to-gltf", options->gltf,
                   "also write the object as a .glb or .gltf, with the map as its emissive texture")
      ->type_name("FILE");
  addPictureOptions(*command, *options,
                    kModelOptions | kShadeOptions | kCastOption | kDeviceOption | kFrameOption);
  command->callback([&context, options] { bake(context, *options); });
}

}  // namespace luciole
