#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <optional>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "base/error.hpp"
#include "base/trace.hpp"
#include "cli/commands.hpp"
#include "cli/event_log.hpp"
#include "cli/frame_claims.hpp"
#include "cli/frames.hpp"
#include "cli/open_devices.hpp"
#include "cli/picture_options.hpp"
#include "cli/picture_output.hpp"
#include "cli/probe.hpp"
#include "cli/progress.hpp"
#include "cli/shard.hpp"
#include "gbuffer/gbuffer_file.hpp"
#include "image/file_format.hpp"
#include "image/film.hpp"
#include "image/picture_hash.hpp"
#include "render/measure_exposure.hpp"
#include "render/render.hpp"
#include "render/share_picture.hpp"
#include "render/surface_ids.hpp"
#include "scene/pose.hpp"

namespace luciole {
namespace {

constexpr double kFramesPerSecond = 24;

struct RenderOptions : PictureOptions {
  std::string scene;
  std::string shard;
  std::optional<double> frames_per_second;
  bool resume = false;
  std::string probe;
};

/// The part of the picture that is made.
Crop windowOf(const RenderSettings& settings) {
  return settings.crop.value_or(Crop{0, 0, settings.size.x, settings.size.y});
}

/// The exposure of each picture, by one a camera: measured at this frame, or none where the options say it.
std::vector<std::optional<double>> chooseExposures(Device& device, Scene& scene, int frame,
                                                   const RenderOptions& options,
                                                   const std::vector<PictureOptions>& pictures,
                                                   Stats& stats) {
  std::vector<std::optional<double>> exposures(pictures.size());
  if (!measuresExposure(options, options.scene)) return exposures;
  poseScene(scene, frame);
  for (std::size_t i = 0; i < pictures.size(); ++i)
    exposures[i] = measureExposure(device, scene, renderSettings(pictures[i], scene), stats);
  return exposures;
}

/// Renders the scene at its frame, with the exposure that was measured or that the options say, and writes
/// the picture, to the film unless that is null. keeps: see renderShared.
void renderPicture(std::list<Sharer>& sharers, const Scene& scene, const PictureOptions& options, Film* film,
                   ProgressLine& progress, const std::function<void(int, int)>& on_pass, bool keeps,
                   Stats& stats) {
  RenderSettings settings = renderSettings(options, scene);
  settings.on_pass = on_pass;
  settings.on_long_compile = [&] { progress.tell("compiling kernels"); };
  if (stats.measured_exposure) settings.exposure = float(*stats.measured_exposure);
  const Crop window = windowOf(settings);
  WriteOptions how = writeOptions(options, settings.camera, settings.size, {window.x, window.y});
  how.film = film;
  const Metadata mattes = surfaceIdTexts(scene, settings);
  how.exr.texts.insert(how.exr.texts.end(), mattes.begin(), mattes.end());
  std::optional<ImageWriter> writer;
  std::optional<PictureHash> hash;
  const auto write = [&](const Image& rows) {
    timed(stats, Stage::kWrite, [&] {
      if (options.hash && !hash) hash.emplace(window.width, window.height, rows.channels);
      if (hash) hash->add(rows);
      if (!writer)
        writer.emplace(options.output, window.width, window.height, rows.channels,
                       pictureMetadata(stats, sharers.front().device), how);
      writer->write(rows);
    });
  };
  renderShared(sharers, scene, settings, write, stats, keeps);
  if (!options.quiet)
    for (const DeviceShare& share : stats.shares)
      if (!share.error.empty()) tellWarning(fmt::format("{}; the other devices made its rows", share.error));
  const std::uint64_t limited = timed(stats, Stage::kWrite, [&] { return writer->close(); });
  if (hash) stats.hash = hash->hex();
  reportHalves(options, limited, stats);
  reportLightError(options, stats);
}

/// Whether a frame's file exists. Files are written as a whole or not at all, so such a frame is done.
bool isDone(const std::string& path) {
  std::error_code none;
  return std::filesystem::is_regular_file(path, none) && std::filesystem::file_size(path, none) > 0;
}

/// The frames of this run's shard, without those that --resume finds done.
std::vector<int> framesToMake(const RenderOptions& options, const std::vector<int>& all, const Shard& shard) {
  if (options.shard.empty() && shard.count > 1) {
    if (logsEvents())
      logEvent("slurm_shard", {{"shard", shard.index + 1}, {"shards", shard.count}});
    else if (!options.quiet)
      fmt::print(stderr, "shard {}/{} of the frames, as task of a Slurm array\n", shard.index + 1,
                 shard.count);
  }
  std::vector<int> frames, done;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!isMine(shard, i)) continue;
    const bool is_done = options.resume && isDone(frameFile(options.output, all[i]));
    (is_done ? done : frames).push_back(all[i]);
  }
  if (!done.empty()) {
    if (logsEvents())
      logEvent("resumed", {{"frames_there", done.size()}, {"frames", done.size() + frames.size()}});
    else if (!options.quiet)
      fmt::print(stderr, "there already: {} of {} frames\n", done.size(), done.size() + frames.size());
  }
  return frames;
}

