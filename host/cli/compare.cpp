#include "image/compare.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.hpp"
#include "error.hpp"
#include "image/write_file.hpp"

namespace luciole {
namespace {

struct CompareOptions {
  std::string a, b, difference, json;
  std::optional<double> max_abs;
};

constexpr float kDifferenceGain = 10.0f;

/// JSON has no infinity: an infinite figure becomes null.
nlohmann::ordered_json figure(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json differenceJson(const ImageDifference& d) {
  nlohmann::ordered_json json;
  json["max_abs"] = figure(d.max_abs);
  json["mean_abs"] = figure(d.mean_abs);
  json["mean_signed"] = figure(d.mean_signed);
  json["rmse"] = figure(d.rmse);
  json["psnr"] = figure(d.psnr);
  json["relmse"] = figure(d.relmse);
  json["p99_abs"] = figure(d.p99_abs);
  json["p999_abs"] = figure(d.p999_abs);
  json["nonfinite"] = d.nonfinite;
  json["pixels_over"] = {{"half_step", d.over[0]}, {"one_step", d.over[1]}, {"four_steps", d.over[2]}};
  json["worst_pixel"] = d.worst_pixel;
  return json;
}

void compareFiles(const CompareOptions& options, CommandContext& context) {
  const Image a = readImage(options.a);
  const Image b = readImage(options.b);
  const ImageDifference d = compareImages(a, b);
  if (!options.difference.empty())
    writeImage(differencePicture(a, b, kDifferenceGain), options.difference,
               {{"ImageDescription", context.command_line}});
  if (!options.json.empty()) writeTextFile(options.json, differenceJson(d).dump(2) + "\n");
  if (options.json != "-")
    fmt::print(
        "max_abs {:.6g} at ({}, {})\nmean_abs {:.6g}\nmean_signed {:.6g}\nrmse {:.6g}\npsnr {:.2f} "
        "dB\nrelmse {:.6g}\n"
        "p99_abs {:.6g}\np999_abs {:.6g}\nnonfinite {}\npixels over 1/2, 1, 4 steps of 8 bits: {}, {}, {}\n",
        d.max_abs, d.worst_pixel[0], d.worst_pixel[1], d.mean_abs, d.mean_signed, d.rmse, d.psnr, d.relmse,
        d.p99_abs, d.p999_abs, d.nonfinite, d.over[0], d.over[1], d.over[2]);
  if (options.max_abs && (d.nonfinite > 0 || !(d.max_abs <= *options.max_abs))) context.status = kDifferent;
}

}  // namespace

void addCompareCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command =
      app.add_subcommand("compare", "two pictures in numbers, in linear light; exit 1 over a limit");
  auto options = std::make_shared<CompareOptions>();
  command->add_option("A", options->a, "the picture to hold against")->required();
  command->add_option("B", options->b, "the picture to judge")->required();
  command->add_option("--max-abs", options->max_abs, "the largest difference that still passes")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--diff", options->difference, "write |B - A| x 10 as a picture");
  command->add_option("--json", options->json, "write the figures as JSON (- : standard output)");
  command->callback([&context, options] { compareFiles(*options, context); });
}

}  // namespace luciole
