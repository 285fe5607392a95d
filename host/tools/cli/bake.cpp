// luciole bake: an object's light as a map in texture space.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/write_file.hpp"
#include "image/picture_hash.hpp"
#include "image/png_bytes.hpp"
#include "image/srgb.hpp"
#include "luciole/error.hpp"
#include "raster/lift.hpp"
#include "raster/surface_ids.hpp"
#include "raster/texture_space.hpp"
#include "render/change_surfaces.hpp"
#include "render/render.hpp"
#include "scene/bounds.hpp"
#include "scene/gltf/write_gltf.hpp"
#include "shade/features.hpp"
#include "tools/bake/dilate.hpp"
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

/// Texels around charts that get their neighbours' light: a copy of a sixteenth of the size is clean, too.
constexpr int kSeamTexels = 16;
/// Texels may belong to two triangles where charts touch. Beyond this share of them charts lie on each other.
constexpr double kMostOverlap = 0.01;

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

/// A camera that sees all of the object: from the eye, or parallel from outside of it.
Camera bakeCamera(const Scene& scene, std::uint32_t object, const std::vector<double>& eye) {
  const Bounds box = objectBounds(scene, scene.objects[object]);
  Camera camera;
  if (!eye.empty()) {
    camera.camera_to_world[3] = glm::dvec4(eye[0], eye[1], eye[2], 1);
    return camera;
  }
  const double radius = std::max(0.5 * glm::length(box.high - box.low), 1e-6);
  const glm::dvec3 middle = 0.5 * (box.low + box.high);
  camera.orthographic = true;
  camera.half_height = radius;
  camera.near = radius;
  camera.far = 3 * radius;
  camera.camera_to_world[3] = glm::dvec4(middle + glm::dvec3(0, 0, 2 * radius), 1);
  return camera;
}

/// Takes from surfaces what depends on where they are seen from, or what colour they are.
void keepLightOnly(const BakeOptions& options, GBuffer& gbuffer) {
  if (options.eye.empty()) std::fill(gbuffer.specular.begin(), gbuffer.specular.end(), 0.0f);
  if (!options.irradiance) return;
  for (Plane* color : {&gbuffer.diffuse, &gbuffer.ambient}) std::fill(color->begin(), color->end(), 1.0f);
  std::fill(gbuffer.emission.begin(), gbuffer.emission.end(), 0.0f);
}

std::vector<std::uint8_t> shownTexels(const GBuffer& gbuffer) {
  std::vector<std::uint8_t> shows(std::size_t(gbuffer.width) * gbuffer.height);
  for (int y = 0; y < gbuffer.height; ++y)
    for (int x = 0; x < gbuffer.width; ++x)
      shows[std::size_t(y) * gbuffer.width + x] =
          std::isfinite(gbuffer.position[gbuffer.index(x, y) + 2 * gbuffer.pixels()]);
  return shows;
}

/// Throws InputError where charts lie on each other; tells of texels where they touch.
void checkOverlap(const BakeOptions& options, const TextureSpace& space) {
  const std::string some = fmt::format("{} of {} texels of {} lie in more than one triangle",
                                       space.overlapping, space.covered, options.object);
  if (double(space.overlapping) > kMostOverlap * double(space.covered))
    throw InputError(some +
                     ": its charts overlap, expected texture coordinates of which no two places share one");
  if (space.overlapping > 0 && !options.quiet) reportWarning(some);
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
  if (!options.eye.empty() && options.value("shadows") == "auto") options.settings["shadows"] = "exact";
  checkOptions(options);
  Stats stats;
  stats.command = context.command_line;
  startDevice(options.device, context.device);
  Scene scene = timed(stats, Stage::kLoadScene, [&] { return openLitScene(options.scene, frame, options); });
  scene.fog = {};
  scene.background = glm::vec3(0.0f);
  RenderSettings settings = renderSettings(options, scene);
  if (wantsSurfaceIds(settings))
    throw InputError("--aov: a map shows one object; render makes object_id, material_id and cryptomatte");
  const std::uint32_t object = objectNamed(scene, options.object);
  settings.camera = bakeCamera(scene, object, options.eye);
  logEvent("frame_begun", {{"frame", frame}});
  const SurfaceTraits traits = materialTraits(scene);
  const SurfaceProgram program = surfaceProgram(settings.surfaces);
  settings.surfaces.clear();  // they come before what is kept of the light
  TextureSpace space = timed(stats, Stage::kRasterize, [&] {
    PlaneSet planes{.specular = true,
                    .ambient = true,
                    .emission = true,
                    .geometric_normal = !traits.normal_maps,
                    .unbent_normal = traits.normal_maps,
                    .lift = hasBentCorners(scene),
                    .model = traits.models.to_ulong() > 1};
    addGroups(program, planes);
    return rasterizeTextureSpace(scene, object, settings.size, settings.camera, planes);
  });
  checkOverlap(options, space);
  prepareForSurfaces(program, space.gbuffer);
  changeSurfaces(context.device, program, space.gbuffer, stats);
  keepLightOnly(options, space.gbuffer);
  ProgressLine progress(options.quiet);
  settings.on_long_compile = compileReporter(progress);
  Image map = shadeGBuffer(context.device, scene, space.gbuffer, settings, stats);
  progress.clear();
  logDevice(context.device.description);
  timed(stats, Stage::kResolve, [&] {
    if (!options.isOn("alpha")) dilate(map, shownTexels(space.gbuffer), kSeamTexels);
  });
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
                      writeOptions(options, space.gbuffer));
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