/// Renders frame after frame. A frame that fails is reported and left out, but of a film it is the last one.
/// exposures: those measured, by one a camera, the same for all frames. film: where frames go, or null for a
/// file each. claims: null unless other runs may be at work beside this one. started: the cost of loading and
/// measuring, which goes into the first frame's statistics. Returns the exit status of the first failure.
/// Throws InputError for a frame that another run has claimed.
int renderFrames(std::list<Sharer>& sharers, Scene& scene, const RenderOptions& options,
                 const std::vector<int>& frames, const std::vector<std::optional<double>>& exposures,
                 Film* film, FrameClaims* claims, Stats started) {
  ProgressLine progress(options.quiet);
  const std::string command = started.command;
  int status = kDone;
  std::vector<int> failed;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (claims) claims->claim(frames[i]);
    const auto showPass = [&](int done, int passes) {
      progress.show(fmt::format("frame {}, {} of {}", frames[i], i + 1, frames.size()),
                    i * passes + std::size_t(done), frames.size() * passes);
    };
    const TraceSpan span("frame", {{"frame", frames[i]}});
    logEvent("frame_begun", {{"frame", frames[i]}});
    progress.frame = frames[i];
    showPass(0, 1);
    PictureOptions one = options;
    one.output = frameFile(options.output, frames[i]);
    one.stats = frameFile(options.stats, frames[i]);
    one.quiet = options.quiet || film;  // a film is told when it is whole
    try {
      poseScene(scene, frames[i]);
      const std::vector<PictureOptions> pictures = optionsOfCameras(one, scene);
      for (std::size_t camera = 0; camera < pictures.size(); ++camera) {
        const PictureOptions& picture = pictures[camera];
        if (options.resume && isDone(picture.output)) continue;
        if (!film) checkOutput(picture);
        Stats stats = std::exchange(started, Stats{});
        if (stats.command.empty()) stats = laterStats(command);
        stats.measured_exposure = exposures[camera];
        renderPicture(sharers, scene, picture, film, progress, showPass, true, stats);
        progress.clear();
        reportStats(picture, stats, frames[i]);
      }
    } catch (const std::exception&) {
      progress.clear();
      const int why = tellFailure(frames[i]);
      if (film) return why;
      if (status == kDone) status = why;
      failed.push_back(frames[i]);
    }
  }
  if (!failed.empty())
    tellError(fmt::format("{} of {} frames failed: {}", failed.size(), frames.size(), listFrames(failed)),
              status);
  return status;
}

/// Renders all frames into one film. Returns the exit status.
int renderFilm(std::list<Sharer>& sharers, Scene& scene, const RenderOptions& options,
               const std::vector<int>& frames, const std::vector<std::optional<double>>& exposures,
               Stats started) {
  const PictureOptions picture = optionsOfCameras(options, scene).front();
  const Crop window = windowOf(renderSettings(picture, scene));
  const double rate = options.frames_per_second.value_or(kFramesPerSecond);
  const std::string path = frameFile(picture.output, frames.front());
  Film film(path, options.format, window.width, window.height, rate);
  const int status =
      renderFrames(sharers, scene, options, frames, exposures, &film, nullptr, std::move(started));
  if (status != kDone) return status;
  film.close();
  if (logsEvents())
    logEvent("film_done", {{"file", path},
                           {"frames", frames.size()},
                           {"width", window.width},
                           {"height", window.height},
                           {"milliseconds", eventMilliseconds(millisecondsSinceStart())}});
  else if (!options.quiet)
    fmt::print(stderr, "{}: {} frames of {}x{}, {} a second, {:.0f} ms\n", path, frames.size(), window.width,
               window.height, rate, millisecondsSinceStart());
  return kDone;
}

/// Whether the frames become one film: its name, a film's, has no place for a frame's number.
bool makesFilm(const RenderOptions& options, const FrameChoice& choice) {
  return choice.is_list && isFilm(options.output, options.format) && !hasFramePlace(options.output);
}

