#include "luciole/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/dump_utf8.hpp"
#include "base/write_file.hpp"
#include "image/heat_map.hpp"
#include "image/side_by_side.hpp"
#include "luciole/error.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/difference_json.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/frames.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/suggest.hpp"
#include "tools/figures/text_table.hpp"

namespace luciole {
namespace {

/// The command's options, or what they mean for one frame of a sequence.
struct CompareOptions {
  std::string a, b, difference, error_map, side_by_side, json;
  std::optional<double> max_abs;
  std::vector<std::string> metrics;  ///< to print; empty: all
  std::vector<double> limits;        ///< none, or one for each of `metrics`
};

constexpr float kDifferenceGain = 10.0f;

void checkOptions(const CompareOptions& options) {
  if (options.max_abs && !(*options.max_abs >= 0))
    throw InputError("--max-abs: expected a number that is at least 0");
  if (!options.limits.empty() && options.limits.size() != options.metrics.size())
    throw InputError(fmt::format("--max: {} limits for {} metrics, expected one for each",
                                 options.limits.size(), options.metrics.size()));
  if (!std::all_of(options.limits.begin(), options.limits.end(), [](double limit) { return limit >= 0; }))
    throw InputError("--max: expected numbers that are at least 0");
  if (!options.json.empty()) checkPlace(options.json);
  const auto pictures = {&options.difference, &options.error_map, &options.side_by_side};
  for (const std::string* path : pictures) {
    if (path->empty()) continue;
    checkWritable(*path);
    const auto is_same = [&](const std::string* other) { return *other == *path; };
    if (std::count_if(pictures.begin(), pictures.end(), is_same) > 1 || options.json == *path)
      throw InputError(fmt::format("{}: named for two outputs, expected one", *path));
  }
}

/// Calls a function whose InputErrors don't say which pictures they are about.
template <class Function>
auto ofPictures(const CompareOptions& options, Function&& function) {
  try {
    return function();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}, {}: {}", options.a, options.b, error.what()));
  }
}

/// The ends of two paths, as short as they may be to differ: "f.png" and "g.png", or "old/f.png" and
/// "new/f.png".
std::pair<std::string, std::string> shortNames(const std::filesystem::path& a,
                                               const std::filesystem::path& b) {
  using Parts = std::vector<std::filesystem::path>;
  const Parts parts_of_a(a.begin(), a.end()), parts_of_b(b.begin(), b.end());
  const auto end = [](const Parts& parts, std::size_t count) {
    std::filesystem::path name;
    for (std::size_t i = parts.size() - std::min(count, parts.size()); i < parts.size(); ++i)
      name /= parts[i];
    return name.string();
  };
  for (std::size_t count = 1;; ++count) {
    const std::pair names(end(parts_of_a, count), end(parts_of_b, count));
    if (names.first != names.second || count >= std::max(parts_of_a.size(), parts_of_b.size())) return names;
  }
}

/// Compares two pictures, and writes the pictures of their difference that the options name.
ImageDifference comparePictures(const CompareOptions& options, const std::string& command_line) {
  const Image a = readImage(options.a);
  const Image b = readImage(options.b);
  ImageDifference d = ofPictures(options, [&] { return compareImages(a, b); });
  const Metadata metadata{{"ImageDescription", command_line}};
  // All are made before any is written, so that a failure leaves no file.
  std::vector<std::pair<Image, std::string>> pictures;
  if (!options.difference.empty()) {
    pictures.emplace_back(differencePicture(a, b, kDifferenceGain), options.difference);
    pictures.back().first.picture_size = a.picture_size;
    pictures.back().first.crop_origin = a.crop_origin;
    pictures.back().first.display = a.display;
  }
  if (!options.error_map.empty()) pictures.emplace_back(errorMap(d), options.error_map);
  if (!options.side_by_side.empty()) {
    const auto names = shortNames(options.a, options.b);
    pictures.emplace_back(ofPictures(options, [&] { return sideBySide(a, b, d, names.first, names.second); }),
                          options.side_by_side);
  }
  for (const auto& [picture, path] : pictures)
    writeImage(picture, path, metadata,
               {.picture_size = picture.picture_size,
                .crop_origin = picture.crop_origin,
                .display = picture.display});
  return d;
}

std::vector<std::string> metricNames() {
  std::vector<std::string> names;
  for (const auto& [name, figure] : kImageMetrics) names.emplace_back(name);
  return names;
}

double metricOf(const ImageDifference& d, const std::string& metric) {
  return d.*std::find_if(std::begin(kImageMetrics), std::end(kImageMetrics), [&](const auto& one) {
              return one.first == metric;
            })->second;
}

/// A metric's figure as a number that is larger the more the pictures differ.
double badness(const ImageDifference& d, const std::string& metric) {
  const double figure = metricOf(d, metric);
  return metric == "psnr" ? -figure : std::abs(figure);
}

std::string metricText(const ImageDifference& d, const std::string& metric) {
  if (metric == "psnr") return fmt::format("psnr {:.2f} dB", d.psnr);
  std::string text = fmt::format("{} {:.6g}", metric, metricOf(d, metric));
  if (metric == "max_abs") text += fmt::format(" at ({}, {})", d.worst_pixel[0], d.worst_pixel[1]);
  return text;
}

/// What a picture must keep to pass: the largest of a metric, the least of psnr.
struct Limit {
  std::string metric;
  double value;
  std::string option;  ///< that sets it
};

std::vector<Limit> limitsOf(const CompareOptions& options) {
  std::vector<Limit> limits;
  if (options.max_abs) limits.push_back({"max_abs", *options.max_abs, "--max-abs"});
  for (std::size_t i = 0; i < options.limits.size(); ++i)
    limits.push_back({options.metrics[i], options.limits[i], "--max"});
  return limits;
}

bool isOver(const Limit& limit, const ImageDifference& d) {
  const bool is_least = limit.metric == "psnr";
  return d.nonfinite > 0 || !(badness(d, limit.metric) <= (is_least ? -limit.value : limit.value));
}

const char* overOrUnder(const Limit& limit) { return limit.metric == "psnr" ? "under" : "over"; }

void printFigures(const CompareOptions& options, const ImageDifference& d) {
  if (options.metrics.empty())
    fmt::print("{} of {} pixels, channels {}\n", d.pixels, d.of_pixel.size(), fmt::join(d.channels, " "));
  for (const std::string& metric : options.metrics.empty() ? metricNames() : options.metrics)
    fmt::print("{}\n", metricText(d, metric));
  // Means leave out what isn't finite, so that is told beside any of them.
  if (options.metrics.empty() || d.nonfinite > 0) fmt::print("nonfinite {}\n", d.nonfinite);
  if (options.metrics.empty())
    fmt::print("pixels over 1/2, 1, 4 steps of 8 bits: {}, {}, {}\n", d.over[0], d.over[1], d.over[2]);
}

/// Says in one line which limits are broken, and sets the exit status; nothing where none is.
void reportLimits(const std::vector<std::string>& broken, CommandContext& context) {
  if (broken.empty()) return;
  reportError(fmt::format("{}", fmt::join(broken, "; ")), kDifferent);
  context.status = kDifferent;
}

void compareTwo(const CompareOptions& options, CommandContext& context) {
  checkOptions(options);
  const ImageDifference d = comparePictures(options, context.command_line);
  if (!options.json.empty()) writeTextFile(options.json, dumpUtf8(differenceJson(d), 2) + "\n");
  const auto outputs = {&options.difference, &options.error_map, &options.side_by_side, &options.json};
  if (std::none_of(outputs.begin(), outputs.end(), [](const std::string* path) { return *path == "-"; }))
    printFigures(options, d);
  std::vector<std::string> broken;
  for (const Limit& limit : limitsOf(options))
    if (isOver(limit, d))
      broken.push_back(fmt::format("{} is {} {} {}", metricText(d, limit.metric), overOrUnder(limit),
                                   limit.option, limit.value));
  if (!broken.empty() && d.nonfinite > 0)
    broken = {fmt::format("{} values of one picture or both are not finite", d.nonfinite)};
  reportLimits(broken, context);
}

/// A frame of two sequences, and how they differ there.
struct ComparedFrame {
  int frame = 0;
  ImageDifference difference;  ///< without `of_pixel`
};

/// What one frame of the sequences is compared by.
CompareOptions ofFrame(const CompareOptions& options, int frame) {
  CompareOptions one = options;
  for (std::string* path : {&one.a, &one.b, &one.difference, &one.error_map, &one.side_by_side})
    *path = frameFile(*path, frame);
  return one;
}

/// The frames of both sequences. Throws InputError that names those that one of them lacks.
std::vector<int> framesOfBoth(const CompareOptions& options) {
  const std::vector<int> of_a = framesThere(options.a), of_b = framesThere(options.b);
  if (of_a.empty() && of_b.empty())
    throw InputError(fmt::format("{}, {}: no frame is there", options.a, options.b));
  std::string lacking;
  const auto addLacking = [&](const std::string& pattern, const std::vector<int>& its,
                              const std::vector<int>& others) {
    std::vector<int> missing;
    std::set_difference(others.begin(), others.end(), its.begin(), its.end(), std::back_inserter(missing));
    if (missing.empty()) return;
    lacking += fmt::format("{}{} lacks {} {} of {}", lacking.empty() ? "" : ", and ", pattern,
                           missing.size() == 1 ? "frame" : "frames", listFrames(missing),
                           &pattern == &options.a ? options.b : options.a);
  };
  addLacking(options.a, of_a, of_b);
  addLacking(options.b, of_b, of_a);
  if (!lacking.empty()) throw InputError(lacking);
  return of_a;
}

/// The frame that a metric finds worst; of several the one of the largest mean square, then the first.
const ComparedFrame& worstOf(const std::vector<ComparedFrame>& frames, const std::string& metric) {
  const auto rank = [&](const ComparedFrame& one) {
    return std::tuple(one.difference.nonfinite > 0, badness(one.difference, metric), one.difference.rmse);
  };
  return *std::max_element(frames.begin(), frames.end(),
                           [&](const ComparedFrame& a, const ComparedFrame& b) { return rank(a) < rank(b); });
}

/// The metric that decides which frame is worst.
std::string firstMetric(const CompareOptions& options) {
  return options.metrics.empty() ? "max_abs" : options.metrics.front();
}

nlohmann::ordered_json frameJson(const ComparedFrame& one) {
  nlohmann::ordered_json json;
  json["frame"] = one.frame;
  json.update(differenceJson(one.difference));
  return json;
}

nlohmann::ordered_json sequenceJson(const std::vector<ComparedFrame>& frames, const std::string& metric) {
  auto all = nlohmann::ordered_json::array();
  for (const ComparedFrame& one : frames) all.push_back(frameJson(one));
  return {{"frames", std::move(all)}, {"worst", frameJson(worstOf(frames, metric))}};
}

std::string worstLine(const ComparedFrame& worst, const std::vector<std::string>& metrics) {
  std::vector<std::string> figures;
  for (const std::string& metric : metrics) figures.push_back(metricText(worst.difference, metric));
  return fmt::format("worst frame {}: {}", worst.frame, fmt::join(figures, ", "));
}

/// is_usual: without --metric.
std::string sequenceTable(const std::vector<ComparedFrame>& frames, const std::vector<std::string>& metrics,
                          bool is_usual) {
  std::vector<std::vector<std::string>> lines{{"frame"}};
  lines[0].insert(lines[0].end(), metrics.begin(), metrics.end());
  const bool tells_nonfinite =
      is_usual || std::any_of(frames.begin(), frames.end(),
                              [](const ComparedFrame& one) { return one.difference.nonfinite > 0; });
  if (tells_nonfinite) lines[0].push_back("nonfinite");
  for (const auto& [frame, d] : frames) {
    lines.push_back({fmt::format("{}", frame)});
    for (const std::string& metric : metrics)
      lines.back().push_back(metric == "psnr" ? fmt::format("{:.2f}", d.psnr)
                                              : fmt::format("{:.6g}", metricOf(d, metric)));
    if (tells_nonfinite) lines.back().push_back(fmt::format("{}", d.nonfinite));
  }
  return textTable(lines);
}

void compareSequences(const CompareOptions& options, CommandContext& context) {
  checkPattern(options.a, "A");
  checkPattern(options.b, "B");
  for (const auto& [option, pattern] : {std::pair("--diff", &options.difference),
                                        {"--error-map", &options.error_map},
                                        {"--side-by-side", &options.side_by_side}})
    if (!pattern->empty()) checkPattern(*pattern, option);
  const std::vector<int> frames = framesOfBoth(options);
  checkOptions(ofFrame(options, frames.front()));
  ProgressLine progress(false);
  std::vector<ComparedFrame> compared;
  for (const int frame : frames) {
    progress.frame = frame;
    progress.show(fmt::format("frame {}", frame), compared.size(), frames.size());
    compared.push_back({frame, comparePictures(ofFrame(options, frame), context.command_line)});
    compared.back().difference.of_pixel = std::vector<double>();
  }
  progress.clear();
  if (!options.json.empty())
    writeTextFile(options.json, dumpUtf8(sequenceJson(compared, firstMetric(options)), 2) + "\n");
  const std::vector<std::string> usual{"max_abs", "mean_abs", "mean_signed", "rmse", "psnr", "p99_abs"},
      told{"max_abs", "psnr"};
  const bool is_usual = options.metrics.empty();
  if (options.json != "-")
    fmt::print("{}{}\n", sequenceTable(compared, is_usual ? usual : options.metrics, is_usual),
               worstLine(worstOf(compared, firstMetric(options)), is_usual ? told : options.metrics));
  std::vector<std::string> broken;
  for (const Limit& limit : limitsOf(options)) {
    const auto over = std::count_if(compared.begin(), compared.end(),
                                    [&](const ComparedFrame& one) { return isOver(limit, one.difference); });
    if (over == 0) continue;
    const bool is_max_abs = limit.option == "--max-abs";
    broken.push_back(fmt::format(
        "{} of {} frames {} {} {}{}; {}", over, compared.size(), overOrUnder(limit), limit.option,
        limit.value, is_max_abs ? "" : " of " + limit.metric,
        worstLine(worstOf(compared, limit.metric), is_max_abs ? told : std::vector{limit.metric})));
  }
  reportLimits(broken, context);
}

/// Whether a path names the frames of a sequence: no file has this very name, and a frame's number has a
/// place in it.
bool namesFrames(const std::string& path) {
  std::error_code none;
  return !std::filesystem::exists(path, none) && hasFramePlace(path);
}

void compare(const CompareOptions& options, CommandContext& context) {
  if (namesFrames(options.a) || namesFrames(options.b))
    compareSequences(options, context);
  else
    compareTwo(options, context);
}

}  // namespace

void addCompareCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "compare", "two pictures, or two sequences, in numbers, in linear light; exit 1 over a limit");
  command->footer(
      "Over all compared pixels and channels, d = B - A, in linear light (white: 1):\n"
      "max_abs        the largest |d|, and its pixel\n"
      "mean_abs       the mean of |d|\n"
      "max_relative   max_abs / the largest |A|\n"
      "mean_relative  mean_abs / the largest |A|\n"
      "mean_signed    the mean of d: a bias\n"
      "mse            the mean of d^2\n"
      "rmse           its root\n"
      "psnr           -20 log10(rmse), in dB: the peak is 1\n"
      "relmse         the mean of d^2 / (A^2 + 0.01)\n"
      "mape           the mean of |d| / (|A| + 0.01)\n"
      "smape          the mean of 2 |d| / (|A| + |B| + 0.01)\n"
      "p99_abs        99 % of the pixels differ by at most this in any channel\n"
      "p999_abs       99.9 % of them\n"
      "nonfinite      values of which one alone is NaN or infinite, or infinities of both\n"
      "               signs; infinite in max_abs and percentiles, not in the means\n"
      "pixels over    pixels with a |d| above 1/2, 1 and 4 steps of 1/255\n"
      "Channels are those that both have, but A. Where one is named sampled, pixels with\n"
      "0 in it don't count.");
  auto options = std::make_shared<CompareOptions>();
  command
      ->add_option("A", options->a,
                   "the picture to hold against; with a channel `sampled`, only pixels where it is not 0 "
                   "count; #### or %04d in the names of A and B stands for the frames of a sequence: a line "
                   "each, the worst named, and #### in the outputs' names becomes the number")
      ->required();
  command->add_option("B", options->b, "the picture to judge")->required();
  command->add_option("--max-abs", options->max_abs,
                      "the largest difference that still passes, in linear light, in every frame");
  auto* metric = command
                     ->add_option("--metric", options->metrics,
                                  "print these figures alone: relmse,smape (--json has all)")
                     ->delimiter(',')
                     ->allow_extra_args(false)
                     ->check(oneOf(metricNames()));
  command
      ->add_option("--max", options->limits,
                   "the largest that still passes of each --metric, in their order: 0.01,0.02; of psnr the "
                   "least, of mean_signed either way; in every frame")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->needs(metric);
  command->add_option("--diff", options->difference,
                      "write |B - A| x 10 as a picture (- : PNG on standard output)");
  command->add_option("--error-map", options->error_map,
                      "write |B - A| in false colours with a scale bar (- : PNG on standard output)");
  command->add_option("--side-by-side", options->side_by_side,
                      "write A, B and the error map in a row, with names and figures (- : PNG on standard "
                      "output)");
  command->add_option("--json", options->json, "write the figures as JSON (- : standard output)");
  addLogOption(*command);
  addThreadsOption(*command);
  command->callback([&context, options] { compare(*options, context); });
}

}  // namespace luciole
