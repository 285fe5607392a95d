#include "tools/cli/picture_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "base/write_file.hpp"
#include "gbuffer/camera_header.hpp"
#include "image/exposure.hpp"
#include "image/file_format.hpp"
#include "image/film.hpp"
#include "lighting/count_picture.hpp"
#include "lighting/light_layers.hpp"
#include "luciole/error.hpp"
#include "scene/json/mesh_file.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"

namespace luciole {
namespace {

/// What rounding to a 16-bit float changes: at most this share of a value, or this much of one below 2⁻¹⁴.
constexpr double kHalfRelative = 0x1p-11, kHalfAbsolute = 0x1p-25;

void logPicture(const PictureOptions& options, const Stats& stats, double ended, int frame) {
  for (const auto& [stage, milliseconds] : stats.stages)
    logEvent(
        "stage",
        {{"frame", frame}, {"stage", stageName(stage)}, {"milliseconds", eventMilliseconds(milliseconds)}});
  EventFields done{{"frame", frame},
                   {"file", options.output},
                   {"width", stats.width},
                   {"height", stats.height},
                   {"triangles", stats.triangles},
                   {"lights", stats.lights},
                   {"milliseconds", eventMilliseconds(ended - stats.began)}};
  if (!stats.hash.empty()) done["hash"] = stats.hash;
  logEvent("frame_done", done);
}

/// Throws InputError for a compression that changes `what`.
void checkLossless(const PictureOptions& options, const std::string& what) {
  if (options.value("compression").empty()) return;
  std::vector<std::string> lossless;
  for (const ExrCompression& one : kExrCompressions)
    if (one.is_lossless) lossless.push_back(one.name);
  if (std::find(lossless.begin(), lossless.end(), options.value("compression")) == lossless.end())
    throw InputError(
        fmt::format("--compression {}: changes values, and {} must keep them, expected one of {}",
                    options.value("compression"), what, fmt::join(lossless, ", ")));
}

}  // namespace

WriteOptions fileOptions(const PictureOptions& options) {
  WriteOptions file{.alpha = options.isOn("alpha")};
  applySettings(options.settings, file);
  return file;
}

bool measuresExposure(const PictureOptions& options, const std::string& scene_path) {
  if (!options.exposure.empty()) return options.exposure == "auto";
  if (!isMeshFile(scene_path)) return false;
  return isFilm(options.output, options.value("format")) ||
         !pictureFormat(options.output, fileOptions(options)).is_float;
}

void checkOtherOutputs(const PictureOptions& options) {
  if (!options.trace.empty() && options.trace == options.output)
    throw InputError(fmt::format("--trace {}: is the picture's own file", options.trace));
  if (!options.trace.empty() && options.trace == options.stats)
    throw InputError(fmt::format("--trace {}: is the file of --stats", options.trace));
  if (options.hash)
    for (const auto& [name, file] : {std::pair{"-o", options.output}, std::pair{"--stats", options.stats},
                                     std::pair{"--trace", options.trace}})
      if (file == "-")
        throw InputError(
            fmt::format("--hash: standard output can't take it and {} - together; name a file", name));
}

void checkOutput(const PictureOptions& options) {
  checkWritable(options.output, fileOptions(options));
  if (options.value("tone") != "clip" && pictureFormat(options.output, fileOptions(options)).is_float)
    throw InputError(fmt::format(
        "--tone {}: {} holds light as it is, in floats; expected a format of integers, such as .png",
        options.value("tone"), options.output));
  const std::vector<Aov> aovs = aovsOf(options);
  if (showsAov(options)) {
    if (aovs.size() > 1 || aovs.front() == Aov::kMaterial)
      throw InputError(
          fmt::format("--aov {}: several layers, and {} shows one, such as --aov normal; an .exr holds all",
                      options.value("aov"), options.output));
    if (options.isOn("alpha")) throw InputError("--alpha: a layer as a picture has no A; leave it out");
  }
  if (options.isOn("light_groups") &&
      outputFormat(options.output, options.value("format")).extension != "exr")
    throw InputError(fmt::format("--light-groups: {} cannot hold layers, an .exr can", options.output));
  if (std::any_of(aovs.begin(), aovs.end(),
                  [](Aov aov) { return aov == Aov::kCryptoObject || aov == Aov::kCryptoMaterial; }))
    checkLossless(options, "Cryptomattes");
  RenderSettings layers;
  layers.aovs = aovs;
  layers.light_groups = options.isOn("light_groups");
  if (wantsLightLayers(layers) && options.value("shading") == "gouraud")
    throw InputError(
        fmt::format("--shading gouraud: lights corners, and layers of light are lit pixel by pixel; "
                    "leave it out, or {}",
                    options.isOn("light_groups") ? "--light-groups" : "these of --aov"));
  if (!options.stats.empty() && options.stats == options.output)
    throw InputError(fmt::format("--stats {}: is the picture's own file", options.stats));
  checkOtherOutputs(options);
}

void checkDataOutput(const PictureOptions& options, const std::string& what) {
  checkOutput(options);
  checkLossless(options, what);
}

WriteOptions writeOptions(const PictureOptions& options, const std::optional<Camera>& camera,
                          glm::ivec2 picture_size, glm::ivec2 crop_origin) {
  WriteOptions file = fileOptions(options);
  file.picture_size = picture_size;
  file.crop_origin = crop_origin;
  if (camera) file.exr = cameraAttributes(*camera, picture_size);
  return file;
}

WriteOptions writeOptions(const PictureOptions& options, const GBuffer& gbuffer) {
  WriteOptions file = fileOptions(options);
  file.picture_size = gbuffer.picture_size;
  file.crop_origin = gbuffer.crop_origin;
  file.display = gbuffer.display;
  if (gbuffer.knows_camera)
    file.exr = cameraAttributes(gbuffer.camera, gbuffer.picture_size, gbuffer.display.pixel_aspect);
  return file;
}

void reportHalves(const PictureOptions& options, std::uint64_t limited, Stats& stats) {
  if (options.isOn("half")) {
    stats.errors.emplace_back("half_relative", kHalfRelative);
    stats.errors.emplace_back("half_absolute", kHalfAbsolute);
  }
  if (limited == 0) return;
  stats.warnings.push_back(fmt::format(
      "{}: {} pixel{} brighter than {}, the most that the file holds, and became that; darken by "
      "--exposure, or take 32-bit floats and a lossless --compression",
      options.output, limited, limited == 1 ? " was" : "s were", largestColor(fileOptions(options))));
  if (!options.quiet) reportWarning(stats.warnings.back());
}

void reportFaults(const PictureOptions& options, Stats& stats) {
  const auto report = [&](const std::string& count, const std::string& what, const char* units,
                          const char* then) {
    const std::uint64_t faults = countOf(stats, count);
    if (faults == 0) return;
    stats.warnings.push_back(fmt::format("{} at {} {}, {}", what, faults, units, then));
    if (!options.quiet) reportWarning(stats.warnings.back());
  };
  const char* const pixels = stats.samples > 1 ? "samples of pixels" : "pixels";
  report(kFaultyPixels, "a model from a file gave NaN, infinite or negative light", pixels,
         "where it counts as 0: luciole check-model tells for which directions");
  report(kFaultySurfaces, "a file of --surface gave NaN, infinite or negative numbers, or no direction",
         "points", "where what is negative counts as 0 and all else stays as it was");
  for (std::size_t i = 0; i < options.screens.size(); ++i)
    report(faultyScreenPixels(i), options.screens[i] + ": screen() gave NaN, infinite or negative colours",
           pixels, "which keep the ones before it");
}

void reportLightError(const PictureOptions& options, Stats& stats) {
  RenderSettings asked;
  applySettings(options.settings, asked);
  const float allowed = asked.shade.light_error;
  const bool relative = asked.shade.light_error_floor != ShadeSettings{}.light_error_floor;
  const std::string option = fmt::format("--light-error{} {}", relative ? "-relative" : "", allowed);
  const auto warn = [&](const std::string& text) {
    stats.warnings.push_back(option + ": " + text);
    if (!options.quiet) reportWarning(stats.warnings.back());
  };
  // A few roundings more than allowed are no reason to worry anybody.
  if (stats.light_error.least > 1.000001 * allowed)
    warn(fmt::format("floats can't promise it for this picture; the least that they can is {:.3g}",
                     1.05 * stats.light_error.least));
  if (const std::uint64_t missed = countOf(stats, "pixels_beyond_light_error"); missed > 0)
    warn(fmt::format(
        "{} stayed beyond it at a confidence of {}: a larger error, or a smaller confidence, takes "
        "fewer rays than there are",
        missed == 1 ? "1 pixel" : fmt::format("{} pixels", missed), asked.shade.confidence));
}

bool showsAov(const PictureOptions& options) {
  return !options.value("aov").empty() &&
         outputFormat(options.output, options.value("format")).extension != "exr";
}

void writeLayerPicture(const PictureOptions& options, const ShownLayer& shown, Image layer,
                       const Stats& stats, const OpenedDevice* device) {
  const bool is_light = shown.kind == LayerKind::kColor && layer.channels.size() == 3;
  if (is_light) {
    layer.channels = {"R", "G", "B"};
    expose(layer, exposureOf(options));
  }
  const LayerPicture picture = layerPicture(shown.name, shown.kind, layer);
  WriteOptions how = fileOptions(options);
  how.dither = how.dither && is_light;  // equal values have equal colours
  how.picture_size = picture.image.picture_size;
  how.crop_origin = picture.image.crop_origin;
  writeImage(picture.image, options.output, pictureMetadata(stats, device), how);
  if (options.quiet) return;
  for (const std::string& note : picture.notes) {
    if (logsEvents())
      logEvent("layer", {{"message", note}});
    else
      fmt::print(stderr, "{}: {}\n", options.output, note);
  }
}

void writeAov(const PictureOptions& options, const Image& picture, const Stats& stats,
              const OpenedDevice* device) {
  const ShownLayer shown = aovLayer(picture.channels);
  Image layer;
  appendRows(picture, shown.channels, layer);
  PictureOptions exposed = options;
  exposed.exposure.clear();  // its light is exposed
  writeLayerPicture(exposed, shown, std::move(layer), stats, device);
}

Metadata pictureMetadata(const Stats& stats, const OpenedDevice* device) {
  Metadata metadata{{"Software", "Luciole " LUCIOLE_VERSION}, {"ImageDescription", stats.command}};
  if (stats.measured_exposure)
    metadata.emplace_back("luciole:exposure", fmt::format("{:+.2f}", *stats.measured_exposure));
  if (device && !device->description.arithmetic.empty())
    metadata.emplace_back("luciole:arithmetic", device->description.arithmetic);
  if (device)
    metadata.emplace_back(
        "luciole:device",
        fmt::format("{}, {}, driver {}, {} lanes", device->description.name, device->description.platform,
                    device->description.version, device->description.lanes));
  return metadata;
}

Stats laterStats(const std::string& command) {
  Stats stats;
  stats.command = command;
  stats.began = millisecondsSinceStart();
  return stats;
}

void reportStats(const PictureOptions& options, const Stats& stats, int frame) {
  const double ended = millisecondsSinceStart();
  if (!options.stats.empty())
    writeTextFile(options.stats,
                  options.stats.ends_with(".csv") ? statsCsv(stats, ended) : statsJson(stats, ended));
  if (!stats.hash.empty()) {
    fmt::print("{}  {}\n", stats.hash, options.output);
    std::fflush(stdout);  // whoever waits for a frame's line gets it when the frame is done
  }
  if (logsEvents()) return logPicture(options, stats, ended, frame);
  if (options.quiet) return;
  // Rounded down to whole milliseconds, so that the stages' sum isn't more than the picture's time.
  const auto whole = [](double milliseconds) { return static_cast<std::int64_t>(milliseconds); };
  std::string stages;
  for (const auto& stage : stats.stages)
    if (const std::int64_t share = whole(ownShare(stats, stage)); share > 0)
      stages += fmt::format("{}{} {}", stages.empty() ? " (" : ", ", stageName(stage.first), share);
  const std::string exposure =
      stats.measured_exposure ? fmt::format("exposure {:+.2f} stops, ", *stats.measured_exposure) : "";
  writeError(fmt::format("{}: {}x{}, {} triangles, {} lights, {}{} ms{}{}{}\n", options.output, stats.width,
                         stats.height, stats.triangles, stats.lights, exposure, whole(ended - stats.began),
                         stages, stages.empty() ? "" : ")",
                         options.isOn("half") ? ", colours rounded by up to 2^-11 of themselves" : ""));
}

}  // namespace luciole