void checkFilmOptions(const RenderOptions& options) {
  checkFilm(frameFile(options.output, 1), options.format);
  if (options.resume)
    throw InputError("--resume: a film is made from its first frame on; make pictures, as -o frame.####.png");
  checkOtherOutputs(options);
  if (options.bits == 16 || options.half || options.alpha || !options.compression.empty())
    throw InputError(fmt::format(
        "{}: a film holds red, green and blue in 8 bits, without --bits 16, --half, --alpha or --compression",
        options.output));
  if (!options.aovs.empty() || options.light_groups)
    throw InputError(fmt::format("{}: {} cannot hold layers, an .exr can",
                                 options.light_groups ? "--light-groups" : "--aov", options.output));
  if (!options.stats.empty() && options.stats != "-") checkPattern(options.stats, "--stats");
}

/// The pixel that --probe names.
std::optional<glm::ivec2> probedPixel(const RenderOptions& options) {
  if (options.probe.empty()) return std::nullopt;
  const std::vector<int> at = parseInts(options.probe, ',', 2, "--probe", "X,Y, such as 320,180");
  return glm::ivec2(at[0], at[1]);
}

void checkOptions(const RenderOptions& options, const FrameChoice& choice) {
  if (probedPixel(options)) {
    if (choice.is_list) throw InputError("--probe: goes with one frame, such as --frames 3");
    if (options.output == "-" || options.stats == "-")
      throw InputError("--probe: standard output can't take it and another - together; name a file");
    if (options.output.empty()) return;
  }
  if (options.output.empty()) throw InputError("render: -o is required, or --probe X,Y");
  const bool is_film = makesFilm(options, choice);
  if (options.frames_per_second && !is_film)
    throw InputError("--fps: goes with a film, as --frames A-B -o film.mp4");
  if (is_film) return checkFilmOptions(options);
  if (isFilm(options.output, options.format) && formatName(options.output, options.format) != "webp")
    throw InputError(fmt::format(
        "-o {}: a film goes with --frames A-B, and has no frame's number in its name", options.output));
  checkOutput(options);
  if (choice.is_list) {
    checkPattern(options.output, "-o");
    if (!options.stats.empty() && options.stats != "-") checkPattern(options.stats, "--stats");
  } else if (options.resume || !options.shard.empty()) {
    throw InputError(fmt::format("{}: goes with --frames A-B", options.resume ? "--resume" : "--shard"));
  }
}

}  // namespace

void addRenderCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("render", "a picture of a scene, or one a frame");
  auto options = std::make_shared<RenderOptions>();
  command
      ->add_option("SCENE", options->scene, "a .json, .obj, .gltf or .glb file (- : JSON on standard input)")
      ->required();
  addPictureOptions(*command, *options,
                    kViewOptions | kSampleOption | kModelOptions | kShadeOptions | kCastOption |
                        kDeviceOption | kExactOption);
  command->add_option(
      "--frames", options->frames,
      "frame A, frames A-B, each Nth of them, A-BxN, or a list of these, 1,3,10-100x5, of a scene that moves "
      "(default: 1); #### or %04d in the output's name (and that of --stats) becomes the number; a frame "
      "that "
      "fails is told and the others are made");
  command
      ->add_option(
          "--fps", options->frames_per_second,
          "frames a second of a film: --frames A-B -o film.mp4, .webm or .webp, which ffmpeg encodes "
          "(default: 24)")
      ->check(CLI::Range(1.0, 240.0));
  // A probe needs no picture: checkOptions() asks for it.
  command->get_option("--output")->required(false);
  command->add_option(
      "--probe", options->probe,
      "print what makes a pixel: its surface, what each light adds to it by the reference, and "
      "the colour that the device makes of it; without -o no picture is made");
  command->add_flag("--resume", options->resume, "leave frames alone whose file is there");
  command->add_option("--shard", options->shard,
                      "I/N: only every Nth of the frames, from the Ith on (default in a Slurm job array: its "
                      "tasks share them)");
  command->callback([&context, options] {
    const FrameChoice choice = chosenFrames(options->frames);
    if (!choice.is_list) useFrame(*options, "render");
    checkOptions(*options, choice);
    const bool is_film = makesFilm(*options, choice);
    std::vector<int> frames;
    std::optional<FrameClaims> claims;
    if (choice.is_list) {
      const Shard shard = chosenShard(options->shard);
      if (is_film && shard.count > 1)
        throw InputError(fmt::format(
            "{}: one process makes all frames of a film, and this is shard {} of {}; make pictures, as -o "
            "frame.####.png, or say --shard 1/1",
            options->output, shard.index + 1, shard.count));
      frames = framesToMake(*options, choice.frames, shard);
      if (frames.empty()) return;
      if (shard.is_chosen && !is_film)
        claims.emplace(options->output).claim(frames.front());  // before any work is done
    }
    Stats stats;
    stats.command = context.command_line;
    std::list<Sharer> sharers = startSharers(*options, context);
    Device& device = *sharers.front().device;
    Scene scene = timed(stats, Stage::kLoadScene, [&] {
      return openLitScene(options->scene, choice.is_list ? 1 : choice.frames.front(), *options);
    });
    if (choice.is_list) {
      // Before any frame: what is wrong with it is so with all.
      const std::vector<PictureOptions> pictures = optionsOfCameras(*options, scene);
      renderSettings(pictures.front(), scene);
      if (is_film && pictures.size() > 1)
        throw InputError(
            fmt::format("--camera all: a film is of one camera, and {} has {}", scene.name, pictures.size()));
      awaitDevice(device);
      for (const Sharer& sharer : sharers) logDevice(sharer.device->description);
      // By the first frame of all, also of those that aren't made here: every shard measures the same.
      const auto exposures = chooseExposures(device, scene, choice.frames.front(), *options, pictures, stats);
      context.status = is_film ? renderFilm(sharers, scene, *options, frames, exposures, std::move(stats))
                               : renderFrames(sharers, scene, *options, frames, exposures, nullptr,
                                              claims ? &*claims : nullptr, std::move(stats));
      return;
    }
    const int frame = choice.frames.front();
    if (const std::optional<glm::ivec2> pixel = probedPixel(*options)) {
      RenderSettings settings = renderSettings(*options, scene);
      // What is measured depends on the file, if there is one.
      if ((!options->output.empty() || !options->exposure.empty()) &&
          measuresExposure(*options, options->scene))
        settings.exposure = float(measureExposure(device, scene, settings, stats));
      fmt::print("{}", probeText(device, scene, settings, *pixel));
      if (options->output.empty()) return;
    }
    const std::vector<PictureOptions> pictures = optionsOfCameras(*options, scene);
    for (const PictureOptions& picture : pictures) checkOutput(picture);
    logEvent("frame_begun", {{"frame", frame}});
    bool device_is_told = false;
    const auto exposures = chooseExposures(device, scene, frame, *options, pictures, stats);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      ProgressLine progress(options->quiet);
      progress.frame = frame;
      const auto showPass = [&](int done, int passes) {
        // The first pass needed it.
        if (!std::exchange(device_is_told, true))
          for (const Sharer& sharer : sharers) logDevice(sharer.device->description);
        progress.show(std::filesystem::path(pictures[i].output).filename(), std::size_t(done),
                      std::size_t(passes));
      };
      stats.measured_exposure = exposures[i];
      renderPicture(sharers, scene, pictures[i], nullptr, progress, showPass, false, stats);
      progress.clear();
      reportStats(pictures[i], stats, frame);
      stats = laterStats(context.command_line);
    }
  });
}

void addGBufferCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command =
      app.add_subcommand("gbuffer", "stop after rasterizing: positions, normals and materials as an EXR");
  auto options = std::make_shared<PictureOptions>();
  auto scene_path = std::make_shared<std::string>();
  command->add_option("SCENE", *scene_path, "a .json, .obj, .gltf or .glb file (- : JSON on standard input)")
      ->required();
  addModelOption(*command, *options);
  addPictureOptions(*command, *options, kViewOptions | kCastOption | kDeviceOption | kFrameOption);
  command->callback([&context, options, scene_path] {
    const int frame = useFrame(*options, "gbuffer");
    checkDataOutput(*options, "a G-buffer");
    Stats stats;
    stats.command = context.command_line;
    const Scene scene =
        timed(stats, Stage::kLoadScene, [&] { return openLitScene(*scene_path, frame, *options); });
    const std::vector<PictureOptions> pictures = optionsOfCameras(*options, scene);
    // Only Gouraud shading needs a device to rasterize: it lights the vertices.
    Device& device = context.device;
    const bool lit = options->shading == "gouraud";
    if (lit) {
      openDevice(options->device, device);
      addStage(stats, Stage::kOpenDevice, device.milliseconds_to_open);
      logDevice(device.description);
    }
    logEvent("frame_begun", {{"frame", frame}});
    for (const PictureOptions& picture : pictures) {
      checkDataOutput(picture, "a G-buffer");
      const RenderSettings settings = renderSettings(picture, scene);
      if (lit) stats.device = device.description;
      const GBuffer gbuffer = rasterizeScene(lit ? &device : nullptr, scene, settings, stats);
      timed(stats, Stage::kWrite, [&] {
        writeGBuffer(gbuffer, picture.output, pictureMetadata(stats, lit ? &device : nullptr), picture.format,
                     picture.compression);
      });
      reportStats(picture, stats, frame);
      stats = laterStats(context.command_line);
    }
  });
}

}  // namespace luciole
