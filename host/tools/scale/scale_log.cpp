#include "tools/scale/scale_log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/output_file.hpp"
#include "base/text_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFile = "/results.jsonl";

// Conversions between results and the log's lines. Reading throws nlohmann::json::exception if something is
// missing or of another type, and InputError if a value is impossible.

Json toJson(const ScaleDescription& description) {
  Json settings = Json::object(), axes = Json::array(), points = Json::array();
  for (const auto& [name, value] : description.settings) settings[name] = value;
  for (const ScaleAxis& axis : description.axes)
    axes.push_back({{"name", axis.name}, {"values", axis.values}});
  for (const ScalePoint& point : description.points)
    points.push_back({{"lights", point.lights}, {"values", point.values}});
  Json json{{"experiment",
             {{"version", description.version},
              {"scene", description.scene},
              {"digest", description.digest},
              {"settings", settings},
              {"lights", description.lights},
              {"axes", axes},
              {"points", points},
              {"repeats", description.repeats}}}};
  for (const ScaleMethod& method : description.methods)
    json["experiment"]["methods"].push_back({{"name", method.name}, {"runs", method.runs}});
  return json;
}

/// A whole number. Throws InputError, in which `key` names it, unless T can hold it.
template <class T>
T wholeNumber(const Json& number, const char* key) {
  const bool fits = number.is_number_unsigned()
                        ? std::in_range<T>(number.get<std::uint64_t>())
                        : number.is_number_integer() && std::in_range<T>(number.get<std::int64_t>());
  if (!fits)
    throw InputError(fmt::format("{} {}: expected a whole number between {} and {}", key,
                                 forMessage(number.dump()), std::numeric_limits<T>::min(),
                                 std::numeric_limits<T>::max()));
  return number.get<T>();
}

/// The same, of an object's member.
template <class T>
T wholeMember(const Json& json, const char* key) {
  return wholeNumber<T>(json.at(key), key);
}

ScaleDescription descriptionOf(const Json& line) {
  const Json& json = line.at("experiment");
  ScaleDescription description;
  description.version = json.at("version").get<std::string>();
  description.scene = json.at("scene").get<std::string>();
  description.digest = wholeMember<std::uint64_t>(json, "digest");
  for (const auto& [name, value] : json.at("settings").items())
    description.settings.emplace_back(name, value.get<std::string>());
  for (const Json& lights : json.at("lights"))
    description.lights.push_back(wholeNumber<std::uint64_t>(lights, "lights"));
  for (const Json& axis : json.at("axes"))
    description.axes.push_back(
        {axis.at("name").get<std::string>(), axis.at("values").get<std::vector<std::string>>()});
  for (const Json& point : json.at("points"))
    description.points.push_back(
        {wholeMember<std::uint64_t>(point, "lights"), point.at("values").get<std::vector<std::string>>()});
  description.repeats = wholeMember<int>(json, "repeats");
  if (json.contains("methods"))
    for (const Json& method : json.at("methods"))
      description.methods.push_back({method.at("name").get<std::string>(), wholeMember<int>(method, "runs")});
  const bool is_whole =
      std::all_of(description.points.begin(), description.points.end(),
                  [&](const ScalePoint& point) { return point.values.size() == description.axes.size(); });
  if (description.lights.empty() || !is_whole)
    throw InputError("expected numbers of lights, and a value of each axis for every point");
  return description;
}

Json toJson(const Machine& machine) {
  return {{"machine",
           {{"processor", machine.processor},
            {"threads", machine.threads},
            {"memory_bytes", machine.memory_bytes},
            {"system", machine.system},
            {"platform", machine.device.platform},
            {"device", machine.device.name},
            {"driver", machine.device.version},
            {"lanes", machine.device.lanes},
            {"arithmetic", machine.device.arithmetic},
            {"compiler", machine.compiler}}}};
}

Machine machineOf(const Json& line) {
  const Json& json = line.at("machine");
  return {.processor = json.at("processor").get<std::string>(),
          .threads = wholeMember<unsigned>(json, "threads"),
          .memory_bytes = wholeMember<std::uint64_t>(json, "memory_bytes"),
          .system = json.at("system").get<std::string>(),
          .device = {json.at("platform").get<std::string>(), json.at("device").get<std::string>(),
                     json.at("driver").get<std::string>(), wholeMember<int>(json, "lanes"), 0,
                     json.value("arithmetic", std::string())},
          .compiler = json.at("compiler").get<std::string>()};
}

