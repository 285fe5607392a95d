// luciole show: a layer of an EXR as a picture.
#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "base/clock.hpp"
#include "image/exposure.hpp"
#include "image/exr_input.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/open_devices.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/picture_output.hpp"
#include "tools/cli/profile_picture.hpp"
#include "tools/viewing/shown_layer.hpp"

namespace luciole {
namespace {

struct ShowOptions : PictureOptions {
  std::string input;
  std::string layer;
};

void show(CommandContext& context, const ShowOptions& options) {
  checkOutput(options);
  if (isProfile(options.input)) {
    startCheckedDevice(options, context, true);
    writeImage(profilePicture(context.device, options.input), options.output, {}, fileOptions(options));
    return;
  }
  ExrInput input(options.input);
  const ShownLayer layer = findShownLayer(input.parts(), options.layer, options.input);
  Stats stats;
  stats.command = context.command_line;
  writeLayerPicture(options, layer, readShownLayer(input, layer), stats, nullptr);
  if (!options.quiet && !logsEvents())
    fmt::print(stderr, "{}: {} of {}, {:.0f} ms\n", options.output, layer.name, options.input,
               millisecondsSinceStart());
}

}  // namespace

void addShowCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "show", "a layer of an EXR as a picture: normals, depths, counts, ids, light ...; or a lamp's profile");
  auto options = std::make_shared<ShowOptions>();
  command
      ->add_option("IN", options->input,
                   "an EXR of here or of another program; or a lamp's profile, .ies or .ldt")
      ->required();
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
