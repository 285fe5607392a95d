#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "base/split.hpp"
#include "base/text_file.hpp"
#include "base/write_file.hpp"
#include "image/exposure.hpp"
#include "luciole/error.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/mix_page.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/picture_output.hpp"
#include "tools/cli/suggest.hpp"
#include "tools/viewing/light_mixer.hpp"

namespace luciole {
namespace {

constexpr double kLargestFactor = 1e9;

struct MixOptions : PictureOptions {
  std::string input;
  std::string mixer;
};

/// The number that all of a text is; NaN for another text.
double typedNumber(const std::string& text) {
  double number = 0;
  const char* const text_end = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), text_end, number);
  return error == std::errc() && end == text_end ? number : std::nan("");
}

/// Sets the terms that --light-mixer names: GROUP=FACTOR or GROUP=FACTOR:#rrggbb, by commas. Throws
/// InputError.
void readMixer(const std::string& text, const std::string& file, std::vector<MixerTerm>& terms) {
  if (text.empty()) return;
  for (const std::string& part : split(text, ',')) {
    const std::size_t equals = part.find('='), colon = part.find(':', equals);
    const std::string name = part.substr(0, equals);
    const auto refuse = [&](const std::string& what) {
      throw InputError(fmt::format("--light-mixer {}: {}", forMessage(part), what));
    };
    if (equals == std::string::npos || name.empty())
      refuse("expected GROUP=FACTOR or GROUP=FACTOR:#rrggbb, such as key=2,rim=0.5:#ffaa88");
    const auto term =
        std::find_if(terms.begin(), terms.end(), [&](const MixerTerm& one) { return one.group == name; });
    if (term == terms.end()) {
      std::vector<std::string> names;
      for (const MixerTerm& one : terms) names.push_back(forMessage(one.group));
      const std::string suggestion = didYouMean(name, names);
      const std::string others = names.size() > 16 ? fmt::format("{} others", names.size())
                                                   : fmt::format("{}", fmt::join(names, ", "));
      refuse(fmt::format("{} has no such group, only {}{}", file, others, suggestion));
    }
    term->factor =
        typedNumber(part.substr(equals + 1, colon == std::string::npos ? colon : colon - equals - 1));
    if (!(term->factor >= 0 && term->factor <= kLargestFactor))
      refuse(fmt::format("expected a factor from 0 to {}", kLargestFactor));
    if (colon == std::string::npos) continue;
    term->color = part.substr(colon + 1);
    if (!linearColor(term->color)) refuse("expected a colour #rrggbb behind the colon, as sRGB has it");
  }
}

bool isPage(const MixOptions& options) {
  const std::string& path = options.output;
  return options.value("format") == "html" ||
         (options.value("format").empty() && (path.ends_with(".html") || path.ends_with(".htm")));
}

void writePicture(const CommandContext& context, MixOptions& options, const std::vector<MixerTerm>& terms) {
  std::vector<GroupFactor> factors;
  for (const MixerTerm& term : terms)
    factors.push_back({term.group, float(term.factor) * *linearColor(term.color)});
  WriteOptions how = fileOptions(options);
  Image image = mixLights(options.input, factors, how);
  expose(image, exposureOf(options));
  how.alpha = image.channels.size() == 4;
  Stats stats;
  stats.command = context.command_line;
  const std::uint64_t limited = writeImage(image, options.output, pictureMetadata(stats, nullptr), how);
  reportHalves(options, limited, stats);
}

void mix(const CommandContext& context, MixOptions& options) {
  const bool is_page = isPage(options);
  if (is_page)
    checkPlace(options.output);
  else
    checkOutput(options);
  std::vector<MixerTerm> terms;
  for (const GroupFactor& group : lightGroupsOf(options.input)) terms.push_back({group.group});
  readMixer(options.mixer, options.input, terms);
  if (is_page)
    writeTextFile(options.output, mixPage(options.input, terms, exposureOf(options)));
  else
    writePicture(context, options, terms);
  if (!options.quiet && !logsEvents())
    writeError(fmt::format("{}: {} groups of lights, {:.0f} ms\n", options.output, terms.size(),
                           millisecondsSinceStart()));
}

}  // namespace

void addMixCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "mix", "weigh a picture's groups of lights anew, without shading, or on a page with sliders");
  auto options = std::make_shared<MixOptions>();
  command->add_option("IN", options->input, "an EXR that --light-groups wrote")->required();
  command
      ->add_option(
          "--light-mixer", options->mixer,
          "GROUP=FACTOR,...: what groups' light is multiplied by, and the sRGB colour that tints it, such "
          "as key=2,rim=0.5:#ffaa88; default is of lights without a group, rest of what no light gives "
          "(default: 1 for each)")
      ->type_name("GROUP=FACTOR[:#rrggbb],...");
  addPictureOptions(*command, *options, kColorOptions);
  command->callback([&context, options] { mix(context, *options); });
}

}  // namespace luciole
