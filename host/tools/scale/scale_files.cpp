#include "tools/scale/scale_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "base/base64.hpp"
#include "base/csv.hpp"
#include "base/dump_utf8.hpp"
#include "base/page_text.hpp"

namespace luciole {
namespace {

using Json = nlohmann::ordered_json;

/// The most bytes of pictures on the page: more is too much for browsers on phones.
constexpr std::size_t kMostPictureBytes = std::size_t(64) << 20;

std::vector<std::string> allStages(const ScaleSummary& summary) {
  std::vector<std::string> names;
  for (const PointSummary& point : summary.points)
    for (const StageSummary& stage : point.stages)
      if (std::find(names.begin(), names.end(), stage.name) == names.end()) names.push_back(stage.name);
  return names;
}

std::string snakeCase(std::string name) {
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

/// The pictures of the page; files with the same content are stored once.
class PagePictures {
 public:
  explicit PagePictures(const std::string& folder) : folder_(folder) {}

  /// Adds a picture file and returns its index; null if it is missing or kMostPictureBytes are used up.
  /// Throws as pictureFile().
  Json add(const std::string& file) {
    std::error_code none;
    if (!std::filesystem::exists(folder_ + "/" + file, none)) return nullptr;
    std::ifstream stream(pictureFile(folder_, file), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (bytes.empty()) return nullptr;
    if (const auto known = index_of_.find(bytes); known != index_of_.end()) return known->second;
    if (bytes_ + bytes.size() > kMostPictureBytes) return nullptr;
    bytes_ += bytes.size();
    urls_.push_back("data:image/png;base64," + base64(bytes));
    return index_of_[bytes] = urls_.size() - 1;
  }

  const Json& urls() const { return urls_; }

 private:
  std::string folder_;
  std::size_t bytes_ = 0;
  std::map<std::string, std::size_t> index_of_;  ///< by content
  Json urls_ = Json::array();
};

Json valuesJson(const ScaleDescription& description, const std::vector<std::string>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) json[description.axes[i].name] = values[i];
  return json;
}

Json quartilesJson(const Quartiles& time) {
  return {{"median", finiteOrNull(time.median)},
          {"low", finiteOrNull(time.low)},
          {"high", finiteOrNull(time.high)}};
}

/// A number of Luciole's own pictures; null of others.
Json ownCount(const PointSummary& point, std::uint64_t count) {
  return point.is_own ? Json(count) : Json(nullptr);
}

/// A row for each fit: its numbers, or null and the reason if there is none.
Json growthRows(const ScaleSummary& summary) {
  Json rows = Json::array();
  for (const StageGrowth& row : summary.growth) {
    Json json{{"values", valuesJson(summary.description, row.values)}, {"stage", row.stage}};
    for (const char* name : {"a", "b", "c", "c_low", "c_high"}) json[name] = nullptr;
    if (const auto& fit = row.growth.fit)
      json.update(
          {{"a", fit->a}, {"b", fit->b}, {"c", fit->c}, {"c_low", fit->c_low}, {"c_high", fit->c_high}});
    json["reason"] = row.growth.fit ? Json(nullptr) : Json(row.growth.reason);
    rows.push_back(json);
  }
  return rows;
}

Json machineJson(const Machine& machine) {
  return {{"processor", machine.processor},          {"threads", machine.threads},
          {"memory_bytes", machine.memory_bytes},    {"system", machine.system},
          {"device", machine.device.name},           {"platform", machine.device.platform},
          {"driver", machine.device.version},        {"lanes", machine.device.lanes},
          {"arithmetic", machine.device.arithmetic}, {"compiler", machine.compiler}};
}

Json settingsJson(const ScaleDescription& description) {
  Json json = Json::object();
  for (const auto& [name, value] : description.settings) json[name] = value;
  json["repeats"] = description.repeats;
  return json;
}

Json pointJson(const ScaleDescription& description, const PointSummary& point) {
  Json json{{"lights", point.point.lights},
            {"values", valuesJson(description, point.point.values)},
            {"milliseconds", quartilesJson(point.milliseconds)},
            {"stages", Json::array()},
            {"runs", point.runs},
            {"reach", finiteOrNull(point.check.reach)},
            {"times_first", nullptr},
            {"pairs_evaluated", ownCount(point, point.check.pairs_evaluated)},
            {"pairs_in_range", ownCount(point, point.check.pairs_in_range)},
            {"pixels_lit", ownCount(point, point.check.pixels_lit)},
            {"list_entries", ownCount(point, point.check.list_entries)},
            {"device_bytes", ownCount(point, point.device_bytes)},
            {"peak_bytes", ownCount(point, point.peak_bytes)},
            {"error", toJson(point.check.error)},
            {"bounds", point.check.bounds ? toJson(*point.check.bounds) : Json(nullptr)},
            {"truth", point.truth},
            {"front", point.front},
            {"fronts", point.fronts}};
  if (const auto& ratio = point.times_first)
    json["times_first"] = {{"median", ratio->median}, {"low", ratio->low}, {"high", ratio->high}};
  json["error"]["pixels"] = point.check.pixels;
  for (const auto& [name, why] : reasonsForNull(point.check)) json["reasons"][name] = why;
  for (const StageSummary& stage : point.stages) {
    Json row{{"name", stage.name}};
    row.update(quartilesJson(stage.milliseconds));
    json["stages"].push_back(row);
  }
  return json;
}

std::string withCommas(std::uint64_t number) {
  std::string text = fmt::format("{}", number);
  for (int i = int(text.size()) - 3; i > 0; i -= 3) text.insert(std::size_t(i), 1, ',');
  return text;
}

std::string titleOf(const ScaleDescription& description) {
  const std::string scene = description.scene.substr(description.scene.rfind('/') + 1);
  const std::uint64_t least = description.lights.front(), most = description.lights.back();
  return least == most ? fmt::format("{}, {} light{}", scene, withCommas(most), most == 1 ? "" : "s")
                       : fmt::format("{}, {} to {} lights", scene, withCommas(least), withCommas(most));
}

}  // namespace

std::string scaleCsv(const ScaleSummary& summary) {
  const std::vector<std::string> stages = allStages(summary);
  std::vector<std::string> head{"lights"};
  for (const ScaleAxis& axis : summary.description.axes) head.push_back(axis.name);
  for (const char* name : {"runs", "ms", "ms_low", "ms_high"}) head.push_back(name);
  for (const std::string& stage : stages)
    for (const char* ending : {"_ms", "_ms_low", "_ms_high"}) head.push_back(snakeCase(stage) + ending);
  for (const char* name : {"reach", "pairs_evaluated", "pairs_in_range", "pixels_lit", "list_entries",
                           "device_bytes", "peak_bytes", "checked_pixels"})
    head.push_back(name);
  for (const auto& [name, figure] : kImageMetrics) head.push_back(name);
  for (const char* name : {"times_first", "times_first_low", "times_first_high"}) head.push_back(name);
  for (const char* name : {"front", "picture", "error_map", "list_map", "truth"}) head.push_back(name);
  for (const auto& [name, figure] : kBoundFigures) head.push_back(name);
  for (const auto& [name, count] : kBoundCounts) head.push_back(name);
  head.push_back("bound_map");
  std::string csv = csvLine(head);
  for (const PointSummary& point : summary.points) {
    std::vector<std::string> cells{fmt::format("{}", point.point.lights)};
    cells.insert(cells.end(), point.point.values.begin(), point.point.values.end());
    cells.push_back(fmt::format("{}", point.runs));
    const auto add = [&](const Quartiles& time) {
      for (const double value : {time.median, time.low, time.high})
        cells.push_back(std::isnan(value) ? "" : fmt::format("{}", value));
    };
    add(point.milliseconds);
    for (const std::string& name : stages) {
      const auto stage = std::find_if(point.stages.begin(), point.stages.end(),
                                      [&](const StageSummary& s) { return s.name == name; });
      if (stage != point.stages.end())
        add(stage->milliseconds);
      else
        cells.insert(cells.end(), 3, "");
    }
    const PointCheck& check = point.check;
    cells.push_back(fmt::format("{}", check.reach));
    for (const std::uint64_t count : {check.pairs_evaluated, check.pairs_in_range, check.pixels_lit,
                                      check.list_entries, point.device_bytes, point.peak_bytes})
      cells.push_back(point.is_own ? fmt::format("{}", count) : "");
    cells.push_back(fmt::format("{}", check.pixels));
    for (const auto& [name, figure] : kImageMetrics) cells.push_back(fmt::format("{}", check.error.*figure));
    if (const auto& ratio = point.times_first)
      for (const double value : {ratio->median, ratio->low, ratio->high})
        cells.push_back(fmt::format("{}", value));
    else
      cells.insert(cells.end(), 3, "");
    cells.push_back(point.front ? "1" : "0");
    for (const std::string& file : {check.picture, check.error_map, check.list_map}) cells.push_back(file);
    cells.push_back(point.truth);
    const KeptBounds bounds = check.bounds.value_or(KeptBounds{});
    for (const auto& [name, figure] : kBoundFigures)
      cells.push_back(check.bounds ? fmt::format("{}", bounds.*figure) : "");
    for (const auto& [name, count] : kBoundCounts)
      cells.push_back(check.bounds ? fmt::format("{}", bounds.*count) : "");
    cells.push_back(check.bound_map);
    csv += csvLine(cells);
  }
  return csv;
}

std::string growthJson(const ScaleSummary& summary) {
  Json json{{"version", summary.description.version}, {"scene", summary.description.scene}};
  json["settings"] = settingsJson(summary.description);
  json["machines"] = Json::array();
  for (const Machine& machine : summary.machines) json["machines"].push_back(machineJson(machine));
  json["model"] = "milliseconds = a + b * lights^c; c_low to c_high: 95 % confidence; null: see reason";
  json["growth"] = growthRows(summary);
  return dumpUtf8(std::move(json), 2) + "\n";
}

std::string pageData(const ScaleSummary& summary, const std::string& folder, const std::string& command) {
  const ScaleDescription& description = summary.description;
  PagePictures pictures(folder);
  Json points = Json::array();
  for (const PointSummary& point : summary.points) points.push_back(pointJson(description, point));
  // From the most lights down: if there isn't room for all pictures, those matter most.
  for (std::size_t i = points.size(); i-- > 0;) {
    const PointCheck& check = summary.points[i].check;
    points[i]["picture"] = pictures.add(check.picture);
    points[i]["error_map"] = pictures.add(check.error_map);
    points[i]["tile_map"] = check.list_map.empty() ? Json(nullptr) : pictures.add(check.list_map);
    points[i]["bound_map"] = check.bounds ? pictures.add(check.bound_map) : Json(nullptr);
  }
  Json axes = Json::array();
  for (const ScaleAxis& axis : description.axes)
    axes.push_back({{"name", axis.name}, {"values", axis.values}});
  Json json{{"title", titleOf(description)},
            {"scene", description.scene},
            {"command", command},
            {"version", description.version}};
  json["machine"] = summary.machines.empty() ? Json::object() : machineJson(summary.machines.front());
  if (summary.machines.size() > 1) json["machine"]["other machines"] = summary.machines.size() - 1;
  json["settings"] = settingsJson(description);
  json["axes"] = axes;
  json["lights"] = description.lights;
  json["first"] =
      description.points.empty() ? Json() : valuesJson(description, description.points.front().values);
  json["points"] = points;
  json["growth"] = growthRows(summary);
  json["pictures"] = pictures.urls();
  json["incomplete"] = summary.incomplete.size();
  json["violations"] = summary.violations;
  return dumpUtf8(std::move(json));
}

}  // namespace luciole
