#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cl/device.hpp"
#include "figures/rounds.hpp"
#include "render/render.hpp"
#include "scene/lights/light_field.hpp"

// A many-light experiment: the same picture by more and more lights, made in several ways. It is done point
// by point, and what is known of the points is kept in a log, from which files and a page are made:
//
//   ScaleExperiment ─► runScale ─► ScaleLog ─► summarizeScale ─► results.csv, growth.json, report.html
//                     (scale.cpp) (scale_log)  (scale_summary)   (scale_files)
namespace luciole {

/// What points differ in, beside the number of lights: an option and the values it takes.
struct ScaleAxis {
  std::string name;
  std::vector<std::string> values;
  bool operator==(const ScaleAxis&) const = default;
};

/// The value of an axis whose option the point leaves to another axis's.
inline constexpr const char* kNotThis = "-";

/// One way to make the picture, with one number of lights.
struct ScalePoint {
  std::uint64_t lights = 0;
  std::vector<std::string> values;  ///< of the axes, in their order, or kNotThis
  bool operator==(const ScalePoint&) const = default;
};

/// What an experiment is, apart from the machine that does it: two of equal descriptions are the same one.
struct ScaleDescription {
  std::string version;                                        ///< of this program
  std::string scene;                                          ///< its file
  std::uint64_t digest = 0;                                   ///< of what that holds, by sceneDigest
  std::vector<std::pair<std::string, std::string>> settings;  ///< that all points share, for people to read
  std::vector<std::uint64_t> lights;                          ///< ascending
  std::vector<ScaleAxis> axes;
  std::vector<ScalePoint> points;  ///< lights ascending, then by the axes' values
  int repeats = 5;                 ///< timed runs of each point
  bool operator==(const ScaleDescription&) const = default;
};

/// How a point's picture is made.
struct ScaleTask {
  RenderSettings settings;
  std::size_t field = 0;  ///< of ScaleExperiment::fields: its first lights take the place of the scene's
  /// Lights in range of what the camera sees, on average, that their range is chosen for; 0: as the field has
  /// it.
  double density = 0;
};

struct ScaleExperiment {
  ScaleDescription description;
  std::vector<ScaleTask> tasks;     ///< one a point
  std::vector<LightField> fields;   ///< of as many lights as any point has
  std::size_t check_pixels = 1024;  ///< about how many are held against the reference
  std::uint64_t seed = 0;           ///< which ones
  int truth_samples = 1;            ///< samples a pixel that make the truth
};

/// What is found once of a point: how right its picture is, and what counts in making it.
struct PointCheck {
  std::uint64_t pairs_evaluated = 0, pairs_in_range = 0, pixels_lit = 0, list_entries = 0;
  double reach =
      0;  ///< metres: the range of the light that reaches farthest; infinite where one reaches everywhere
  std::uint64_t pixels = 0;                    ///< held against the reference
  double mean_abs = 0, max_abs = 0, rmse = 0;  ///< from it, linear
  std::string picture, error_map, list_map;    ///< files in the experiment's folder
};

/// Figures of a check that JSON has no number for, by name, and why.
std::vector<std::pair<std::string, std::string>> reasonsForNull(const PointCheck& check);

/// One timed run.
struct PointRun {
  std::vector<std::pair<std::string, double>> stages;  ///< milliseconds, in order
  std::uint64_t device_bytes = 0;
  std::uint64_t peak_bytes = 0;  ///< the most that the process had resident during the run
};

/// What is known of a point.
struct PointRecord {
  std::optional<PointCheck> check;
  std::map<int, PointRun> runs;  ///< by repeat, counted from 0
};

/// The point in one line, and its key in the log: "lights=1000 culling=tiles tile=4".
std::string pointName(const ScaleDescription& description, const ScalePoint& point);

class ScaleLog;

/// A point that the machine can't do, and why.
struct ScaleFailure {
  std::string point, reason;
};

/// Does what the log lacks of the points `mine` (indices): checks each once, with its pictures written into
/// the log's folder, then times all of them in rounds, each warmed up before. A point that fails is left out,
/// and told in the result. The scene's lights are replaced. `on_progress` gets milliseconds as done and
/// total, the total an estimate. Throws InputError, and MachineError where the log can't be written.
std::vector<ScaleFailure> runScale(Device& device, Scene& scene, const ScaleExperiment& experiment,
                                   const std::vector<std::size_t>& mine, ScaleLog& log,
                                   const OnProgress& on_progress);

}  // namespace luciole
