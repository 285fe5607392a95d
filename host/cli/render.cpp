#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "cl/kernel_cache.hpp"
#include "cli/commands.hpp"
#include "cli/frame_claims.hpp"
#include "cli/frames.hpp"
#include "cli/picture_options.hpp"
#include "cli/progress.hpp"
#include "cli/shard.hpp"
#include "gbuffer/gbuffer_file.hpp"
#include "render/render.hpp"
#include "scene/pose.hpp"

namespace luciole {
namespace {

struct RenderOptions : PictureOptions {
  std::string scene;
  std::string shard;
  bool resume = false;
};

/// Renders the scene at its frame and writes the picture.
void renderPicture(Device& device, const Scene& scene, const PictureOptions& options,
                   const std::function<void(int, int)>& on_pass, Stats& stats) {
  RenderSettings settings = renderSettings(options, scene);
  settings.on_pass = on_pass;
  const Crop window = settings.crop.value_or(Crop{0, 0, settings.size.x, settings.size.y});
  std::optional<ImageWriter> writer;
  const auto write = [&](const Image& rows) {
    timed(stats, Stage::kWrite, [&] {
      if (!writer)
        writer.emplace(options.output, window.width, window.height, rows.channels,
                       pictureMetadata(stats.command, &device),
                       writeOptions(options, settings.camera, settings.size, {window.x, window.y}));
      writer->write(rows);
    });
  };
  renderBands(device, scene, settings, write, stats);
  const std::uint64_t limited = timed(stats, Stage::kWrite, [&] { return writer->close(); });
  reportHalves(options, limited, stats);
}

/// Frames as text with ranges: "3, 7-9" for 3 7 8 9.
std::string listFrames(const std::vector<int>& frames) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    std::size_t end = i + 1;
    while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", frames[i]);
    if (end - i > 1) text += fmt::format("-{}", frames[end - 1]);
    i = end;
  }
  return text;
}

/// Whether a frame's file exists. Files are written as a whole or not at all, so such a frame is done.
bool isDone(const std::string& path) {
  std::error_code none;
  return std::filesystem::is_regular_file(path, none) && std::filesystem::file_size(path, none) > 0;
}

/// The frames of this run's shard, without those that --resume finds done.
std::vector<int> framesToMake(const RenderOptions& options, const std::vector<int>& all, const Shard& shard) {
  if (options.shard.empty() && shard.count > 1 && !options.quiet)
    fmt::print(stderr, "shard {}/{} of the frames, as task of a Slurm array\n", shard.index + 1, shard.count);
  std::vector<int> frames, done;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!isMine(shard, i)) continue;
    const bool is_done = options.resume && isDone(frameFile(options.output, all[i]));
    (is_done ? done : frames).push_back(all[i]);
  }
  if (!done.empty() && !options.quiet)
    fmt::print(stderr, "there already: {} of {} frames\n", done.size(), done.size() + frames.size());
  return frames;
}

/// Renders frame after frame. A frame that fails is reported and left out. claims: null unless other runs may
/// be at work beside this one. started: the cost of loading, which goes into the first frame's statistics.
/// Returns the exit status of the first failure. Throws InputError for a frame that another run has claimed.
int renderFrames(Device& device, Scene& scene, const RenderOptions& options, const std::vector<int>& frames,
                 FrameClaims* claims, Stats started) {
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
    showPass(0, 1);
    PictureOptions one = options;
    one.output = frameFile(options.output, frames[i]);
    one.stats = frameFile(options.stats, frames[i]);
    Stats stats = std::exchange(started, Stats{});
    stats.command = command;
    if (i > 0) stats.began = millisecondsSinceStart();
    try {
      checkOutput(one);
      poseScene(scene, frames[i]);
      renderPicture(device, scene, one, showPass, stats);
      progress.clear();
      reportStats(one, stats);
    } catch (const std::exception&) {
      progress.clear();
      const int why = tellFailure(fmt::format("frame {}", frames[i]));
      if (status == kDone) status = why;
      failed.push_back(frames[i]);
    }
  }
  if (!failed.empty())
    fmt::print(stderr, "luciole: {} of {} frames failed: {}\n", failed.size(), frames.size(),
               listFrames(failed));
  return status;
}

