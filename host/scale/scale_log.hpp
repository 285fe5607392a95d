#pragma once

#include <map>
#include <string>
#include <vector>

#include "figures/machine.hpp"
#include "scale/scale.hpp"

namespace luciole {

/// Where in the experiment's folder its pictures are.
inline constexpr const char* kPictureFolder = "pictures";

/// What a log holds.
struct ScaleResults {
  ScaleDescription description;
  std::vector<Machine> machines;               ///< each that took part, once
  std::map<std::string, PointRecord> records;  ///< by pointName
};

/// The log of an experiment in a folder, results.jsonl: a first line that describes the experiment, then in
/// any order a line for each machine, each check and each timed run. A line is appended whole and is on the
/// disk when append() returns, so work that is cut off loses what it was doing and no more. It is locked
/// while it is open.
class ScaleLog {
 public:
  /// Opens the log, or begins it, with its folder where that is missing. What follows the last whole line is
  /// cut off. Throws InputError: it is another experiment's, another process has it open, it isn't a log, or
  /// there is no place for one; MachineError.
  ScaleLog(const std::string& folder, const ScaleDescription& description);
  ~ScaleLog();
  ScaleLog(const ScaleLog&) = delete;
  ScaleLog& operator=(const ScaleLog&) = delete;

  const std::string& folder() const { return folder_; }
  const ScaleResults& results() const { return results_; }
  /// Of any point; empty where nothing is known.
  const PointRecord& record(const std::string& point) const;

  // Throw MachineError: the disk is full. A machine that is in the log is not added again.
  void append(const Machine& machine);
  void append(const std::string& point, const PointCheck& check);
  void append(const std::string& point, int repeat, const PointRun& run);

 private:
  void appendLine(const std::string& line);

  std::string folder_;
  int descriptor_ = -1;
  ScaleResults results_;
};

/// Reads the log in a folder. Throws InputError: there is none, or a line isn't of one.
ScaleResults readScaleLog(const std::string& folder);

/// The path of a file that the log in a folder names. A log may come from anybody: throws InputError unless
/// it is a regular file in there, links followed.
std::string pictureFile(const std::string& folder, const std::string& file);

/// Puts what shards of one experiment found together in a new folder, with their pictures. Throws InputError
/// where they aren't of one experiment, where two have the same check or run, where a picture is missing or
/// no file of its shard's folder, and where the folder holds a log already; MachineError.
ScaleResults mergeScaleLogs(const std::vector<std::string>& folders, const std::string& merged);

}  // namespace luciole
