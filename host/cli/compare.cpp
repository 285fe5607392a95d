#include "image/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/write_file.hpp"
#include "cli/commands.hpp"
#include "image/heat_map.hpp"

namespace luciole {
namespace {

struct CompareOptions {
  std::string a, b, difference, error_map, json;
  std::optional<double> max_abs;
};

constexpr float kDifferenceGain = 10.0f;

/// The reason why a figure is infinite, for people.
const char* whyInfinite(const std::string& name, const ImageDifference& d) {
  if (name == "psnr" && d.rmse == 0) return "no finite value differs";
  return d.nonfinite > 0 ? "a pixel of one picture alone is not finite"
                         : "A is black, of which nothing is a share";
}

/// JSON has no infinity: an infinite figure becomes null, with a reason beside it.
nlohmann::ordered_json differenceJson(const ImageDifference& d) {
  nlohmann::ordered_json json, reasons;
  json["channels"] = d.channels;
  json["pixels"] = d.pixels;
  for (const auto& [name, value] : {std::pair("max_abs", d.max_abs),
                                    {"mean_abs", d.mean_abs},
                                    {"max_relative", d.max_relative},
                                    {"mean_relative", d.mean_relative},
                                    {"mean_signed", d.mean_signed},
                                    {"rmse", d.rmse},
                                    {"psnr", d.psnr},
                                    {"relmse", d.relmse},
                                    {"p99_abs", d.p99_abs},
                                    {"p999_abs", d.p999_abs}}) {
    if (std::isfinite(value)) {
      json[name] = value;
    } else {
      json[name] = nullptr;
      reasons[name] = whyInfinite(name, d);
    }
  }
  if (!reasons.empty()) json["reasons"] = reasons;
  json["nonfinite"] = d.nonfinite;
  json["pixels_over"] = {{"half_step", d.over[0]}, {"one_step", d.over[1]}, {"four_steps", d.over[2]}};
  json["worst_pixel"] = d.worst_pixel;
  return json;
}

void checkOptions(const CompareOptions& options) {
  if (options.max_abs && !(*options.max_abs >= 0))
    throw InputError("--max-abs: expected a number that is at least 0");
  if (!options.json.empty()) checkPlace(options.json);
  for (const std::string* path : {&options.difference, &options.error_map}) {
    if (path->empty()) continue;
    checkWritable(*path);
    const auto outputs = {&options.difference, &options.error_map, &options.json};
    if (std::count_if(outputs.begin(), outputs.end(), [&](const auto* other) { return *other == *path; }) > 1)
      throw InputError(fmt::format("{}: named for two outputs, expected one", *path));
  }
}

ImageDifference compareNamed(const CompareOptions& options, const Image& a, const Image& b) {
  try {
    return compareImages(a, b);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}, {}: {}", options.a, options.b, error.what()));
  }
}

void printFigures(const ImageDifference& d) {
  fmt::print("{} of {} pixels, channels {}\n", d.pixels, d.of_pixel.size(), fmt::join(d.channels, " "));
  fmt::print("max_abs {:.6g} at ({}, {})\nmean_abs {:.6g}\n", d.max_abs, d.worst_pixel[0], d.worst_pixel[1],
             d.mean_abs);
  fmt::print("max_relative {:.6g}\nmean_relative {:.6g}\n", d.max_relative, d.mean_relative);
  fmt::print("mean_signed {:.6g}\nrmse {:.6g}\npsnr {:.2f} dB\nrelmse {:.6g}\n", d.mean_signed, d.rmse,
             d.psnr, d.relmse);
  fmt::print("p99_abs {:.6g}\np999_abs {:.6g}\nnonfinite {}\n", d.p99_abs, d.p999_abs, d.nonfinite);
  fmt::print("pixels over 1/2, 1, 4 steps of 8 bits: {}, {}, {}\n", d.over[0], d.over[1], d.over[2]);
}

void compareFiles(const CompareOptions& options, CommandContext& context) {
  checkOptions(options);
  const Image a = readImage(options.a);
  const Image b = readImage(options.b);
  const ImageDifference d = compareNamed(options, a, b);
  const Metadata metadata{{"ImageDescription", context.command_line}};
  // Both are made before either is written, so that a failure leaves no file.
  const bool wants_difference = !options.difference.empty(), wants_map = !options.error_map.empty();
  const Image difference = wants_difference ? differencePicture(a, b, kDifferenceGain) : Image{};
  const Image error_map = wants_map ? errorMap(d) : Image{};
  if (wants_difference)
    writeImage(difference, options.difference, metadata,
               {.picture_size = a.picture_size, .crop_origin = a.crop_origin});
  if (wants_map) writeImage(error_map, options.error_map, metadata);
  if (!options.json.empty()) writeTextFile(options.json, differenceJson(d).dump(2) + "\n");
  if (options.difference != "-" && options.error_map != "-" && options.json != "-") printFigures(d);
  if (options.max_abs && (d.nonfinite > 0 || !(d.max_abs <= *options.max_abs))) context.status = kDifferent;
}

}  // namespace

void addCompareCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command =
      app.add_subcommand("compare", "two pictures in numbers, in linear light; exit 1 over a limit");
  auto options = std::make_shared<CompareOptions>();
  command
      ->add_option(
          "A", options->a,
          "the picture to hold against; with a channel `sampled`, only pixels where it is not 0 count")
      ->required();
  command->add_option("B", options->b, "the picture to judge")->required();
  command->add_option("--max-abs", options->max_abs,
                      "the largest difference that still passes, in linear light");
  command->add_option("--diff", options->difference,
                      "write |B - A| x 10 as a picture (- : PNG on standard output)");
  command->add_option("--error-map", options->error_map,
                      "write |B - A| in false colours with a scale bar (- : PNG on standard output)");
  command->add_option("--json", options->json, "write the figures as JSON (- : standard output)");
  command->callback([&context, options] { compareFiles(*options, context); });
}

}  // namespace luciole