void checkOptions(const RenderOptions& options, const FrameChoice& choice) {
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
  addPictureOptions(
      *command, *options,
      kViewOptions | kSampleOption | kModelOptions | kShadeOptions | kCastOption | kDeviceOption);
  command->add_option(
      "--frames", options->frames,
      "frame A, frames A-B, each Nth of them, A-BxN, or a list of these, 1,3,10-100x5, of a scene that moves "
      "(default: 1); #### or %04d in the output's name (and that of --stats) becomes the number; a frame "
      "that "
      "fails is told and the others are made");
  command->add_flag("--resume", options->resume, "leave frames alone whose file is there");
  command->add_option("--shard", options->shard,
                      "I/N: only every Nth of the frames, from the Ith on (default in a Slurm job array: its "
                      "tasks share them)");
  command->callback([&context, options] {
    const FrameChoice choice = chosenFrames(options->frames);
    if (!choice.is_list) useFrame(*options, "render");
    checkOptions(*options, choice);
    std::vector<int> frames;
    std::optional<FrameClaims> claims;
    if (choice.is_list) {
      const Shard shard = chosenShard(options->shard);
      frames = framesToMake(*options, choice.frames, shard);
      if (frames.empty()) return;
      if (shard.is_chosen) claims.emplace(options->output).claim(frames.front());  // before any work is done
    }
    Stats stats;
    stats.command = context.command_line;
    Device device;
    startDevice(options->device, device);
    Scene scene = timed(stats, Stage::kLoadScene, [&] {
      return openLitScene(options->scene, choice.is_list ? 1 : choice.frames.front(), *options);
    });
    if (choice.is_list) {
      renderSettings(*options, scene);  // before any frame: what is wrong with it is so with all
      awaitDevice(device);
      context.status =
          renderFrames(device, scene, *options, frames, claims ? &*claims : nullptr, std::move(stats));
      return;
    }
    ProgressLine progress(options->quiet);
    const auto showPass = [&](int done, int passes) {
      progress.show(std::filesystem::path(options->output).filename(), std::size_t(done),
                    std::size_t(passes));
    };
    renderPicture(device, scene, *options, showPass, stats);
    progress.clear();
    reportStats(*options, stats);
  });
}

void addGBufferCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command =
      app.add_subcommand("gbuffer", "stop after rasterizing: positions, normals and materials as an EXR");
  auto options = std::make_shared<PictureOptions>();
  auto scene_path = std::make_shared<std::string>();
  command->add_option("SCENE", *scene_path, "a .json, .obj, .gltf or .glb file (- : JSON on standard input)")
      ->required();
  addPictureOptions(*command, *options, kViewOptions | kCastOption | kDeviceOption | kFrameOption);
  command->callback([&context, options, scene_path] {
    const int frame = useFrame(*options, "gbuffer");
    checkDataOutput(*options, "a G-buffer");
    Stats stats;
    stats.command = context.command_line;
    const Scene scene =
        timed(stats, Stage::kLoadScene, [&] { return openLitScene(*scene_path, frame, *options); });
    const RenderSettings settings = renderSettings(*options, scene);
    // Only Gouraud shading needs a device to rasterize: it lights the vertices.
    Device device;
    const bool lit = settings.shading == Shading::kGouraud;
    if (lit) {
      timed(stats, Stage::kOpenDevice, [&] { openDevice(options->device, device); });
      stats.device = device.description;
    }
    const GBuffer gbuffer = rasterizeScene(lit ? &device : nullptr, scene, settings, stats);
    timed(stats, Stage::kWrite, [&] {
      writeGBuffer(gbuffer, options->output, pictureMetadata(context.command_line, lit ? &device : nullptr),
                   options->format, options->compression);
    });
    reportStats(*options, stats);
  });
}

void addShadeCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("shade", "light a G-buffer, from here or from another renderer");
  auto options = std::make_shared<PictureOptions>();
  auto gbuffer_path = std::make_shared<std::string>();
  auto scene_path = std::make_shared<std::string>();
  command->add_option("GBUFFER", *gbuffer_path, "an EXR with channels P and N, or Z and N and a camera")
      ->required();
  command->add_option("--scene", *scene_path, "the scene whose lights, ambient, fog and shadow casters count")
      ->required();
  addPictureOptions(*command, *options,
                    kModelOptions | kShadeOptions | kCastOption | kDeviceOption | kFrameOption);
  command->callback([&context, options, gbuffer_path, scene_path] {
    const int frame = useFrame(*options, "shade");
    checkOutput(*options);
    Stats stats;
    stats.command = context.command_line;
    Device device;
    startDevice(options->device, device);
    const Scene scene =
        timed(stats, Stage::kLoadScene, [&] { return openScene(*scene_path, frame, *options); });
    const GBuffer gbuffer = timed(stats, Stage::kReadGBuffer, [&] { return readGBuffer(*gbuffer_path); });
    const RenderSettings settings = renderSettings(*options, scene);
    const Image image = shadeGBuffer(device, scene, gbuffer, settings, stats);
    const std::uint64_t limited = timed(stats, Stage::kWrite, [&] {
      return writeImage(image, options->output, pictureMetadata(context.command_line, &device),
                        writeOptions(*options, gbuffer));
    });
    reportHalves(*options, limited, stats);
    reportStats(*options, stats);
  });
}

}  // namespace luciole
