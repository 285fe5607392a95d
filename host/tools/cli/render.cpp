#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "base/clock.hpp"
#include "base/trace.hpp"
#include "image/file_format.hpp"
#include "image/film.hpp"
#include "image/picture_hash.hpp"
#include "image/side_by_side.hpp"
#include "luciole/error.hpp"
#include "luciole/gbuffer_file.hpp"
#include "luciole/pose.hpp"
#include "raster/surface_ids.hpp"
#include "render/measure_exposure.hpp"
#include "render/render.hpp"
#include "render/renderer.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/frame_claims.hpp"
#include "tools/cli/frames.hpp"
#include "tools/cli/open_devices.hpp"
#include "tools/cli/orbit.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/picture_output.hpp"
#include "tools/cli/probe.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/shard.hpp"
#include "tools/cli/sweep.hpp"
#include "tools/viewing/layer_picture.hpp"

namespace luciole {
namespace {

constexpr double kFramesPerSecond = 24;

struct RenderOptions : PictureOptions {
  std::string scene;
  std::string shard;
  std::optional<double> frames_per_second;
  bool resume = false;
  Orbit orbit;
  std::vector<std::string> sweeps;
  std::string probe;
};

/// The settings of a picture of a scene that is posed for the frame.
RenderSettings settingsAt(int frame, const PictureOptions& picture, const Scene& scene, const Orbit& orbit) {
  RenderSettings settings = renderSettings(picture, scene);
  settings.camera = orbiting(settings.camera, orbit, frame);
  return settings;
}

/// The part of the picture that is made.
Crop windowOf(const RenderSettings& settings) {
  return settings.crop.value_or(Crop{0, 0, settings.size.x, settings.size.y});
}

/// Chooses how many lights sources have, for the first of the pictures at this frame, if the options leave it
/// open.
void chooseLightCounts(Renderer& renderer, int frame, const RenderOptions& options,
                       const std::vector<PictureOptions>& pictures, Stats& stats) {
  if (options.value("light_count") != "auto") return;
  Scene& scene = renderer.scene();
  poseScene(scene, frame);
  ProgressLine progress(options.quiet);
  RenderSettings settings = settingsAt(frame, pictures.front(), scene, options.orbit);
  settings.on_long_compile = compileReporter(progress);
  if (!(settings.shade.light_error > 0))
    throw InputError("--light-count auto: expected --light-error, which says how much counts may miss");
  renderer.chooseLightCounts(settings, stats);
  progress.clear();
}

/// The exposure of each picture, by one a camera: measured at this frame, or none where the options say it.
std::vector<std::optional<double>> chooseExposures(Renderer& renderer, int frame,
                                                   const RenderOptions& options,
                                                   const std::vector<PictureOptions>& pictures,
                                                   Stats& stats) {
  std::vector<std::optional<double>> exposures(pictures.size());
  if (!measuresExposure(options, options.scene)) return exposures;
  Scene& scene = renderer.scene();
  poseScene(scene, frame);
  ProgressLine progress(options.quiet);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    RenderSettings settings = settingsAt(frame, pictures[i], scene, options.orbit);
    settings.on_long_compile = compileReporter(progress);
    exposures[i] = renderer.measureExposure(settings, stats);
  }
  progress.clear();
  return exposures;
}

/// The settings with the exposure that was measured, if it was.
RenderSettings withExposure(RenderSettings settings, const Stats& stats) {
  if (stats.measured_exposure) settings.exposure = float(*stats.measured_exposure);
  return settings;
}

/// Renders the scene at its frame, and calls write(rows) from the top down.
void renderRows(Renderer& renderer, const PictureOptions& options, const RenderSettings& settings,
                const RowSink& write, Stats& stats) {
  const Crop window = windowOf(settings);
  std::optional<PictureHash> hash;
  const auto take = [&](const Image& rows) {
    timed(stats, Stage::kWrite, [&] {
      if (options.hash && !hash) hash.emplace(window.width, window.height, rows.channels);
      if (hash) hash->add(rows);
      write(rows);
    });
  };
  renderer.render(settings, take, stats);
  if (!options.quiet)
    for (const DeviceShare& share : stats.shares)
      if (!share.error.empty())
        reportWarning(fmt::format("{}; the other devices made its rows", share.error));
  if (hash) stats.hash = hash->hex();
  reportFaults(options, stats);
  reportLightError(options, stats);
}

/// Renders the scene and returns the layer that --aov names alone.
Image renderLayer(Renderer& renderer, const PictureOptions& options, const RenderSettings& settings,
                  ShownLayer& layer, Stats& stats) {
  Image picture;
  const auto take = [&](const Image& rows) {
    if (picture.height == 0) layer = aovLayer(rows.channels);
    appendRows(rows, layer.channels, picture);
  };
  renderRows(renderer, options, settings, take, stats);
  return picture;
}

/// Renders the scene as it is posed, by these settings of the options, with the exposure that was measured or
/// that the options say. Writes the picture, to the film unless that is null, or where the file has no place
/// for layers the one that --aov names.
void renderPicture(Renderer& renderer, const OpenedDevice* device, const PictureOptions& options,
                   RenderSettings settings, Film* film, ProgressLine& progress,
                   const std::function<void(int, int)>& on_pass, Stats& stats) {
  settings = withExposure(settings, stats);
  settings.on_pass = on_pass;
  settings.on_long_compile = compileReporter(progress);
  if (showsAov(options)) {
    ShownLayer shown;
    const Image layer = renderLayer(renderer, options, settings, shown, stats);
    PictureOptions exposed = options;
    exposed.exposure.clear();  // its light is exposed
    timed(stats, Stage::kWrite, [&] { writeLayerPicture(exposed, shown, layer, stats, device); });
    return;
  }
  const Crop window = windowOf(settings);
  WriteOptions how = writeOptions(options, settings.camera, settings.size, {window.x, window.y});
  how.film = film;
  const Metadata mattes = surfaceIdTexts(renderer.scene(), settings);
  how.exr.texts.insert(how.exr.texts.end(), mattes.begin(), mattes.end());
  std::optional<ImageWriter> writer;
  const auto write = [&](const Image& rows) {
    if (!writer)
      writer.emplace(options.output, window.width, window.height, rows.channels,
                     pictureMetadata(stats, device), how);
    writer->write(rows);
  };
  renderRows(renderer, options, settings, write, stats);
  const std::uint64_t limited = timed(stats, Stage::kWrite, [&] { return writer->close(); });
  reportHalves(options, limited, stats);
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
      writeError(
          fmt::format("shard {}/{} of the frames, as task of a Slurm array\n", shard.index + 1, shard.count));
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
      writeError(fmt::format("there already: {} of {} frames\n", done.size(), done.size() + frames.size()));
  }
  return frames;
}

