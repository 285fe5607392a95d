#include "tools/bench/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/dump_utf8.hpp"
#include "tools/figures/text_table.hpp"

namespace luciole {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kColumns[]{"ms",         "spread",      "max, steps", "mean, steps", "signed, steps",
                                 "max, share", "mean, share", "relMSE",     "SMAPE",       "front"};
using Cells = std::vector<std::string>;

/// A table's cell without a figure.
constexpr const char* kNoFigure = "–";

/// Collects why figures of a table have no value, each reason once, to print under the table.
class Reasons {
 public:
  void add(const std::string& why) {
    if (std::find(reasons_.begin(), reasons_.end(), why) == reasons_.end()) reasons_.push_back(why);
  }
  std::string text() const {
    return reasons_.empty() ? "" : fmt::format("\n{}: {}.\n", kNoFigure, fmt::join(reasons_, "; "));
  }

 private:
  std::vector<std::string> reasons_;
};

constexpr const char* kBlackTruth = "the truth is black, of which no error is a share";

std::string spreadText(const Repeated& runs) {
  return fmt::format("± {:.0f} %", runs.median != 0 ? 100 * runs.spread / std::abs(runs.median) : 0);
}

Cells rowCells(const BenchRow& row, Reasons& reasons) {
  const ImageDifference& error = row.error;
  if (row.brightest == 0) reasons.add(kBlackTruth);
  const auto share = [&](double value) {
    return row.brightest == 0 ? kNoFigure : fmt::format("{:.1e}", value / row.brightest);
  };
  return {row.variant.is_default ? row.variant.name + " (default)" : row.variant.name,
          fmt::format("{:.1f}", row.time.median),
          spreadText(row.time),
          fmt::format("{:.1e}", error.max_abs * k8BitSteps),
          fmt::format("{:.1e}", error.mean_abs * k8BitSteps),
          fmt::format("{:+.1e}", error.mean_signed * k8BitSteps),
          share(error.max_abs),
          share(error.mean_abs),
          fmt::format("{:.1e}", error.relmse),
          fmt::format("{:.1e}", error.smape),
          row.front ? "*" : ""};
}

std::string groupTable(const BenchGroup& group) {
  std::vector<Cells> lines{{group.group.name}};
  lines[0].insert(lines[0].end(), std::begin(kColumns), std::end(kColumns));
  Reasons reasons;
  for (const BenchRow& row : group.rows) lines.push_back(rowCells(row, reasons));
  return textTable(lines) + reasons.text();
}

std::string cellText(const SpeedCell& cell, int decimals, Reasons& reasons) {
  if (const double* value = std::get_if<double>(&cell)) return fmt::format("{:.{}f}", *value, decimals);
  if (const Repeated* runs = std::get_if<Repeated>(&cell))
    return fmt::format("{:.{}f} {}", runs->median, decimals, spreadText(*runs));
  if (const Estimate* estimate = std::get_if<Estimate>(&cell))
    return fmt::format("≈ {:.{}f}", estimate->value, decimals);
  reasons.add(std::get<NoValue>(cell).why);
  return kNoFigure;
}

std::string speedTable(const SpeedTable& table) {
  std::vector<Cells> lines{{table.name}};
  for (const SpeedColumn& column : table.columns) lines[0].push_back(column.head);
  Reasons reasons;
  for (const SpeedRow& row : table.rows) {
    lines.push_back({row.name});
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      lines.back().push_back(cellText(row.cells[i], table.columns[i].decimals, reasons));
  }
  return textTable(lines) + reasons.text();
}

Json settingsJson(const Variant& variant) {
  static constexpr const char* kCulling[] = {"none", "tiles"};
  static constexpr const char* kShadows[] = {"off", "hard", "pcf", "soft", "exact", "soft-exact", "auto"};
  const ShadeSettings& shade = variant.shade;
  return {{"lanes", variant.lanes},
          {"model", modelName(shade.model)},
          {"culling", kCulling[std::size_t(shade.culling)]},
          {"tile", shade.tile_size},
          {"shadows", kShadows[std::size_t(shade.shadows)]},
          {"shadow_size", shade.shadow_limits.size},
          {"log2_degree", shade.log2_degree},
          {"exp2_degree", shade.exp2_degree},
          {"samples", variant.samples}};
}

/// max, mean and signed mean in units of `unit`; null, and a reason, where there is no such figure.
Json errorJson(const ImageDifference& error, double unit) {
  Json json;
  bool all_finite = true;
  for (const auto& [name, value] :
       {std::pair("max", error.max_abs), {"mean", error.mean_abs}, {"signed", error.mean_signed}}) {
    const bool is_finite = unit != 0 && std::isfinite(value);
    json[name] = is_finite ? Json(value / unit) : Json(nullptr);
    all_finite &= is_finite;
  }
  if (!all_finite) json["reason"] = unit == 0 ? kBlackTruth : "a pixel of one picture alone is not finite";
  return json;
}

Json rowJson(const BenchRow& row) {
  const auto finiteOrNull = [](double figure) {
    return std::isfinite(figure) ? Json(figure) : Json(nullptr);
  };
  return {{"name", row.variant.name},
          {"default", row.variant.is_default},
          {"front", row.front},
          {"settings", settingsJson(row.variant)},
          {"milliseconds", {{"median", row.time.median}, {"spread", row.time.spread}}},
          {"brightest", row.brightest},
          {"error",
           {{"steps", errorJson(row.error, 1 / k8BitSteps)},
            {"relative", errorJson(row.error, row.brightest)},
            {"relmse", finiteOrNull(row.error.relmse)},
            {"smape", finiteOrNull(row.error.smape)}}}};
}

Json speedRowJson(const SpeedTable& table, const SpeedRow& row) {
  Json json{{"name", row.name}};
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (const double* value = std::get_if<double>(&row.cells[i])) json[table.columns[i].key] = *value;
    if (const Repeated* runs = std::get_if<Repeated>(&row.cells[i]))
      json[table.columns[i].key] = {{"median", runs->median}, {"spread", runs->spread}};
    if (const Estimate* estimate = std::get_if<Estimate>(&row.cells[i]))
      json[table.columns[i].key] = {{"estimate", estimate->value}};
    if (const NoValue* none = std::get_if<NoValue>(&row.cells[i])) {
      json[table.columns[i].key] = nullptr;
      json["reasons"][table.columns[i].key] = none->why;
    }
  }
  return json;
}

