// luciole show: a layer of an EXR as a picture.
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "base/clock.hpp"
#include "base/machine_memory.hpp"
#include "image/exposure.hpp"
#include "image/exr_input.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/picture_output.hpp"
#include "tools/viewing/shown_layer.hpp"

namespace luciole {
namespace {

struct ShowOptions : PictureOptions {
  std::string input;
  std::string layer;
};

/// The layer's channels, side by side in each pixel.
Image readLayer(ExrInput& input, const ShownLayer& layer) {
  const PicturePart& part = input.parts()[std::size_t(layer.part)];
  const ChannelPlanes planes = input.read(layer.part, layer.channels);
  const std::size_t channels = layer.channels.size(), pixels = planes.size() / channels;
  requireMemory(double(planes.size()) * sizeof(float),
                fmt::format("a picture of {} x {} pixels", part.size.x, part.size.y));
  Image image{part.size.x, part.size.y, {}, {}, part.picture_size, part.crop_origin};
  for (const int channel : layer.channels) image.channels.push_back(part.channels[std::size_t(channel)]);
  image.pixels.resize(planes.size());
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t p = 0; p < pixels; ++p) image.pixels[p * channels + c] = planes[c * pixels + p];
  return image;
}

void show(const CommandContext& context, const ShowOptions& options) {
  checkOutput(options);
  ExrInput input(options.input);
  const ShownLayer layer = findShownLayer(input.parts(), options.layer, options.input);
  Stats stats;
  stats.command = context.command_line;
  writeLayerPicture(options, layer, readLayer(input, layer), stats, nullptr);
  if (!options.quiet && !logsEvents())
    fmt::print(stderr, "{}: {} of {}, {:.0f} ms\n", options.output, layer.name, options.input,
               millisecondsSinceStart());
}

}  // namespace

void addShowCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command =
      app.add_subcommand("show", "a layer of an EXR as a picture: normals, depths, counts, ids, light ...");
  auto options = std::make_shared<ShowOptions>();
  command->add_option("IN", options->input, "an EXR of here or of another program")->required();
  command
      ->add_option(
          "--layer", options->layer,
          "which, by its name or what it holds, such as normal (default: the colours; an error lists "
          "the layers)")
      ->type_name("NAME");
  addPictureOptions(*command, *options, kColorOptions);
  command->callback([&context, options] { show(context, *options); });
}

}  // namespace luciole