/// Tells how many of the frames were left to other runs.
void reportShared(const RenderOptions& options, std::size_t others, std::size_t all) {
  if (others == 0) return;
  if (logsEvents())
    logEvent("shared", {{"frames_of_other_runs", others}, {"frames", all}});
  else if (!options.quiet)
    fmt::print(stderr, "made by other runs: {} of {} frames\n", others, all);
}

/// Renders frame after frame. A frame that fails is reported and left out, but of a film it is the last one.
/// exposures: those measured, by one a camera, the same for all frames. film: where frames go, or null for a
/// file each. claims: by which other runs may share the frames; of a film null. When all others are made,
/// those are awaited that other runs are at. started: the cost of loading and measuring, which goes into the
/// first frame's statistics. Returns the exit status of the first failure.
int renderFrames(Renderer& renderer, const OpenedDevice* device, const RenderOptions& options,
                 const std::vector<int>& frames, const std::vector<std::optional<double>>& exposures,
                 Film* film, FrameClaims* claims, Stats started) {
  ProgressLine progress(options.quiet);
  const std::string command = started.command;
  int status = kDone;
  std::vector<int> failed, elsewhere;
  // Returns false where no other frame can be made.
  const auto make = [&](int frame, std::size_t i) {
    const auto showPass = [&](int done, int passes) {
      progress.show(fmt::format("frame {}, {} of {}", frame, i + 1, frames.size()),
                    i * passes + std::size_t(done), frames.size() * passes);
    };
    const TraceSpan span("frame", {{"frame", frame}});
    logEvent("frame_begun", {{"frame", frame}});
    progress.frame = frame;
    showPass(0, 1);
    PictureOptions one = options;
    one.output = frameFile(options.output, frame);
    one.stats = frameFile(options.stats, frame);
    one.quiet = options.quiet || film;  // a film is told when it is whole
    try {
      Scene& scene = renderer.scene();
      poseScene(scene, frame);
      const std::vector<PictureOptions> pictures = optionsOfCameras(one, scene);
      for (std::size_t camera = 0; camera < pictures.size(); ++camera) {
        const PictureOptions& picture = pictures[camera];
        if (options.resume && isDone(picture.output)) continue;
        if (!film) checkOutput(picture);
        Stats stats = std::exchange(started, Stats{});
        if (stats.command.empty()) stats = laterStats(command);
        stats.measured_exposure = exposures[camera];
        renderPicture(renderer, device, picture, settingsAt(frame, picture, scene, options.orbit), film,
                      progress, showPass, stats);
        progress.clear();
        reportStats(picture, stats, frame);
      }
    } catch (const std::exception&) {
      progress.clear();
      const int why = reportFailure(frame);
      if (status == kDone) status = why;
      if (film) return false;
      failed.push_back(frame);
    }
    if (claims) claims->finish(frame);
    return true;
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (claims && !claims->claim(frames[i]))
      elsewhere.push_back(frames[i]);
    else if (!make(frames[i], i))
      return status;
  }
  std::size_t others = 0;
  for (const int frame : elsewhere) {
    progress.show(fmt::format("awaiting frame {}, which another run is at", frame),
                  frames.size() - elsewhere.size() + others, frames.size());
    if (!claims->await(frame))
      ++others;
    else
      make(frame, frames.size() - 1);
  }
  progress.clear();
  reportShared(options, others, frames.size());
  if (!failed.empty())
    reportError(fmt::format("{} of {} frames failed: {}", failed.size(), frames.size(), listFrames(failed)),
                status);
  return status;
}