constexpr const char* kErrorsExplained =
    "\nErrors are in 8-bit steps (1/255) of linear light; shares are of the truth's brightest value;\n"
    "relMSE and SMAPE are as luciole compare --help defines them.\n"
    "front *: no other row has a lower mean error, as printed, without being slower by more than both "
    "spreads,\n"
    "nor the same one while being faster by more than both.\n"
    "The truth is kept in 32-bit floats, and so are G-buffers, which have no other encoding to compare.\n"
    "All shadow maps together fit in 512 MiB: where many lights cast shadows, larger sizes are halved "
    "until they do.\n";

}  // namespace

std::string benchTable(const BenchResult& result) {
  std::string text = fmt::format(
      "{}: {} triangles, {} lights, {} x {} pixels. {}, {} threads; {}, {}, {} lanes; compiler {}.\n",
      result.scene, result.triangles, result.lights, result.width, result.height, result.machine.processor,
      result.machine.threads, result.machine.device.platform, result.machine.device.version,
      result.machine.device.lanes, result.machine.compiler);
  if (const auto& gbuffer = result.gbuffer)
    text += fmt::format("{}: {} x {} pixels, by the {} lights of {}, {}.\n", gbuffer->file, gbuffer->width,
                        gbuffer->height, gbuffer->lights, gbuffer->scene, gbuffer->model);
  for (const BenchGroup& group : result.groups) {
    text += fmt::format("\n{}: {}.", group.group.name, group.group.measured);
    if (group.truth_error > 0)
      text += fmt::format(" Its own mean error is about {:.1e} steps.", group.truth_error * k8BitSteps);
    text += "\n\n" + groupTable(group);
  }
  if (!result.groups.empty()) text += kErrorsExplained;
  for (const SpeedTable& table : result.speed)
    text += fmt::format("\n{}: {}.\n\n{}", table.name, table.measured, speedTable(table));
  text += fmt::format(
      "\nms: median of {} runs, in rounds of every row once; spread, or ±: half the distance between the "
      "quartiles.\n",
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
            {"gbuffer", nullptr},
            {"groups", Json::array()},
            {"speed", Json::array()}};
  if (const auto& gbuffer = result.gbuffer)
    json["gbuffer"] = {{"file", gbuffer->file},   {"scene", gbuffer->scene},   {"lights", gbuffer->lights},
                       {"width", gbuffer->width}, {"height", gbuffer->height}, {"model", gbuffer->model}};
  for (const BenchGroup& group : result.groups) {
    Json rows = Json::array();
    for (const BenchRow& row : group.rows) rows.push_back(rowJson(row));
    json["groups"].push_back({{"name", group.group.name},
                              {"measured", group.group.measured},
                              {"truth_error_steps", group.truth_error * k8BitSteps},
                              {"rows", std::move(rows)}});
  }
  for (const SpeedTable& table : result.speed) {
    Json rows = Json::array();
    for (const SpeedRow& row : table.rows) rows.push_back(speedRowJson(table, row));
    json["speed"].push_back({{"name", table.name}, {"measured", table.measured}, {"rows", std::move(rows)}});
    if (!table.failures.empty()) json["speed"].back()["failures"] = table.failures;
  }
  return dumpUtf8(std::move(json), 2) + "\n";
}

}  // namespace luciole
