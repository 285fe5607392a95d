#include "tools/cli/picture_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/text_file.hpp"
#include "base/threads.hpp"
#include "image/exposure.hpp"
#include "image/file_format.hpp"
#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "raster/blend.hpp"
#include "raster/coarse_triangles.hpp"
#include "render/aov_table.hpp"
#include "scene/json/json_scene.hpp"
#include "scene/json/mesh_file.hpp"
#include "scene/models.hpp"
#include "shaders/shader_text.hpp"
#include "shadow/exact/light_samples.hpp"
#include "shadow/maps/shadow_sizes.hpp"
#include "tools/cli/cameras.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/frames.hpp"
#include "tools/cli/suggest.hpp"
#include "tools/cli/trace_option.hpp"

namespace luciole {
namespace {

/// What --aov names, in the order of its help; a name may stand for several layers.
std::vector<std::pair<std::string, Aov>> namedAovs() {
  std::vector<std::pair<std::string, Aov>> named;
  for (const AovRow& row : aovTable()) {
    if (row.aov == Aov::kCryptoObject)
      for (const Aov matte : {Aov::kCryptoObject, Aov::kCryptoMaterial})
        named.emplace_back("cryptomatte", matte);
    named.emplace_back(row.name, row.aov);
  }
  return named;
}

/// All names of namedAovs(), with this between them.
std::string aovNames(const char* separator) {
  std::vector<std::string> names;
  for (const auto& [name, aov] : namedAovs())
    if (names.empty() || names.back() != name) names.push_back(name);
  return fmt::format("{}", fmt::join(names, separator));
}

std::vector<std::string> compressionNames() {
  std::vector<std::string> names(kPngCompressions.begin(), kPngCompressions.end());
  for (const ExrCompression& one : kExrCompressions) names.push_back(one.name);
  return names;
}

/// The stops that --exposure names. Nothing for another text.
std::optional<double> exposureStops(const std::string& text) {
  const char* start = text.c_str() + (text.starts_with("+") ? 1 : 0);
  const char* const text_end = text.c_str() + text.size();
  double stops = 0;
  const auto [end, error] = std::from_chars(start, text_end, stops);
  if (error != std::errc() || end != text_end || !(std::abs(stops) <= kMostStops)) return std::nullopt;
  return stops;
}

/// The values of which --light-error-relative is a share are at least this. Nabata and others (2016) judge
/// their errors so.
constexpr float kRelativeFloor = 0.05f;

/// The share from 0 to 1 that a text names: a number, or a fraction such as 1/256. Nothing for another text.
std::optional<float> typedShare(const std::string& text) {
  const char* const text_end = text.c_str() + text.size();
  double over = 0, under = 1;
  auto [end, error] = std::from_chars(text.c_str(), text_end, over);
  if (error == std::errc() && end != text_end && *end == '/') {
    const auto below = std::from_chars(end + 1, text_end, under);
    end = below.ptr;
    error = below.ec;
  }
  const double share = over / under;
  if (error != std::errc() || end != text_end || !(under > 0) || !std::isfinite(under) ||
      !(share >= 0 && share <= 1))
    return std::nullopt;
  return float(share);
}

/// Accepts stops, and "auto" if the command measures exposures.
CLI::Validator exposureCheck(bool or_auto) {
  return {[or_auto](std::string& text) {
            if ((or_auto && text == "auto") || exposureStops(text)) return std::string();
            return fmt::format("expected stops between {} and {}{}, got {}", -kMostStops, kMostStops,
                               or_auto ? ", or auto" : "", text);
          },
          ""};
}

/// What --size says: "WxH", or "W" for a picture of the same shape as the scene's own.
glm::ivec2 typedSize(const std::string& text, const glm::ivec2& scene_size) {
  const bool has_height = text.find('x') != std::string::npos;
  const std::vector<int> sides =
      parseInts(text, 'x', has_height ? 2 : 1, "--size", "WxH or W, such as 1280x720 or 1280");
  glm::ivec2 size(sides.front(), sides.back());
  if (!has_height) {
    const double height = std::round(double(size.x) * scene_size.y / scene_size.x);
    size.y = int(std::clamp(height, 1.0, double(std::numeric_limits<int>::max())));
  }
  checkPictureSize(size, "--size");
  return size;
}

}  // namespace

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::vector<int> parseInts(const std::string& text, char separator, std::size_t count,
                           const std::string& option, const std::string& expected) {
  std::vector<int> numbers;
  for (const std::string& part : split(text, separator)) {
    int number = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), number);
    if (error != std::errc() || end != part.data() + part.size()) break;
    numbers.push_back(number);
  }
  if (numbers.size() != count || split(text, separator).size() != count)
    throw InputError(fmt::format("{} {}: expected {}", option, text, expected));
  return numbers;
}