/// Renders all frames into one film. Returns the exit status.
int renderFilm(Renderer& renderer, const OpenedDevice* device, const RenderOptions& options,
               const std::vector<int>& frames, const std::vector<std::optional<double>>& exposures,
               Stats started) {
  const PictureOptions picture = optionsOfCameras(options, renderer.scene()).front();
  const Crop window = windowOf(renderSettings(picture, renderer.scene()));
  const double rate = options.frames_per_second.value_or(kFramesPerSecond);
  const std::string path = frameFile(picture.output, frames.front());
  Film film(path, options.value("format"), window.width, window.height, rate);
  const int status =
      renderFrames(renderer, device, options, frames, exposures, &film, nullptr, std::move(started));
  if (status != kDone) return status;
  film.close();
  if (logsEvents())
    logEvent("film_done", {{"file", path},
                           {"frames", frames.size()},
                           {"width", window.width},
                           {"height", window.height},
                           {"milliseconds", eventMilliseconds(millisecondsSinceStart())}});
  else if (!options.quiet)
    writeError(fmt::format("{}: {} frames of {}x{}, {} a second, {:.0f} ms\n", path, frames.size(),
                           window.width, window.height, rate, millisecondsSinceStart()));
  return kDone;
}

/// Whether the frames become one film: its name, a film's, has no place for a frame's number.
bool makesFilm(const RenderOptions& options, const FrameChoice& choice) {
  return choice.is_list && isFilm(options.output, options.value("format")) && !hasFramePlace(options.output);
}

void checkFilmOptions(const RenderOptions& options) {
  checkFilm(frameFile(options.output, 1), options.value("format"));
  if (options.resume)
    throw InputError("--resume: a film is made from its first frame on; make pictures, as -o frame.####.png");
  checkOtherOutputs(options);
  if (options.value("bits") == "16" || options.isOn("half") || options.isOn("alpha") ||
      !options.value("compression").empty())
    throw InputError(fmt::format(
        "{}: a film holds red, green and blue in 8 bits, without --bits 16, --half, --alpha or --compression",
        options.output));
  if (!options.value("aov").empty() || options.isOn("light_groups"))
    throw InputError(fmt::format("{}: {} cannot hold layers, an .exr can",
                                 options.isOn("light_groups") ? "--light-groups" : "--aov", options.output));
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
    if (!options.sweeps.empty()) throw InputError("--probe: is of one picture, and --sweep makes several");
    if (options.output == "-" || options.stats == "-")
      throw InputError("--probe: standard output can't take it and another - together; name a file");
    if (options.output.empty() && (options.hash || !options.stats.empty()))
      throw InputError(fmt::format("{}: is of a picture, and --probe makes none without -o",
                                   options.hash ? "--hash" : "--stats"));
    if (options.output.empty()) return;
  }
  if (options.output.empty()) throw InputError("render: -o is required, or --probe X,Y");
  const bool is_film = makesFilm(options, choice);
  if (options.frames_per_second && !is_film)
    throw InputError("--fps: goes with a film, as --frames A-B -o film.mp4");
  if (is_film) return checkFilmOptions(options);
  if (isFilm(options.output, options.value("format")) &&
      formatName(options.output, options.value("format")) != "webp")
    throw InputError(fmt::format(
        "-o {}: a film goes with --frames A-B, and has no frame's number in its name", options.output));
  if (choice.is_list && !hasFramePlace(options.output))
    throw InputError(
        fmt::format("-o {}: expected a name with #### or %04d in the place of the frame's number, such as "
                    "frame.####.png, or a film's, .mp4, .webm or .webp",
                    options.output));
  checkOutput(options);
  if (choice.is_list) {
    if (!options.stats.empty() && options.stats != "-") checkPattern(options.stats, "--stats");
  } else if (options.resume || !options.shard.empty()) {
    throw InputError(fmt::format("{}: goes with --frames A-B", options.resume ? "--resume" : "--shard"));
  }
}

