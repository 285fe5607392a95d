#include "tools/cli/picture_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <utility>

#include "base/split.hpp"
#include "base/text_file.hpp"
#include "base/threads.hpp"
#include "luciole/error.hpp"
#include "luciole/load_scene.hpp"
#include "raster/blend.hpp"
#include "raster/coarse_triangles.hpp"
#include "scene/json/mesh_file.hpp"
#include "scene/models.hpp"
#include "shaders/shader_text.hpp"
#include "tools/cli/cameras.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/frames.hpp"
#include "tools/cli/suggest.hpp"
#include "tools/cli/trace_option.hpp"

namespace luciole {
namespace {

/// Accepts stops, and "auto" if the command measures exposures.
CLI::Validator exposureCheck(bool or_auto) {
  return {[or_auto](std::string& text) {
            if (text == "auto" && !or_auto) return std::string("expected stops, got auto");
            return settingFault(namedSetting("exposure"), text);
          },
          ""};
}

}  // namespace

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

CLI::Option* addSetting(CLI::App& command, PictureOptions& options, const char* name) {
  const NamedSetting& setting = namedSetting(name);
  std::string& value = options.settings[name];
  std::string typed = "--" + std::string(name);
  std::replace(typed.begin(), typed.end(), '_', '-');
  if (setting.is_flag)
    return command.add_flag_function(
        typed, [&value](std::int64_t) { value = "on"; }, setting.help);
  CLI::Option* const option = command.add_option(typed, value, setting.help);
  if (!setting.choices.empty() && !setting.is_list)
    option->check(oneOf(setting.choices));
  else if (!setting.is_list)
    option->check(CLI::Validator([&setting](std::string& text) { return settingFault(setting, text); }, ""));
  if (setting.least < setting.greatest)
    option->type_name(
        fmt::format("{} in [{} - {}]", setting.is_whole ? "INT" : "FLOAT", setting.least, setting.greatest));
  if (!setting.initial.empty()) option->default_str(setting.initial);
  return option;
}

const std::string& PictureOptions::value(std::string_view name) const { return settings.find(name)->second; }

bool PictureOptions::isOn(std::string_view name) const { return value(name) == "on"; }

CLI::Option* addModelOption(CLI::App& command, PictureOptions& options) {
  return command.add_option("--model", options.model, namedSetting("model").help)
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
  const auto add = [&](const char* name) { return addSetting(command, options, name); };
  if (is_one_picture) {
    command.add_option("-o,--output", options.output, "the file to write (- : PNG on standard output)")
        ->required();
    add("format");
    add("compression");
  }
  if (groups & kViewOptions) {
    add("size");
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
    if (is_one_picture) add("crop");
    add("shading");
  }
  if (groups & kSampleOption) add("samples");
  if ((groups & kSampleOption) && (groups & kShadeOptions)) add("samples_shading");
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
      for (const char* name : {"dither", "tone", "bits", "half"}) add(name);
      if (groups & kModelOptions) add("alpha");
    }
  }
  if (is_one_picture && (groups & kShadeOptions))
    command.add_flag("--hash", options.hash,
                     "print the SHA-256 of the picture's linear colours, 32-bit floats before they are made "
                     "into a file, and "
                     "the file's name, a line a picture: equal hashes, equal bits");
  if (groups & kShadeOptions) {
    add("culling");
    add("tile");
    add("shadows")->each([&options](const std::string& method) { options.typed_shadows = method; });
    for (const char* name : {"soft_samples", "pcf_width", "shadow_memory", "shadow_size"}) add(name);
    CLI::Option* const absolute = add("light_error");
    add("light_error_relative")->excludes(absolute);
    add("confidence");
    if (is_one_picture)
      for (const char* name : {"seed", "light_groups", "aov"}) add(name);
  }
  if (groups & kCastOption) {
    add("cast_shadows");
    add("light_count");
  }
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
      .add_option("--environment", settings.environment,
                  "a picture of the sky, by latitude and longitude or a cross of cube faces: the background, "
                  "and lights in place of it, with shadows; instead of the scene's own")
      ->type_name("FILE");
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
  if (!settings.environment.empty()) words.insert(words.end(), {"--environment", settings.environment});
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
  const bool asked_for = !options.typed_shadows.empty() && options.typed_shadows != "off";
  castShadows(options.value("cast_shadows"), asked_for, scene);
  if (asked_for &&
      std::none_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) { return light.shadow; }))
    scene.warnings.push_back(
        {fmt::format("{}: --shadows {}: no light casts shadows", scene.name, options.typed_shadows),
         "no shadows"});
}

Scene openScene(const std::string& path, double frame, const PictureOptions& options) {
  LoadSettings load = options.load;
  for (const Shader& shader : surfacesOf(options))
    load.tangents |= shaderFacts(shader, ShaderKind::kSurface).uses_tangents;
  Scene scene;
  if (options.model.ends_with(kShaderExtension))
    load.tangents |= usesTangents(std::vector{readShader(options.model, ShaderKind::kModel)});
  if (options.value("light_count") == "auto" && !options.chooses_lights)
    throw InputError("--light-count auto: only render chooses, expected a number");
  const double milliseconds = millisecondsOf([&] { scene = loadScene(path, frame, load); });
  logEvent("loaded", {{"scene", path},
                      {"objects", scene.objects.size()},
                      {"lights", scene.lights.size()},
                      {"milliseconds", eventMilliseconds(milliseconds)}});
  takeModel(options, scene);
  warnOfLooseArithmetic(options, scene);
  setLightCounts(options.value("light_count"), scene);
  castShadows(options, scene);
  if (!options.quiet) reportWarnings(scene.warnings);
  return scene;
}

Scene openLitScene(const std::string& path, double frame, const PictureOptions& options) {
  Scene scene = openScene(path, frame, options);
  const double width = options.value("shading") == "gouraud" ? coarseTriangleWidth(scene) : 0;
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
  if (options.value("samples") != "1") return;
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

/// The error of a setting by its option.
[[noreturn]] static void failAsOption(const InputError& error) {
  std::string message = error.what();
  std::replace(message.begin(), message.begin() + std::ptrdiff_t(message.find(':')), '_', '-');
  throw InputError("--" + message);
}

std::vector<Aov> aovsOf(const PictureOptions& options) {
  RenderSettings settings;
  try {
    applySettings({{"aov", options.value("aov")}}, settings);
  } catch (const InputError& error) {
    failAsOption(error);
  }
  return settings.aovs;
}

float exposureOf(const PictureOptions& options) {
  RenderSettings settings;
  applySettings({{"exposure", options.exposure}}, settings);
  return settings.exposure;
}

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
  try {
    applySettings(options.settings, settings);
  } catch (const InputError& error) {
    failAsOption(error);
  }
  const bool is_chosen = options.camera_index >= 0;
  settings.camera =
      scene.cameras[is_chosen ? std::size_t(options.camera_index) : findCamera(scene, options.camera)];
  settings.shade.model = modelOf(options, scene);
  settings.surfaces = surfacesOf(options);
  for (const std::string& path : options.screens)
    settings.screens.push_back(readShader(path, ShaderKind::kScreen));
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
