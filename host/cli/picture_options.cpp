#include "cli/picture_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>

#include "cli/frames.hpp"
#include "error.hpp"
#include "image/write_file.hpp"
#include "scene/json_scene.hpp"

namespace luciole {
namespace {

const std::map<std::string, Aov> kAovs{
    {"position", Aov::kPosition},      {"normal", Aov::kNormal},     {"depth", Aov::kDepth},
    {"diffuse", Aov::kDiffuse},        {"material", Aov::kMaterial}, {"light_count", Aov::kLightCount},
    {"list_length", Aov::kListLength}, {"shadow", Aov::kShadow}};

std::vector<Aov> parseAovs(const std::string& text) {
  std::vector<Aov> aovs;
  if (text.empty()) return aovs;
  for (const std::string& name : split(text, ',')) {
    const auto found = kAovs.find(name);
    if (found == kAovs.end())
      throw InputError(
          fmt::format("--aov: '{}' is none of position, normal, depth, diffuse, material, light_count, "
                      "list_length, shadow",
                      name));
    if (std::find(aovs.begin(), aovs.end(), found->second) == aovs.end()) aovs.push_back(found->second);
  }
  return aovs;
}

const Camera& findCamera(const Scene& scene, const std::string& wanted) {
  if (wanted.empty()) return scene.cameras.front();
  for (const Camera& camera : scene.cameras)
    if (camera.name == wanted) return camera;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
  if (error == std::errc() && end == wanted.data() + wanted.size() && index < scene.cameras.size())
    return scene.cameras[index];
  std::string names;
  for (const Camera& camera : scene.cameras) names += (names.empty() ? "" : ", ") + camera.name;
  throw InputError(
      fmt::format("--camera {}: {} has {} ({}), by name or counted from 0", wanted, scene.name,
                  scene.cameras.size() == 1 ? "one camera" : fmt::format("{} cameras", scene.cameras.size()),
                  names.empty() ? "unnamed" : names));
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

void addPictureOptions(CLI::App& command, PictureOptions& options, unsigned groups) {
  const bool is_one_picture = !(groups & kManyPictures);
  if (is_one_picture)
    command.add_option("-o,--output", options.output, "the file to write (- : PNG on standard output)")
        ->required();
  if (groups & kViewOptions) {
    command.add_option("--size", options.size, "WxH pixels (default: the scene's, or 1280x720)");
    command.add_option("--camera", options.camera, "one of the scene's cameras, by name or index");
    if (is_one_picture) command.add_option("--crop", options.crop, "X,Y,W,H: only this part of the picture");
    command
        .add_option("--shading", options.shading,
                    "what is interpolated over a triangle: nothing, colours, normals")
        ->check(CLI::IsMember({"flat", "gouraud", "phong"}))
        ->capture_default_str();
  }
  if (groups & kSampleOption)
    command.add_option("--samples", options.samples, "samples per pixel, against jagged edges")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
  if (groups & kModelOptions) {
    command
        .add_option(
            "--model", options.model,
            "how surfaces reflect light: with highlights of (R.V)^n, of (N.H)^n, in flat steps, or as "
            "rough ones do")
        ->check(CLI::IsMember(std::vector<std::string>(kModelNames.begin(), kModelNames.end())))
        ->capture_default_str();
    command.add_option("--exposure", options.exposure, "stops: colours times 2^STOPS")->capture_default_str();
  }
  if (groups & kShadeOptions) {
    command
        .add_option("--culling", options.culling,
                    "which lights a pixel goes through; never changes the picture")
        ->check(CLI::IsMember({"none", "tiles", "auto"}))
        ->capture_default_str();
    command
        .add_option("--tile", options.tile,
                    "pixels a side of the squares that share a light list; never changes the picture")
        ->check(CLI::IsMember({4, 8, 16}))
        ->capture_default_str();
    command
        .add_option("--shadows", options.shadows,
                    "how shadow maps are looked up: hard (the texel that the point falls into), pcf (the "
                    "nearest texels, weighted), soft (edges as wide as the light's size makes them) or exact "
                    "(as rays to the light's middle)")
        ->check(CLI::IsMember({"off", "hard", "pcf", "soft", "exact"}))
        ->capture_default_str();
    command.add_option("--pcf-width", options.pcf_width, "texels a side that pcf weighs: 2 is the sharpest")
        ->check(CLI::Range(2, 6))
        ->capture_default_str();
    command
        .add_option("--shadow-memory", options.shadow_memory,
                    "MiB that all shadow maps may take: where they would take more, they get coarser")
        ->check(CLI::Range(1, 16000))  // fewer texels than 31 bits count
        ->capture_default_str();
    if (is_one_picture)
      command.add_option(
          "--aov", options.aovs,
          "extra layers of an EXR: position,normal,depth,diffuse,material,light_count,list_length,shadow");
  }
  if (groups & kFrameOption)
    command.add_option(
        "--frames", options.frames,
        "which frame of a scene that moves (default: 1); # in the output's name become its number");
  if (groups & kDeviceOption)
    command.add_option("--device", options.device,
                       "an index or part of a name from luciole devices, [,lanes=1|4|8|16]");
  if (is_one_picture)
    command.add_option("--stats", options.stats, "write what the picture cost as JSON (- : standard output)");
  command.add_flag("--quiet", options.quiet, "say nothing but errors");
}

Model modelOf(const PictureOptions& options) {
  return *std::find_if(std::begin(kAllModels), std::end(kAllModels),
                       [&](Model model) { return options.model == modelName(model); });
}

RenderSettings renderSettings(const PictureOptions& options, const Scene& scene) {
  RenderSettings settings;
  if (!options.size.empty()) {
    const std::vector<int> size = parseInts(options.size, 'x', 2, "--size", "WxH, such as 1280x720");
    settings.size = {size[0], size[1]};
    checkPictureSize(settings.size, "--size");
  } else if (scene.size) {
    settings.size = *scene.size;
  }
  settings.camera = findCamera(scene, options.camera);
  if (!options.crop.empty()) {
    const std::vector<int> crop = parseInts(options.crop, ',', 4, "--crop", "X,Y,W,H, such as 0,0,64,64");
    settings.crop = Crop{crop[0], crop[1], crop[2], crop[3]};
  }
  settings.samples = options.samples;
  settings.shading = options.shading == "flat"      ? Shading::kFlat
                     : options.shading == "gouraud" ? Shading::kGouraud
                                                    : Shading::kPhong;
  settings.shade.model = modelOf(options);
  settings.shade.culling = options.culling == "none" ? Culling::kNone : Culling::kTiles;
  settings.shade.tile_size = options.tile;
  settings.shade.shadows = options.shadows == "off"    ? ShadowMethod::kOff
                           : options.shadows == "hard" ? ShadowMethod::kHard
                           : options.shadows == "pcf"  ? ShadowMethod::kPcf
                           : options.shadows == "soft" ? ShadowMethod::kSoft
                                                       : ShadowMethod::kExact;
  settings.shade.pcf_width = options.pcf_width;
  settings.shade.shadow_limits.bytes = std::size_t(options.shadow_memory) << 20;
  settings.aovs = parseAovs(options.aovs);
  if (!(std::abs(options.exposure) <= 100))
    throw InputError("--exposure: expected stops between -100 and 100");
  settings.exposure = float(options.exposure);
  settings.count_lights = !options.stats.empty();
  return settings;
}

void checkOutput(const PictureOptions& options) {
  checkWritable(options.output);
  if (!parseAovs(options.aovs).empty() && std::filesystem::path(options.output).extension() != ".exr")
    throw InputError(fmt::format("--aov: {} cannot hold layers, an .exr can", options.output));
  if (!options.stats.empty() && options.stats == options.output)
    throw InputError(fmt::format("--stats {}: is the picture's own file", options.stats));
}

int useFrame(PictureOptions& options, const std::string& command) {
  const int frame = chosenFrame(options.frames, command);
  if (options.frames.empty()) return frame;
  options.output = frameFile(options.output, frame);
  options.stats = frameFile(options.stats, frame);
  return frame;
}

Metadata pictureMetadata(const std::string& command_line, const Device* device) {
  Metadata metadata{{"Software", "Luciole " LUCIOLE_VERSION}, {"ImageDescription", command_line}};
  if (device)
    metadata.emplace_back(
        "luciole:device",
        fmt::format("{}, {}, driver {}, {} lanes", device->description.name, device->description.platform,
                    device->description.version, device->description.lanes));
  return metadata;
}

void reportStats(const PictureOptions& options, const Stats& stats) {
  if (!options.stats.empty()) writeTextFile(options.stats, statsJson(stats));
  if (options.quiet) return;
  // Whole milliseconds that are over, so that the stages' add up to no more than the picture's.
  const auto whole = [](double milliseconds) { return static_cast<std::int64_t>(milliseconds); };
  std::string stages;
  for (const auto& stage : stats.stages)
    if (const std::int64_t share = whole(ownShare(stats, stage)); share > 0)
      stages += fmt::format("{}{} {}", stages.empty() ? " (" : ", ", stage.first, share);
  fmt::print(stderr, "{}: {}x{}, {} triangles, {} lights, {} ms{}{}\n", options.output, stats.width,
             stats.height, stats.triangles, stats.lights, whole(pictureMilliseconds(stats)), stages,
             stages.empty() ? "" : ")");
}

}  // namespace luciole