/// Writes a layer of a G-buffer as a picture.
void showGBuffer(const GBuffer& gbuffer, const std::string& name, const PictureOptions& options,
                 const Stats& stats) {
  Image picture;
  ShownLayer shown;
  passRows(gbuffer, [&](const Image& rows) {
    PicturePart part;
    part.channels = rows.channels;
    if (picture.height == 0) shown = findShownLayer({part}, name, "--aov");
    appendRows(rows, shown.channels, picture);
  });
  writeLayerPicture(options, shown, std::move(picture), stats, nullptr);
}

/// Throws InputError for what a sheet of pictures has no place for.
void checkSheet(const RenderOptions& options) {
  const bool has_layers = !options.value("aov").empty() && !showsAov(options);
  for (const auto& [is_given, what] :
       {std::pair{!options.stats.empty(), "--stats"}, std::pair{options.hash, "--hash"},
        std::pair{options.isOn("light_groups"), "--light-groups"}, std::pair{has_layers, "--aov"},
        std::pair{options.isOn("alpha"), "--alpha"}})
    if (is_given)
      throw InputError(
          fmt::format("{}: is of one picture, and --sweep makes a sheet of several; for a file each put # "
                      "into the name after -o",
                      what));
}

/// Renders what a sheet shows of a picture: its colours, or the layer of --aov.
Image renderPanel(Renderer& renderer, const PictureOptions& options, const RenderSettings& settings,
                  Stats& stats) {
  if (showsAov(options)) {
    ShownLayer shown;
    const Image layer = renderLayer(renderer, options, settings, shown, stats);
    return layerPicture(shown.name, shown.kind, layer).image;
  }
  Image picture;
  renderRows(
      renderer, options, settings,
      [&](const Image& rows) {
        appendRows(rows, {0, 1, 2}, picture);
      },
      stats);
  return picture;
}

