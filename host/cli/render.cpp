#include <fmt/format.h>
#include <unistd.h>

#include <optional>

#include "cli/commands.hpp"
#include "cli/picture_options.hpp"
#include "error.hpp"
#include "image/gbuffer_file.hpp"
#include "render/render.hpp"
#include "scene/load_scene.hpp"

namespace luciole {
namespace {

/// One line that is rewritten pass by pass, on a terminal only.
void showProgress(int done, int passes) {
  fmt::print(stderr, "\r{} % of the picture{}", std::int64_t(100) * done / passes,
             done == passes ? "\r\x1b[K" : "");
  std::fflush(stderr);
}

}  // namespace

void addRenderCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("render", "a picture of a scene");
  auto options = std::make_shared<PictureOptions>();
  auto scene_path = std::make_shared<std::string>();
  command->add_option("SCENE", *scene_path, "a .json, .obj, .gltf or .glb file (- : JSON on standard input)")
      ->required();
  addPictureOptions(*command, *options,
                    kViewOptions | kSampleOption | kModelOptions | kShadeOptions | kDeviceOption);
  command->callback([&context, options, scene_path] {
    checkOutput(*options);
    Stats stats;
    stats.command = context.command_line;
    Device device;
    startDevice(options->device, device);
    const Scene scene = timed(stats, "load scene", [&] { return loadScene(*scene_path); });
    RenderSettings settings = renderSettings(*options, scene);
    if (!options->quiet && isatty(STDERR_FILENO)) settings.on_pass = showProgress;
    const glm::ivec2 size =
        settings.crop ? glm::ivec2(settings.crop->width, settings.crop->height) : settings.size;
    std::optional<ImageWriter> writer;
    const auto write = [&](const Image& rows) {
      timed(stats, "write", [&] {
        if (!writer)
          writer.emplace(options->output, size.x, size.y, rows.channels,
                         pictureMetadata(context.command_line, &device));
        writer->write(rows);
      });
    };
    renderBands(device, scene, settings, write, stats);
    timed(stats, "write", [&] { writer->close(); });
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
  addPictureOptions(*command, *options, kViewOptions | kDeviceOption);
  command->callback([&context, options, scene_path] {
    checkOutput(*options);
    Stats stats;
    stats.command = context.command_line;
    const Scene scene = timed(stats, "load scene", [&] { return loadScene(*scene_path); });
    const RenderSettings settings = renderSettings(*options, scene);
    // Only Gouraud shading needs a device to rasterize: it lights the vertices.
    Device device;
    const bool lit = settings.shading == Shading::kGouraud;
    if (lit) {
      timed(stats, "open device", [&] { openDevice(options->device, device); });
      stats.device = device.description;
    }
    const GBuffer gbuffer = rasterizeScene(lit ? &device : nullptr, scene, settings, stats);
    timed(stats, "write", [&] {
      writeGBuffer(gbuffer, options->output, pictureMetadata(context.command_line, lit ? &device : nullptr));
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
  addPictureOptions(*command, *options, kModelOptions | kShadeOptions | kDeviceOption);
  command->callback([&context, options, gbuffer_path, scene_path] {
    checkOutput(*options);
    Stats stats;
    stats.command = context.command_line;
    Device device;
    startDevice(options->device, device);
    const Scene scene = timed(stats, "load scene", [&] { return loadScene(*scene_path); });
    const GBuffer gbuffer = timed(stats, "read G-buffer", [&] { return readGBuffer(*gbuffer_path); });
    const RenderSettings settings = renderSettings(*options, scene);
    const Image image = shadeGBuffer(device, scene, gbuffer, settings, stats);
    timed(stats, "write",
          [&] { writeImage(image, options->output, pictureMetadata(context.command_line, &device)); });
    reportStats(*options, stats);
  });
}

}  // namespace luciole