double numberOrInfinity(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
}

KeptBounds boundsOf(const Json& json) {
  KeptBounds bounds;
  for (const auto& [name, figure] : kBoundFigures) bounds.*figure = numberOrInfinity(json.at(name));
  for (const auto& [name, count] : kBoundCounts) bounds.*count = wholeMember<std::uint64_t>(json, name);
  return bounds;
}

ImageDifference errorOf(const Json& json) {
  ImageDifference error;
  for (const auto& [name, figure] : kImageMetrics) error.*figure = numberOrInfinity(json.at(name));
  return error;
}

Json toJson(const std::string& point, const PointCheck& check) {
  Json json{{"point", point},
            {"check",
             {{"pairs_evaluated", check.pairs_evaluated},
              {"pairs_in_range", check.pairs_in_range},
              {"pixels_lit", check.pixels_lit},
              {"list_entries", check.list_entries},
              {"reach", finiteOrNull(check.reach)},
              {"pixels", check.pixels},
              {"picture", check.picture},
              {"error_map", check.error_map}}}};
  json["check"].update(toJson(check.error));
  if (!check.list_map.empty()) json["check"]["list_map"] = check.list_map;
  if (check.bounds) {
    json["check"]["bounds"] = toJson(*check.bounds);
    json["check"]["bound_map"] = check.bound_map;
  }
  for (const auto& [name, why] : reasonsForNull(check)) json["reasons"][name] = why;
  return json;
}

/// The file that a line names by this key. Throws InputError unless the name lies in the log's folder of
/// pictures. Links are checked when the file is used (pictureFile).
std::string fileNamed(const Json& json, const char* key) {
  const std::string file = json.at(key).get<std::string>();
  const fs::path path(file);
  if (path.parent_path().empty() || *path.begin() != kPictureFolder ||
      std::any_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; }))
    throw InputError(fmt::format("{} {}: expected a file in the folder {} of the experiment", key,
                                 Json(file).dump(), kPictureFolder));
  return file;
}

PointCheck checkOf(const Json& line) {
  const Json& json = line.at("check");
  const bool is_bounded = json.contains("bounds");
  return {.pairs_evaluated = wholeMember<std::uint64_t>(json, "pairs_evaluated"),
          .pairs_in_range = wholeMember<std::uint64_t>(json, "pairs_in_range"),
          .pixels_lit = wholeMember<std::uint64_t>(json, "pixels_lit"),
          .list_entries = wholeMember<std::uint64_t>(json, "list_entries"),
          .reach = numberOrInfinity(json.at("reach")),
          .pixels = wholeMember<std::uint64_t>(json, "pixels"),
          .error = errorOf(json),
          .picture = fileNamed(json, "picture"),
          .error_map = fileNamed(json, "error_map"),
          .list_map = json.contains("list_map") ? fileNamed(json, "list_map") : "",
          .bounds = is_bounded ? std::optional(boundsOf(json.at("bounds"))) : std::nullopt,
          .bound_map = is_bounded ? fileNamed(json, "bound_map") : ""};
}

Json toJson(const std::string& point, int repeat, const PointRun& run) {
  Json stages = Json::object();
  for (const auto& [name, milliseconds] : run.stages) stages[name] = milliseconds;
  return {{"point", point},
          {"repeat", repeat},
          {"stages", stages},
          {"device_bytes", run.device_bytes},
          {"peak_bytes", run.peak_bytes}};
}

PointRun runOf(const Json& line) {
  PointRun run;
  for (const auto& [name, milliseconds] : line.at("stages").items())
    run.stages.emplace_back(name, milliseconds.get<double>());
  run.device_bytes = wholeMember<std::uint64_t>(line, "device_bytes");
  run.peak_bytes = wholeMember<std::uint64_t>(line, "peak_bytes");
  return run;
}

/// Adds a line's content to the results. A repeated line changes nothing.
void take(const Json& line, ScaleResults& results) {
  if (line.contains("machine")) {
    results.machines.push_back(machineOf(line));
    return;
  }
  PointRecord& record = results.records[line.at("point").get<std::string>()];
  if (line.contains("check"))
    record.check = checkOf(line);
  else
    record.runs[wholeMember<int>(line, "repeat")] = runOf(line);
}

std::vector<std::string> filesOf(const PointCheck& check) {
  std::vector<std::string> files{check.picture, check.error_map};
  if (!check.list_map.empty()) files.push_back(check.list_map);
  if (check.bounds) files.push_back(check.bound_map);
  return files;
}