/// Renders the pictures of --sweep: into a file each where the name has a place for a number, or into one
/// sheet. All have the exposure of the first. stats: the cost of opening the device.
void renderSweep(const std::vector<OpenedDevice*>& devices, const RenderOptions& options, int frame,
                 Stats stats) {
  const std::vector<Sweep> sweeps = readSweeps(options.sweeps);
  const std::vector<SweepPicture> all = sweepPictures(sweeps);
  const bool makes_files = hasFramePlace(options.output);
  if (makes_files && !options.stats.empty() && options.stats != "-") checkPattern(options.stats, "--stats");
  if (!makes_files) checkSheet(options);
  const std::string command = stats.command;
  std::vector<Image> panels;
  std::vector<std::string> labels, brief;
  std::optional<double> exposure;
  ProgressLine progress(options.quiet);
  for (std::size_t i = 0; i < all.size(); ++i) {
    RenderOptions one = options;
    one.chooses_lights = false;
    one.load.changes.insert(one.load.changes.end(), all[i].begin(), all[i].end());
    one.quiet = options.quiet || i > 0;  // the scene's warnings are told once
    progress.show(std::filesystem::path(options.output).filename(), i, all.size());
    Renderer renderer = makeRenderer(
        devices, timed(stats, Stage::kLoadScene, [&] { return openLitScene(options.scene, frame, one); }));
    Scene& scene = renderer.scene();
    setMiddle(scene, frame, one.orbit);
    const std::vector<PictureOptions> cameras = optionsOfCameras(one, scene);
    if (cameras.size() > 1) throw InputError("--camera all: --sweep makes pictures of one camera");
    PictureOptions picture = cameras.front();
    picture.quiet = options.quiet;
    RenderSettings settings = settingsAt(frame, picture, scene, one.orbit);
    settings.on_long_compile = compileReporter(progress);
    if (i == 0 && measuresExposure(options, options.scene))
      exposure = renderer.measureExposure(settings, stats);
    stats.measured_exposure = exposure;
    if (makes_files) {
      picture.output = frameFile(picture.output, int(i) + 1);
      picture.stats = frameFile(picture.stats, int(i) + 1);
      checkOutput(picture);
      renderPicture(renderer, devices.front(), picture, settings, nullptr, progress, {}, stats);
      progress.clear();
      reportStats(picture, stats, frame);
      stats = laterStats(command);
      continue;
    }
    panels.push_back(renderPanel(renderer, picture, withExposure(settings, stats), stats));
    labels.push_back(fmt::format("{}", fmt::join(all[i], ", ")));
    brief.push_back(briefLabel(all[i]));
    if (panels.back().width != panels[0].width || panels.back().height != panels[0].height)
      throw InputError("--sweep: the pictures differ in size; expected --size");
  }
  progress.clear();
  if (makes_files) return;
  const Image sheet = labelledSheet(panels, labels, brief, sweepColumns(sweeps));
  writeImage(sheet, options.output, pictureMetadata(stats, devices.front()), fileOptions(options));
  if (logsEvents())
    logEvent("sheet_done", {{"file", options.output},
                            {"pictures", panels.size()},
                            {"width", sheet.width},
                            {"height", sheet.height},
                            {"milliseconds", eventMilliseconds(millisecondsSinceStart())}});
  else if (!options.quiet)
    fmt::print(stderr, "{}: {} picture{} of {}x{}, {}{:.0f} ms\n", options.output, panels.size(),
               panels.size() == 1 ? "" : "s", panels[0].width, panels[0].height,
               exposure ? fmt::format("all with the exposure of the first, {:+.2f} stops, ", *exposure) : "",
               millisecondsSinceStart());
}

}  // namespace

void addRenderCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("render", "a picture of a scene, or one a frame");
  auto options = std::make_shared<RenderOptions>();
  options->chooses_lights = true;
  command
      ->add_option("SCENE", options->scene, "a .json, .obj, .gltf or .glb file (- : JSON on standard input)")
      ->required();
  addPictureOptions(*command, *options,
                    kViewOptions | kSampleOption | kModelOptions | kShadeOptions | kCastOption |
                        kDeviceOption | kExactOption);
  addScreenOption(*command, *options);
  command->add_option(
      "--frames", options->frames,
      "frame A, frames A-B, each Nth of them, A-BxN, or a list of these, 1,3,10-100x5, of a scene that moves "
      "(default: 1); #### or %04d in the output's name (and that of --stats) becomes the number; a frame "
      "that "
      "fails is told and the others are made");
  addOrbitOption(*command, options->orbit);
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
  command
      ->add_option(
          "--sweep", options->sweeps,
          "a picture for each of several values of a place (see --set), in one sheet with labels, such as "
          "materials.box.shininess=4,16,64; given twice the second goes from row to row; with # in "
          "the output's name a file each")
      ->expected(1)
      ->take_all()
      ->type_name("PATH=VALUE,...");
  command->callback([&context, options] {
    options->frames = framesOf(options->frames, options->orbit);
    const FrameChoice choice = chosenFrames(options->frames);
    if (choice.is_list && !options->sweeps.empty())
      throw InputError("--sweep: makes pictures of one frame, such as --frames 7");
    // Of a sweep # is the place of a picture's number, not of the frame's.
    if (!choice.is_list && options->sweeps.empty()) useFrame(*options, "render");
    checkOptions(*options, choice);
    if (!options->sweeps.empty()) {
      readSweeps(options->sweeps);  // before a device is opened
      Stats stats;
      stats.command = context.command_line;
      return renderSweep(startDevices(*options, context, false), *options, choice.frames.front(),
                         std::move(stats));
    }
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
      // Before any work is done: what other runs make from here on is theirs.
      if (!is_film) claims.emplace(hashPattern(options->output));
    }
    Stats stats;
    stats.command = context.command_line;
    const std::vector<OpenedDevice*> devices = startDevices(*options, context, !choice.is_list);
    OpenedDevice& device = *devices.front();
    Renderer renderer = makeRenderer(
        devices, timed(stats, Stage::kLoadScene, [&] {
          return openLitScene(options->scene, choice.is_list ? 1 : choice.frames.front(), *options);
        }));
    Scene& scene = renderer.scene();
    warnOfDither(scene, *options);
    setMiddle(scene, choice.frames.front(), options->orbit);
    if (choice.is_list) {
      // Before any frame: what is wrong with it is so with all.
      const std::vector<PictureOptions> pictures = optionsOfCameras(*options, scene);
      renderSettings(pictures.front(), scene);
      if (is_film && pictures.size() > 1)
        throw InputError(
            fmt::format("--camera all: a film is of one camera, and {} has {}", scene.name, pictures.size()));
      awaitDevice(device);
      for (const OpenedDevice* one : devices) logDevice(one->description);
      // By the first frame of all, also of those that aren't made here: every shard measures the same.
      chooseLightCounts(renderer, choice.frames.front(), *options, pictures, stats);
      const auto exposures = chooseExposures(renderer, choice.frames.front(), *options, pictures, stats);
      context.status = is_film ? renderFilm(renderer, &device, *options, frames, exposures, std::move(stats))
                               : renderFrames(renderer, &device, *options, frames, exposures, nullptr,
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
    chooseLightCounts(renderer, frame, *options, pictures, stats);
    const auto exposures = chooseExposures(renderer, frame, *options, pictures, stats);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      ProgressLine progress(options->quiet);
      progress.frame = frame;
      const auto showPass = [&](int done, int passes) {
        // The first pass needed it.
        if (!std::exchange(device_is_told, true))
          for (const OpenedDevice* one : devices) logDevice(one->description);
        progress.show(std::filesystem::path(pictures[i].output).filename(), std::size_t(done),
                      std::size_t(passes));
      };
      stats.measured_exposure = exposures[i];
      renderPicture(renderer, &device, pictures[i], settingsAt(frame, pictures[i], scene, options->orbit),
                    nullptr, progress, showPass, stats);
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
  auto scene_path = std::make_shared<std::string>(), layer = std::make_shared<std::string>();
  command->add_option("SCENE", *scene_path, "a .json, .obj, .gltf or .glb file (- : JSON on standard input)")
      ->required();
  command
      ->add_option("--aov", *layer,
                   "of a picture that isn't an EXR: the layer to show, such as normal, position or depth")
      ->type_name("LAYER");
  addModelOption(*command, *options);
  addSurfaceOption(*command, *options);
  addPictureOptions(*command, *options, kViewOptions | kCastOption | kDeviceOption | kFrameOption);
  command->callback([&context, options, scene_path, layer] {
    const int frame = useFrame(*options, "gbuffer");
    checkDataOutput(*options, "a G-buffer");
    const bool shows_layer = outputFormat(options->output, options->value("format")).extension != "exr";
    if (shows_layer && layer->empty())
      throw InputError(fmt::format(
          "{}: a G-buffer has many layers, expected .exr, or --aov to say which to show, such as normal",
          options->output));
    if (!shows_layer && !layer->empty())
      throw InputError(
          fmt::format("--aov {}: {} has all layers; leave it out, or name a picture, such as .png", *layer,
                      options->output));
    Stats stats;
    stats.command = context.command_line;
    const Scene scene =
        timed(stats, Stage::kLoadScene, [&] { return openLitScene(*scene_path, frame, *options); });
    const std::vector<PictureOptions> pictures = optionsOfCameras(*options, scene);
    // Rasterizing needs no device, but Gouraud shading lights vertices, and --surface changes what is drawn.
    OpenedDevice& device = context.device;
    const bool needs_device = options->value("shading") == "gouraud" || !options->surfaces.empty();
    if (needs_device) {
      openDevice(options->device, device);
      addStage(stats, Stage::kOpenDevice, device.milliseconds_to_open);
      logDevice(device.description);
    }
    logEvent("frame_begun", {{"frame", frame}});
    for (const PictureOptions& picture : pictures) {
      checkDataOutput(picture, "a G-buffer");
      const RenderSettings settings = renderSettings(picture, scene);
      if (needs_device) stats.device = device.description;
      const GBuffer gbuffer = rasterizeScene(needs_device ? &device : nullptr, scene, settings, stats);
      timed(stats, Stage::kWrite, [&] {
        if (shows_layer) return showGBuffer(gbuffer, *layer, picture, stats);
        writeGBuffer(gbuffer, picture.output, pictureMetadata(stats, needs_device ? &device : nullptr),
                     picture.value("format"), picture.value("compression"));
      });
      reportFaults(picture, stats);
      reportStats(picture, stats, frame);
      stats = laterStats(context.command_line);
    }
  });
}

}  // namespace luciole