CLI::Option* addModelOption(CLI::App& command, PictureOptions& options) {
  return command
      .add_option(
          "--model", options.model,
          "how surfaces reflect light whose materials don't say it: with highlights of (R.V)^n, of "
          "(N.H)^n, in flat steps, as rough ones do, as rough matte ones do, or as rough ones by Ward's "
          "lobe; or a file of one's own, *.clh")
      ->check([](const std::string& model) {
        return model.ends_with(kShaderExtension) ? std::string()
                                                 : oneOf({kModelNames.begin(), kModelNames.end()})(model);
      })
      ->capture_default_str();
}

void addScreenOption(CLI::App& command, PictureOptions& options) {
  command
      .add_option("--screen", options.screens,
                  "FILE.clh: a function of one's own that changes the lit colours by what is around each "
                  "pixel, as for contours and hatching; several go one after another")
      ->allow_extra_args(false);
}

void addSurfaceOption(CLI::App& command, PictureOptions& options) {
  command
      .add_option("--surface", options.surfaces,
                  "a file of one's own, *.clh, whose function changes the materials or normals of surfaces "
                  "before they are lit; may stand several times, one after another")
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void addPictureOptions(CLI::App& command, PictureOptions& options, unsigned groups) {
  const bool is_one_picture = !(groups & kManyPictures);
  if (is_one_picture)
    command.add_option("-o,--output", options.output, "the file to write (- : PNG on standard output)")
        ->required();
  if (is_one_picture)
    command.add_option("--format", options.format,
                       "png, exr ...: what to write, whatever the name says (default: its extension)");
  if (is_one_picture)
    command
        .add_option(
            "--compression", options.compression,
            fmt::format("of a PNG: fast (default) or small; the others of an EXR (default: {}); from pxr24 "
                        "on they change the picture",
                        kExrCompression))
        ->check(oneOf(compressionNames()));
  if (groups & kViewOptions) {
    command.add_option("--size", options.size,
                       "WxH pixels, or W, as high as the scene's shape makes it (default: the scene's, or "
                       "1280x720)");
    command.add_option(
        "--camera", options.camera,
        is_one_picture
            ? "one of the scene's cameras, by name or index, or all: a picture of each; {camera} in "
              "the output's name becomes the camera's"
            : "one of the scene's cameras, by name or index");
    command.add_option("--variant", options.load.choice.variant,
                       "one of a glTF file's variants of materials, by name (info lists them)");
    command.add_option("--animation", options.load.choice.animation,
                       "the only one of a glTF file's animations that runs, by name or index (default: all "
                       "together; info lists them)");
    if (is_one_picture) command.add_option("--crop", options.crop, "X,Y,W,H: only this part of the picture");
    command
        .add_option("--shading", options.shading,
                    "what is interpolated over a triangle: nothing, colours, normals")
        ->check(oneOf({"flat", "gouraud", "phong"}))
        ->capture_default_str();
  }
  if (groups & kSampleOption)
    command.add_option("--samples", options.samples, "samples per pixel, against jagged edges")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
  if ((groups & kSampleOption) && (groups & kShadeOptions))
    command
        .add_option(
            "--samples-shading", options.samples_shading,
            "what of a pixel's samples is shaded: a point for those that see the same surface, or all")
        ->check(oneOf({"shared", "all"}))
        ->capture_default_str();
  if (groups & kModelOptions) addModelOption(command, options);
  if (groups & kModelOptions) addSurfaceOption(command, options);
  if (groups & (kModelOptions | kColorOptions)) {
    if (is_one_picture && (groups & kModelOptions))
      command
          .add_option("--exposure", options.exposure,
                      "stops: colours times 2^STOPS; or auto: what brings the picture's mean to middle grey, "
                      "measured in the first of --frames (default: 0, but auto for an .obj, .gltf or .glb "
                      "made into integers)")
          ->check(exposureCheck(true));
    else
      command.add_option("--exposure", options.exposure, "stops: colours times 2^STOPS")
          ->check(exposureCheck(false))
          ->default_str("0");
    if (is_one_picture) {
      command
          .add_option("--dither", options.dither,
                      "of 8-bit formats (png, jpg ...): a grain of half a step in place of bands")
          ->check(oneOf({"on", "off"}))
          ->capture_default_str();
      command
          .add_option("--tone", options.tone,
                      "of integer formats: what is brighter than white is clipped, or goes through a film's "
                      "curve (Narkowicz's, of the ACES)")
          ->check(oneOf({"clip", "filmic"}))
          ->capture_default_str();
      command
          .add_option("--bits", options.bits,
                      "of the sRGB codes of a png (default: 8) or tif (default: 32-bit floats): 8 or 16")
          ->check(CLI::IsMember({8, 16}));
      command.add_flag("--half", options.half,
                       "an EXR's colours as 16-bit floats: half the size, each within 2^-11 of itself or, if "
                       "below 2^-14, within 2^-25; at most 65504; positions, depths and counts keep 32 bits");
      if (groups & kModelOptions)
        command.add_flag(
            "--alpha", options.alpha,
            "no background, and a channel A: the share of a pixel's samples that show a surface; "
            "colours are multiplied by it in exr and in a tif of floats, not in png, tga and others");
    }
  }
  if (is_one_picture && (groups & kShadeOptions))
    command.add_flag("--hash", options.hash,
                     "print the SHA-256 of the picture's linear colours, 32-bit floats before they are made "
                     "into a file, and "
                     "the file's name, a line a picture: equal hashes, equal bits");
  if (groups & kShadeOptions) {
    command
        .add_option("--culling", options.culling,
                    "which lights a pixel goes through; never changes the picture")
        ->check(oneOf({"none", "tiles", "auto"}))
        ->capture_default_str();
    command
        .add_option("--tile", options.tile,
                    "pixels a side of the squares that share a light list; never changes the picture")
        ->check(CLI::IsMember({4, 8, 16}))
        ->capture_default_str();
    addShadowsOption(
        command, options,
        "exact (as rays to the light's middle), soft-exact (as rays to places on a light of a size), by "
        "shadow maps: hard (the texel that the point falls into), pcf (the nearest texels, weighted) or soft "
        "(edges as wide as the light's size makes them), or auto: for each light exact, but hard where that "
        "is at least twice as fast",
        {"auto", "off", "hard", "pcf", "soft", "exact", "soft-exact"});
    command
        .add_option("--soft-samples", options.soft_samples,
                    "places on a light of a size that soft-exact looks at from each point")
        ->check(CLI::Range(1, kMostSoftSamples))
        ->capture_default_str();
    command.add_option("--pcf-width", options.pcf_width, "texels a side that pcf weighs: 2 is the sharpest")
        ->check(CLI::Range(2, 6))
        ->capture_default_str();
    command
        .add_option("--shadow-memory", options.shadow_memory,
                    "MiB that all shadow maps may take: where they would take more, they get coarser")
        ->check(CLI::Range(1, 16000))  // fewer texels than 31 bits count
        ->capture_default_str();
    command
        .add_option("--shadow-size", options.shadow_size,
                    "texels a side that the shadow map of a spot and each of a directional light may have; "
                    "half as many for each face of a point light's")
        ->check(CLI::Range(kSmallestFace, kLargestFace))
        ->capture_default_str();
    const CLI::Validator is_share(
        [](std::string& text) {
          return typedShare(text)
                     ? std::string()
                     : fmt::format("expected a number or a fraction from 0 to 1, such as 1/256, got {}",
                                   text);
        },
        "");
    CLI::Option* const absolute =
        command
            .add_option_function<std::string>(
                "--light-error",
                [&options](const std::string& text) { options.light_error = *typedShare(text); },
                "lights without range may be stood for by clusters of them, and where they cast shadows be "
                "sampled, as long as no pixel is wrong by more than so much of the larger of 1 and itself: "
                "from "
                "0 (each light by itself) to 1, such as 1/256")
            ->check(is_share)
            ->default_str("0");
    command
        .add_option_function<std::string>(
            "--light-error-relative",
            [&options](const std::string& text) { options.light_error_relative = *typedShare(text); },
            fmt::format("as --light-error, but so much of the larger of {} and the pixel itself",
                        kRelativeFloor))
        ->check(is_share)
        ->default_str("0")
        ->excludes(absolute);
    command
        .add_option("--confidence", options.confidence,
                    "with an error of lights that cast shadows: how often the interval that a pixel states "
                    "holds, 0.5 to 0.9999")
        ->check(CLI::Range(0.5, 0.9999))
        ->capture_default_str();
    if (is_one_picture) {
      command.add_option("--seed", options.seed, "of lights that are sampled: each gives other errors")
          ->capture_default_str();
      command.add_flag(
          "--light-groups", options.light_groups,
          "extra layers of an EXR, whose sum is the picture: light_groups.NAME of the lights of each "
          "group, light_groups.rest of all that no light gives; luciole mix weighs them anew");
      command.add_option("--aov", options.aovs, "extra layers of an EXR: " + aovNames(","));
    }
  }
  if (groups & kCastOption) addCastShadowsOption(command, options);
  if (!(groups & kColorOptions)) addLoadOptions(command, options.load);
  if (groups & kFrameOption)
    command.add_option(
        "--frames", options.frames,
        "which frame of a scene that moves (default: 1); # in the output's name become its number");
  if (groups & kExactOption)
    command.add_flag("--require-exact", options.require_exact,
                     "make no picture on a device whose arithmetic differs from that of all others, which "
                     "otherwise is a warning");
  if (groups & kDeviceOption)
    command.add_option(
        "--device", options.device,
        is_one_picture && (groups & kSampleOption)
            ? "an index or part of a name from luciole devices, or all: each makes some of the "
              "rows, [,lanes=1|4|8|16]"
            : "an index or part of a name from luciole devices, [,lanes=1|4|8|16]");
  if (is_one_picture && !(groups & kColorOptions)) {
    command.add_option(
        "--stats", options.stats,
        "write what the picture cost as JSON (- : standard output), or by a name .csv as a line of names "
        "and one of values");
    addTraceOption(command, options.trace);
  }
  addThreadsOption(command);
  CLI::Option* quiet = command.add_flag("--quiet", options.quiet, "say nothing but errors");
  if (is_one_picture) addLogOption(command)->excludes(quiet);
}

CLI::Option* addShadowsOption(CLI::App& command, PictureOptions& options, const std::string& help,
                              const std::vector<std::string>& values) {
  return command.add_option("--shadows", options.shadows, help)
      ->check(oneOf(values))
      ->each([&options](const std::string&) { options.shadows_given = true; })
      ->capture_default_str();
}

void addCastShadowsOption(CLI::App& command, PictureOptions& options) {
  command
      .add_option(
          "--cast-shadows", options.cast_shadows,
          "which lights cast shadows: all, none, or those that the scene's file marks (default: marked, "
          "but all where none is marked and --shadows is given)")
      ->check(oneOf({"all", "marked", "none"}));
}

void addLoadOptions(CLI::App& command, LoadSettings& settings) {
  command
      .add_option_function<std::string>(
          "--missing-textures",
          [&settings](const std::string& value) {
            settings.missing = value == "warn" ? MissingTextures::kWarn : MissingTextures::kError;
          },
          "a picture that the scene names and that isn't there is an error, or a warning and its "
          "materials are drawn without it")
      ->check(oneOf({"error", "warn"}))
      ->default_str("error");
  command.add_flag(
      "--strict", settings.strict,
      "refuse a file that breaks its format's rules, instead of taking what viewers take and a warning");
  command
      .add_option(
          "--search", settings.search,
          "a folder in which files are looked for that aren't where the scene says; may stand several times")
      ->expected(1)
      ->take_all()
      ->type_name("FOLDER");
  command
      .add_option(
          "--set", settings.changes,
          "a place of the scene's file and its new value, as JSON or text, such as "
          "materials.box.shininess=4, camera.fov_y=30 or 'lights[0].color=[1,0,0]'; of an .obj, .gltf or "
          ".glb its materials, lights, ambient, background, fog and lighting; may stand several times")
      ->expected(1)
      ->take_all()
      ->type_name("PATH=VALUE");
}

std::vector<std::string> typedLoadOptions(const LoadSettings& settings) {
  std::vector<std::string> words{"--missing-textures",
                                 settings.missing == MissingTextures::kWarn ? "warn" : "error"};
  if (settings.strict) words.push_back("--strict");
  for (const std::string& folder : settings.search) words.insert(words.end(), {"--search", folder});
  for (const std::string& change : settings.changes) words.insert(words.end(), {"--set", change});
  return words;
}

void addThreadsOption(CLI::App& command) {
  command
      .add_option_function<int>(
          "--threads", [](int count) { limitThreads(count); },
          "how many the host may use, and as many a device that is a CPU; never changes a result (default: "
          "the machine's)")
      ->check(CLI::Range(1, 1024));
}

/// Of all shaders, in Scene::warnings. Throws InputError with --require-exact.
static void warnOfLooseArithmetic(const PictureOptions& options, Scene& scene) {
  std::vector<std::string> loose;
  const auto add = [&](const Shader& shader, ShaderKind kind) {
    for (std::string& place : shaderFacts(shader, kind).loose) loose.push_back(std::move(place));
  };
  for (const Shader& model : scene.user_models) add(model, ShaderKind::kModel);
  for (const Shader& surface : surfacesOf(options)) add(surface, ShaderKind::kSurface);
  for (const std::string& screen : options.screens)
    add(readShader(screen, ShaderKind::kScreen), ShaderKind::kScreen);
  if (options.require_exact && !loose.empty()) throw InputError("--require-exact: " + loose.front());
  for (const std::string& place : loose) scene.warnings.push_back({place, kLooseArithmetic});
}

void castShadows(const PictureOptions& options, Scene& scene) {
  const auto casts = [](const Light& light) { return light.shadow; };
  const bool asked_for = options.shadows_given && options.shadows != "off";
  const bool any_marked = std::any_of(scene.lights.begin(), scene.lights.end(), casts);
  const bool all = options.cast_shadows.empty() ? asked_for && !any_marked : options.cast_shadows == "all";
  if (all || options.cast_shadows == "none")
    for (Light& light : scene.lights) light.shadow = all;
  if (asked_for && std::none_of(scene.lights.begin(), scene.lights.end(), casts))
    scene.warnings.push_back(
        {fmt::format("{}: --shadows {}: no light casts shadows", scene.name, options.shadows), "no shadows"});
}

Scene openScene(const std::string& path, double frame, const PictureOptions& options) {
  LoadSettings load = options.load;
  for (const Shader& shader : surfacesOf(options))
    load.tangents |= shaderFacts(shader, ShaderKind::kSurface).uses_tangents;
  Scene scene;
  if (options.model.ends_with(kShaderExtension))
    load.tangents |= usesTangents(std::vector{readShader(options.model, ShaderKind::kModel)});
  const double milliseconds = millisecondsOf([&] { scene = loadScene(path, frame, load); });
  logEvent("loaded", {{"scene", path},
                      {"objects", scene.objects.size()},
                      {"lights", scene.lights.size()},
                      {"milliseconds", eventMilliseconds(milliseconds)}});
  takeModel(options, scene);
  warnOfLooseArithmetic(options, scene);
  castShadows(options, scene);
  if (!options.quiet) reportWarnings(scene.warnings);
  return scene;
}

Scene openLitScene(const std::string& path, double frame, const PictureOptions& options) {
  Scene scene = openScene(path, frame, options);
  const double width = options.shading == "gouraud" ? coarseTriangleWidth(scene) : 0;
  if (width == 0) return scene;
  scene.warnings.push_back(
      {fmt::format(
           "{}: --shading gouraud lights the corners of triangles, and some are up to {:.3g} m wide: light "
           "that falls between their corners is lost; divide them, or take --shading phong",
           scene.name, width),
       "gouraud"});
  if (!options.quiet) reportWarning(scene.warnings.back().text);
  return scene;
}

void warnOfDither(Scene& scene, const PictureOptions& options) {
  if (options.samples > 1) return;
  const std::vector<std::uint32_t> materials = blendedMaterials(scene);
  if (materials.empty()) return;
  const std::string& name = scene.materials[materials.front()].name;
  const std::string what = name.empty() ? fmt::format("materials[{}]", materials.front())
                                        : fmt::format("material '{}'", forMessage(name));
  const std::string others = materials.size() > 1 ? fmt::format(" and {} more", materials.size() - 1) : "";
  scene.warnings.push_back(
      {fmt::format("{}: {}{}: blended by dithering, one sample a pixel; more --samples smooth it", scene.name,
                   what, others),
       "dithered"});
  if (!options.quiet) reportWarning(scene.warnings.back().text);
}

std::vector<Aov> aovsOf(const PictureOptions& options) {
  std::vector<Aov> aovs;
  if (options.aovs.empty()) return aovs;
  for (const std::string& name : split(options.aovs, ',')) {
    bool is_known = false;
    for (const auto& [known, aov] : namedAovs()) {
      if (known != name) continue;
      is_known = true;
      if (std::find(aovs.begin(), aovs.end(), aov) == aovs.end()) aovs.push_back(aov);
    }
    if (is_known) continue;
    std::vector<std::string> names;
    for (const auto& [known, aov] : namedAovs()) names.push_back(known);
    throw InputError(
        fmt::format("--aov: '{}' is none of {}{}", name, aovNames(", "), didYouMean(name, names)));
  }
  return aovs;
}

float exposureOf(const PictureOptions& options) { return float(exposureStops(options.exposure).value_or(0)); }

std::vector<Shader> surfacesOf(const PictureOptions& options) {
  std::vector<Shader> surfaces;
  for (const std::string& path : options.surfaces) surfaces.push_back(readShader(path, ShaderKind::kSurface));
  return surfaces;
}

void takeModel(const PictureOptions& options, Scene& scene) {
  if (options.model.ends_with(kShaderExtension)) addUserModel(options.model, scene);
  if (takesFacets(modelOf(options, scene))) takeFacets(scene);
}

Model modelOf(const PictureOptions& options, const Scene& scene) {
  for (std::size_t i = 0; i < scene.user_models.size(); ++i)
    if (scene.user_models[i].path == options.model) return userModel(i);
  std::size_t model = 0;  // one of them it is: the option's check lets no other name through
  while (model + 1 < kModelNames.size() && options.model != kModelNames[model]) ++model;
  return kAllModels[model];
}

RenderSettings renderSettings(const PictureOptions& options, const Scene& scene) {
  RenderSettings settings;
  if (scene.size) settings.size = *scene.size;
  if (!options.size.empty()) settings.size = typedSize(options.size, settings.size);
  const bool is_chosen = options.camera_index >= 0;
  settings.camera =
      scene.cameras[is_chosen ? std::size_t(options.camera_index) : findCamera(scene, options.camera)];
  if (!options.crop.empty()) {
    const std::vector<int> crop = parseInts(options.crop, ',', 4, "--crop", "X,Y,W,H, such as 0,0,64,64");
    settings.crop = Crop{crop[0], crop[1], crop[2], crop[3]};
  }
  settings.alpha = options.alpha;
  settings.samples = options.samples;
  settings.sample_shading = options.samples_shading == "all" ? SampleShading::kAll : SampleShading::kShared;
  settings.shading = options.shading == "flat"      ? Shading::kFlat
                     : options.shading == "gouraud" ? Shading::kGouraud
                                                    : Shading::kPhong;
  settings.shade.model = modelOf(options, scene);
  settings.surfaces = surfacesOf(options);
  settings.shade.culling = options.culling == "none" ? Culling::kNone : Culling::kTiles;
  settings.shade.tile_size = options.tile;
  settings.shade.shadows = options.shadows == "off"          ? ShadowMethod::kOff
                           : options.shadows == "hard"       ? ShadowMethod::kHard
                           : options.shadows == "pcf"        ? ShadowMethod::kPcf
                           : options.shadows == "soft"       ? ShadowMethod::kSoft
                           : options.shadows == "exact"      ? ShadowMethod::kExact
                           : options.shadows == "soft-exact" ? ShadowMethod::kSoftExact
                                                             : ShadowMethod::kAuto;
  settings.shade.soft_samples = options.soft_samples;
  settings.shade.light_error = options.light_error;
  if (options.light_error_relative > 0) {
    settings.shade.light_error = options.light_error_relative;
    settings.shade.light_error_floor = kRelativeFloor;
  }
  settings.shade.confidence = options.confidence;
  settings.shade.seed = options.seed;
  settings.shade.pcf_width = options.pcf_width;
  settings.shade.shadow_limits.bytes = std::size_t(options.shadow_memory) << 20;
  settings.shade.shadow_limits.size = options.shadow_size;
  for (const std::string& path : options.screens)
    settings.screens.push_back(readShader(path, ShaderKind::kScreen));
  settings.aovs = aovsOf(options);
  settings.light_groups = options.light_groups;
  settings.exposure = exposureOf(options);
  settings.count_lights = !options.stats.empty();
  return settings;
}

int useFrame(PictureOptions& options, const std::string& command) {
  const int frame = chosenFrame(options.frames, command);
  if (options.frames.empty()) return frame;
  options.output = frameFile(options.output, frame);
  options.stats = frameFile(options.stats, frame);
  return frame;
}

std::vector<PictureOptions> optionsOfCameras(const PictureOptions& options, const Scene& scene) {
  const std::vector<std::size_t> cameras = chosenCameras(scene, options.camera);
  const std::vector<std::string> outputs = cameraFiles(options.output, scene, cameras, "-o");
  const bool have_stats = !options.stats.empty() && options.stats != "-";
  std::vector<std::string> stats;
  if (have_stats) stats = cameraFiles(options.stats, scene, cameras, "--stats");
  std::vector<PictureOptions> all(cameras.size(), options);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].camera_index = int(cameras[i]);
    all[i].output = outputs[i];
    if (have_stats) all[i].stats = stats[i];
  }
  return all;
}

}  // namespace luciole