/// The log in `text`, which ends after a whole line. Throws InputError with the path and the line's number.
ScaleResults parseLog(const std::string& path, const std::string& text) {
  ScaleResults results;
  std::size_t number = 0;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = text.find('\n', start);
    ++number;
    try {
      const Json line = Json::parse(text.substr(start, end - start));
      if (number == 1)
        results.description = descriptionOf(line);
      else
        take(line, results);
    } catch (const nlohmann::json::exception&) {
      throw InputError(fmt::format(
          "{}: line {}: expected {}", path, number,
          number == 1 ? "the description of an experiment" : "a machine, a check or a run of one"));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: line {}: {}", path, number, error.what()));
    }
    start = end + 1;
  }
  if (number == 0) throw InputError(path + ": expected the log of an experiment, got an empty file");
  return results;
}

/// The first thing in which two descriptions differ.
std::string difference(const ScaleDescription& a, const ScaleDescription& b) {
  if (a.scene != b.scene) return fmt::format("of {}, this one of {}", a.scene, b.scene);
  if (a.digest != b.digest) return "of another state of the scene";
  if (a.version != b.version) return fmt::format("by version {}, this one by {}", a.version, b.version);
  for (const auto& setting : a.settings) {
    const auto other = std::find_if(b.settings.begin(), b.settings.end(),
                                    [&](const auto& s) { return s.first == setting.first; });
    if (other != b.settings.end() && other->second != setting.second)
      return fmt::format("with {} {}, this one with {}", setting.first, setting.second, other->second);
  }
  if (a.lights != b.lights) return "with other numbers of lights";
  if (a.repeats != b.repeats) return fmt::format("with {} repeats, this one with {}", a.repeats, b.repeats);
  return "with other variants";
}

/// Throws InputError if two of the machines' devices are known to compute differently.
void refuseOtherArithmetic(const std::vector<ScaleResults>& parts, const std::vector<std::string>& folders) {
  const std::string* first_folder = nullptr;
  const DeviceDescription* first = nullptr;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (const Machine& machine : parts[i].machines) {
      if (machine.device.arithmetic.empty()) continue;
      if (!first) {
        first = &machine.device;
        first_folder = &folders[i];
      } else if (first->arithmetic != machine.device.arithmetic) {
        throw InputError(fmt::format(
            "{} and {}: the bits of their devices, {} and {}, differ (see luciole devices --check); "
            "--mix-devices merges them all the same",
            *first_folder, folders[i], first->name, machine.device.name));
      }
    }
  }
}

}  // namespace

Json toJson(const KeptBounds& bounds) {
  Json json;
  for (const auto& [name, figure] : kBoundFigures) json[name] = finiteOrNull(bounds.*figure);
  for (const auto& [name, count] : kBoundCounts) json[name] = bounds.*count;
  return json;
}

Json toJson(const ImageDifference& error) {
  Json json;
  for (const auto& [name, figure] : kImageMetrics) json[name] = finiteOrNull(error.*figure);
  return json;
}

