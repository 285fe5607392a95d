#include "experiment/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace luciole {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSteps = 255;  ///< 8-bit steps of 1

constexpr std::array kColumns{"ms",         "spread",      "max, steps", "mean, steps", "signed, steps",
                              "max, share", "mean, share", "front"};
using Cells = std::array<std::string, kColumns.size() + 1>;

Cells rowCells(const BenchRow& row, double brightest) {
  const ImageDifference& error = row.error;
  return {row.variant.is_default ? row.variant.name + " (default)" : row.variant.name,
          fmt::format("{:.1f}", row.time.median),
          fmt::format("± {:.0f} %", 100 * row.time.spread / row.time.median),
          fmt::format("{:.1e}", error.max_abs * kSteps),
          fmt::format("{:.1e}", error.mean_abs * kSteps),
          fmt::format("{:+.1e}", error.mean_signed * kSteps),
          fmt::format("{:.1e}", error.max_abs / brightest),
          fmt::format("{:.1e}", error.mean_abs / brightest),
          row.front ? "*" : ""};
}

/// Characters that a terminal shows of UTF-8 text: all bytes but those that continue one.
std::size_t shownWidth(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string groupTable(const BenchGroup& group) {
  std::vector<Cells> lines(1);
  lines[0][0] = group.group.name;
  std::copy(kColumns.begin(), kColumns.end(), lines[0].begin() + 1);
  for (const BenchRow& row : group.rows) lines.push_back(rowCells(row, group.brightest));
  std::array<std::size_t, std::tuple_size_v<Cells>> widths{};
  for (const Cells& line : lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], shownWidth(line[i]));
  std::string text;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const std::string blanks(widths[i] - shownWidth(lines[n][i]), ' ');
      text +=
          i == 0 ? fmt::format("| {}{} |", lines[n][i], blanks) : fmt::format(" {}{} |", blanks, lines[n][i]);
    }
    text += "\n";
    if (n > 0) continue;
    for (std::size_t i = 0; i < widths.size(); ++i)
      text +=
          i == 0 ? fmt::format("|{:-<{}}|", "", widths[i] + 2) : fmt::format("{:-<{}}:|", "", widths[i] + 1);
    text += "\n";
  }
  return text;
}

Json settingsJson(const Variant& variant) {
  static constexpr const char* kCulling[] = {"none", "tiles"};
  static constexpr const char* kShadows[] = {"off", "hard", "pcf"};
  const ShadeSettings& shade = variant.shade;
  return {{"lanes", variant.lanes},
          {"culling", kCulling[std::size_t(shade.culling)]},
          {"shadows", kShadows[std::size_t(shade.shadows)]},
          {"shadow_size", shade.shadow_size},
          {"log2_degree", shade.log2_degree},
          {"exp2_degree", shade.exp2_degree},
          {"samples", variant.samples}};
}

/// max, mean and signed mean in units of `unit`.
Json errorJson(const ImageDifference& error, double unit) {
  return {
      {"max", error.max_abs / unit}, {"mean", error.mean_abs / unit}, {"signed", error.mean_signed / unit}};
}

Json rowJson(const BenchRow& row, double brightest) {
  return {{"name", row.variant.name},
          {"default", row.variant.is_default},
          {"front", row.front},
          {"settings", settingsJson(row.variant)},
          {"milliseconds", {{"median", row.time.median}, {"spread", row.time.spread}}},
          {"error",
           {{"steps", errorJson(row.error, 1 / kSteps)}, {"relative", errorJson(row.error, brightest)}}}};
}

}  // namespace

std::string benchTable(const BenchResult& result) {
  std::string text = fmt::format(
      "{}: {} triangles, {} lights, {} x {} pixels. {}, {} threads; {}, {}, {} lanes; compiler {}.\n",
      result.scene, result.triangles, result.lights, result.width, result.height, result.machine.processor,
      result.machine.threads, result.machine.device.platform, result.machine.device.version,
      result.machine.device.lanes, result.machine.compiler);
  for (const BenchGroup& group : result.groups) {
    text += fmt::format("\n{}: {}.", group.group.name, group.group.measured);
    if (group.truth_error > 0)
      text += fmt::format(" Its own mean error is about {:.1e} steps.", group.truth_error * kSteps);
    text += "\n\n" + groupTable(group);
  }
  text += fmt::format(
      "\nms: median of {} runs, in rounds of every variant once; spread: half the distance between the "
      "quartiles.\n"
      "Errors are in 8-bit steps (1/255) of linear light; shares are of the truth's brightest value.\n"
      "front *: no other row has a lower mean error, as printed, without being slower by more than both "
      "spreads,\n"
      "nor the same one while being faster by more than both.\n"
      "The truth is kept in 32-bit floats, and so are G-buffers, which have no other encoding to compare.\n"
      "All shadow maps together fit in 512 MiB: where many lights cast shadows, larger sizes are halved "
      "until they do.\n",
      result.repeats);
  return text;
}

std::string benchJson(const BenchResult& result) {
  const Machine& machine = result.machine;
  Json json{{"version", LUCIOLE_VERSION},
            {"machine",
             {{"processor", machine.processor},
              {"threads", machine.threads},
              {"compiler", machine.compiler},
              {"device",
               {{"platform", machine.device.platform},
                {"name", machine.device.name},
                {"driver", machine.device.version},
                {"lanes", machine.device.lanes}}}}},
            {"scene", {{"name", result.scene}, {"triangles", result.triangles}, {"lights", result.lights}}},
            {"image", {{"width", result.width}, {"height", result.height}}},
            {"repeats", result.repeats},
            {"groups", Json::array()}};
  for (const BenchGroup& group : result.groups) {
    Json rows = Json::array();
    for (const BenchRow& row : group.rows) rows.push_back(rowJson(row, group.brightest));
    json["groups"].push_back({{"name", group.group.name},
                              {"measured", group.group.measured},
                              {"brightest", group.brightest},
                              {"truth_error_steps", group.truth_error * kSteps},
                              {"rows", std::move(rows)}});
  }
  return json.dump(2) + "\n";
}

}  // namespace luciole
