#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/figures/machine.hpp"
#include "tools/scale/scale.hpp"

namespace luciole {

/// Where in the experiment's folder its pictures are.
inline constexpr const char* kPictureFolder = "pictures";

/// What a log holds.
struct ScaleResults {
  ScaleDescription description;
  std::vector<Machine> machines;               ///< each that took part, once
  std::map<std::string, PointRecord> records;  ///< by pointName
};

/// The log of an experiment, results.jsonl in a folder: a first line that describes the experiment, then in
/// any order a line for each machine, each check and each timed run. A line is appended as a whole and is on
/// the disk when append() returns, so an interrupted experiment loses only the point it was at. The file is
/// locked while it is open.
class ScaleLog {
 public:
  /// Opens the log, or makes it and its folder. Text after the last whole line is removed. Throws InputError
  /// if the log is another experiment's, another process has it open, the file isn't a log, or it can't be
  /// made; MachineError if it can't be written.
  ScaleLog(const std::string& folder, const ScaleDescription& description);
  ~ScaleLog();
  ScaleLog(const ScaleLog&) = delete;
  ScaleLog& operator=(const ScaleLog&) = delete;

  const std::string& folder() const { return folder_; }
  const ScaleResults& results() const { return results_; }
  /// The record of a point, by its name (pointName); empty if nothing is known of it.
  const PointRecord& record(const std::string& point) const;

  // Each adds a line, and throws MachineError if it can't be written. A machine that is in the log isn't
  // added again.
  void append(const Machine& machine);
  void append(const std::string& point, const PointCheck& check);
  void append(const std::string& point, int repeat, const PointRun& run);

 private:
  void appendLine(const std::string& line);

  std::string folder_;
  int descriptor_ = -1;
  ScaleResults results_;
};

/// Reads the log in a folder. Throws InputError if there is none or a line isn't valid.
ScaleResults readScaleLog(const std::string& folder);

/// The path of a picture file that the log in a folder names. A log may come from anybody, so this throws
/// InputError unless the file, after following links, is a regular one in the folder.
std::string pictureFile(const std::string& folder, const std::string& file);

/// Merges the logs of an experiment's shards, and their pictures, in a new folder, and returns the results.
/// Throws InputError if they aren't of the same experiment, if two contain the same check or run, if a
/// picture is missing or isn't a file in its shard's folder, if `merged` holds a log already, and unless
/// `mixes_devices` if devices are known to compute differently (ArithmeticCheck); MachineError.
ScaleResults mergeScaleLogs(const std::vector<std::string>& folders, const std::string& merged,
                            bool mixes_devices = false);

/// As the log and results.json write a number: null where it is not finite, for JSON has no infinity.
nlohmann::ordered_json finiteOrNull(double number);
/// All figures by their names.
nlohmann::ordered_json toJson(const KeptBounds& bounds);
/// The figures of kImageMetrics by their names.
nlohmann::ordered_json toJson(const ImageDifference& error);

}  // namespace luciole