Json finiteOrNull(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

ScaleLog::ScaleLog(const std::string& folder, const ScaleDescription& description) : folder_(folder) {
  const std::string path = folder + kFile;
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw InputError(fmt::format("{}: can't be made: {}", folder, failed.message()));
  descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw InputError(fmt::format("{}: can't be written: {}", path, systemReason()));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    close(descriptor_);
    throw InputError(fmt::format("{}: another luciole scale is at work on it", path));
  }
  try {
    std::string text = readFile(path);
    const std::size_t whole = text.rfind('\n') + 1;  // 0 where there is none
    if (whole < text.size() && ftruncate(descriptor_, off_t(whole)) != 0)
      throw MachineError(fmt::format("{}: can't be cut off: {}", path, systemReason()));
    text.resize(whole);
    if (text.empty()) {
      results_.description = description;
      appendLine(toJson(description).dump());
    } else {
      results_ = parseLog(path, text);
      if (!(results_.description == description))
        throw InputError(
            fmt::format("{}: is another experiment's, {}; expected an empty folder, or this one's", path,
                        difference(results_.description, description)));
    }
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

ScaleLog::~ScaleLog() { close(descriptor_); }

const PointRecord& ScaleLog::record(const std::string& point) const {
  static const PointRecord kNothing;
  const auto found = results_.records.find(point);
  return found == results_.records.end() ? kNothing : found->second;
}

void ScaleLog::append(const Machine& machine) {
  const Json line = toJson(machine);
  const auto& known = results_.machines;
  if (std::any_of(known.begin(), known.end(), [&](const Machine& other) { return toJson(other) == line; }))
    return;
  appendLine(line.dump());
  take(line, results_);
}

void ScaleLog::append(const std::string& point, const PointCheck& check) {
  const Json line = toJson(point, check);
  appendLine(line.dump());
  take(line, results_);
}

void ScaleLog::append(const std::string& point, int repeat, const PointRun& run) {
  const Json line = toJson(point, repeat, run);
  appendLine(line.dump());
  take(line, results_);
}

void ScaleLog::appendLine(const std::string& line) {
  const std::string text = line + "\n";
  for (std::size_t written = 0; written < text.size();) {
    const ssize_t count = write(descriptor_, text.data() + written, text.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw MachineError(fmt::format("{}{}: {}", folder_, kFile, systemReason()));
    written += std::size_t(count);
  }
  if (retryInterrupted([&] { return fsync(descriptor_); }) != 0)
    throw MachineError(fmt::format("{}{}: {}", folder_, kFile, systemReason()));
}

ScaleResults readScaleLog(const std::string& folder) {
  const std::string path = folder + kFile;
  std::error_code none;
  if (!fs::is_regular_file(path, none))
    throw InputError(fmt::format("{}: expected the folder of an experiment, with results.jsonl", folder));
  std::string text = readFile(path);
  text.resize(text.rfind('\n') + 1);
  return parseLog(path, text);
}

std::string pictureFile(const std::string& folder, const std::string& file) {
  const std::string path = folder + "/" + file;
  std::error_code failed;
  const fs::path target = fs::canonical(path, failed);
  if (failed) throw InputError(fmt::format("{}: {}", path, failed.message()));
  const fs::path home = fs::canonical(folder, failed);
  const bool is_inside =
      std::mismatch(home.begin(), home.end(), target.begin(), target.end()).first == home.end();
  if (failed || !is_inside || !fs::is_regular_file(target, failed))
    throw InputError(
        fmt::format("{}: expected a file in the experiment's folder, not a link out of it", path));
  return path;
}

ScaleResults mergeScaleLogs(const std::vector<std::string>& folders, const std::string& merged,
                            bool mixes_devices) {
  std::vector<ScaleResults> parts;
  for (const std::string& folder : folders) parts.push_back(readScaleLog(folder));
  std::error_code none;
  if (fs::exists(merged + kFile, none))
    throw InputError(fmt::format("{}: holds an experiment already; expected a new folder", merged));
  if (!mixes_devices) refuseOtherArithmetic(parts, folders);
  std::map<std::string, std::string> folder_of_check;
  std::map<std::pair<std::string, int>, std::string> folder_of_run;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!(parts[i].description == parts[0].description))
      throw InputError(fmt::format("{} and {}: aren't of one experiment: the first is {}", folders[0],
                                   folders[i], difference(parts[0].description, parts[i].description)));
    for (const auto& [point, record] : parts[i].records) {
      const auto once = [&, &name = point](bool is_new, const std::string& other) {
        if (!is_new) throw InputError(fmt::format("{} and {}: both have {}", other, folders[i], name));
      };
      if (record.check) {
        for (const std::string& file : filesOf(*record.check)) pictureFile(folders[i], file);
        const auto [place, is_new] = folder_of_check.emplace(point, folders[i]);
        once(is_new, place->second);
      }
      for (const auto& [repeat, run] : record.runs) {
        const auto [place, is_new] = folder_of_run.emplace(std::pair(point, repeat), folders[i]);
        once(is_new, place->second);
      }
    }
  }
  fs::create_directories(merged + "/" + kPictureFolder, none);  // where it can't, copying will say so
  ScaleLog log(merged, parts[0].description);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (const Machine& machine : parts[i].machines) log.append(machine);
    for (const auto& [point, record] : parts[i].records) {
      if (record.check) {
        for (const std::string& file : filesOf(*record.check)) {
          std::error_code failed;
          fs::copy_file(pictureFile(folders[i], file), merged + "/" + file,
                        fs::copy_options::overwrite_existing, failed);
          if (failed) throw InputError(fmt::format("{}/{}: {}", folders[i], file, failed.message()));
        }
        log.append(point, *record.check);
      }
      for (const auto& [repeat, run] : record.runs) log.append(point, repeat, run);
    }
  }
  return log.results();
}

}  // namespace luciole
