#include <filesystem>
#include <memory>
#include <string>

#include "base/clock.hpp"
#include "base/write_file.hpp"
#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "reference/reference_picture.hpp"
#include "render/render.hpp"
#include "tools/assets/lights_asset.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/difference_json.hpp"

namespace luciole {
namespace {

struct GltfLightsOptions {
  std::uint64_t count = 1000, seed = 0;
  std::string output, reference;
};

std::string beside(const std::string& path, const char* extension) {
  return std::filesystem::path(path).replace_extension(extension).string();
}

void checkOptions(const GltfLightsOptions& options) {
  checkGltfPath(options.output);
  checkPlace(options.output);
  if (options.reference.empty()) return;
  if (options.output == "-") throw InputError("--reference: goes with a file that -o names");
  if (std::filesystem::path(options.reference).extension() != ".exr")
    throw InputError(options.reference + ": expected a name that ends in .exr");
  checkPlace(options.reference);
}

/// Writes the picture in double precision of the file that was written, also as a PNG, and beside it how far
/// the renderer's is from it.
void writeReference(const GltfLightsOptions& options, CommandContext& context) {
  const Scene scene = loadScene(options.output);
  RenderSettings settings;
  settings.camera = scene.cameras.front();
  const View view = cameraView(settings.camera, settings.size, {});
  double started = millisecondsSinceStart();
  Image truth{settings.size.x, settings.size.y, {"R", "G", "B"}, {}};
  for (const glm::dvec3& color :
       referencePicture(scene, view, settings.shading, 1, allPixels(settings.size), {}))
    for (int c = 0; c < 3; ++c) truth.pixels.push_back(pictureValue(color[c]));
  const double reference_milliseconds = millisecondsSinceStart() - started;
  openDevice("", context.device);
  Stats stats;
  started = millisecondsSinceStart();
  const Image ours = renderScene(context.device, scene, settings, stats);
  const double milliseconds = millisecondsSinceStart() - started;

  nlohmann::ordered_json figures{{"count", options.count},
                                 {"seed", options.seed},
                                 {"width", settings.size.x},
                                 {"height", settings.size.y},
                                 {"file_bytes", std::filesystem::file_size(options.output)},
                                 {"milliseconds", milliseconds},
                                 {"reference_milliseconds", reference_milliseconds}};
  figures.update(differenceJson(compareImages(truth, ours)));
  const Metadata metadata{{"ImageDescription", context.command_line}};
  writeImage(truth, options.reference, metadata);
  writeImage(truth, beside(options.reference, ".png"), metadata, {.dither = true});
  writeTextFile(beside(options.reference, ".json"), figures.dump(2) + "\n");
}

}  // namespace

void addGltfLightsCommand(CLI::App& generate, CommandContext& context) {
  CLI::App* command =
      generate.add_subcommand("gltf-lights", "a glTF file with many lights, to test viewers by");
  auto options = std::make_shared<GltfLightsOptions>();
  command->add_option("--count", options->count, "lights, 1 to 1000000")
      ->check(CLI::Range(std::uint64_t(1), kMostAssetLights))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "what the random numbers begin with")->capture_default_str();
  command
      ->add_option("-o,--output", options->output,
                   ".glb, or .gltf with a .bin beside it (- : .glb on standard output)")
      ->required();
  command->add_option(
      "--reference", options->reference,
      "an .exr: also write the picture of 1280x720 in double precision, beside it a .png of it and "
      "a .json of how far the renderer's is from it");
  command->callback([&context, options] {
    checkOptions(*options);
    writeGltf(lightsAsset(options->count, options->seed), options->output);
    if (!options->reference.empty()) writeReference(*options, context);
  });
}

}  // namespace luciole
