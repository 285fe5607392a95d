#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cl/device.hpp"
#include "luciole/compare.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"
#include "render/render.hpp"
#include "scene/lights/light_field.hpp"
#include "tools/figures/kept_bounds.hpp"
#include "tools/figures/rounds.hpp"

// A many-light experiment: the same picture with more and more lights, made in several ways. A point is one
// number of lights and one way. A log keeps the results of points; from it files and a page are made:
//
//   ScaleExperiment ─► runScale ─► ScaleLog ─► summarizeScale ─► results.csv, growth.json, report.html
//                     (scale.cpp) (scale_log)  (scale_summary)   (scale_files)
namespace luciole {

/// An option in which points differ, beside the number of lights, and the values that it takes.
struct ScaleAxis {
  std::string name;
  std::vector<std::string> values;
  bool operator==(const ScaleAxis&) const = default;
};

/// The value of an axis whose option doesn't apply to the point, because an option of another axis replaces
/// it.
inline constexpr const char* kNotThis = "-";
/// The axis of ShadeSettings::light_error.
inline constexpr const char* kLightErrorAxis = "light-error";
/// The axis of ShadeSettings::confidence.
inline constexpr const char* kConfidenceAxis = "confidence";

/// The axis of who made the picture, in experiments with other methods: kOwnMethod, or one of their names.
inline constexpr const char* kMethodAxis = "method";
inline constexpr const char* kOwnMethod = "luciole";
/// The only stage of a run of another method.
inline constexpr const char* kOtherStage = "other method";

/// Another method, whose pictures join an experiment.
struct ScaleMethod {
  std::string name;
  int runs = 0;  ///< times of each of its points, as many as the experiment's repeats or 1; 0: it is held
                 ///< against the truth, and not timed
  bool operator==(const ScaleMethod&) const = default;
};

/// One way to make the picture, with one number of lights.
struct ScalePoint {
  std::uint64_t lights = 0;
  std::vector<std::string> values;  ///< of the axes, in their order, or kNotThis
  bool operator==(const ScalePoint&) const = default;
};

/// The definition of an experiment, without the machine that runs it. Equal descriptions mean the same
/// experiment.
struct ScaleDescription {
  std::string version;                                        ///< of this program
  std::string scene;                                          ///< its file
  std::uint64_t digest = 0;                                   ///< of the scene's content, by sceneDigest
  std::vector<std::pair<std::string, std::string>> settings;  ///< that all points share, for people to read
  std::vector<std::uint64_t> lights;                          ///< ascending
  std::vector<ScaleAxis> axes;
  std::vector<ScalePoint> points;  ///< lights ascending, then by the axes' values
  int repeats = 5;                 ///< timed runs of each of Luciole's own points
  std::vector<ScaleMethod> methods{};
  bool operator==(const ScaleDescription&) const = default;
};

/// How another method's picture comes.
struct OtherPicture {
  std::string file{};                    ///< empty: AskForPicture makes it
  std::optional<double> milliseconds{};  ///< that the file's picture took
};

/// How a point's picture is made.
struct ScaleTask {
  RenderSettings settings;
  std::size_t field = 0;  ///< index into ScaleExperiment::fields: its first lights replace the scene's
  /// The range of all lights is chosen so that, on average, so many reach a point that the camera sees. 0:
  /// the range is the field's.
  double density = 0;
  /// After that ranges are removed, and the lights are as bright on average as before (removeRanges).
  bool no_range = false;
  std::optional<OtherPicture> other{};  ///< of a method's point: as if by the settings above
};

/// What AskForPicture gets, and what it gives.
struct PictureRequest {
  std::string method;
  std::uint64_t lights = 0;
  int round = 0;       ///< from 1 on; 0: the picture that is looked at, and not timed
  const Scene& scene;  ///< with these lights
  const Camera& camera;
  glm::ivec2 size;
};
struct AskedPicture {
  double milliseconds = 0;
  std::string file;  ///< of round 0: see readMethodPicture()
};
/// A method couldn't make a picture, which is left out.
struct NoPicture : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// Has another method make a picture. Throws NoPicture, and anything else to end the experiment.
using AskForPicture = std::function<AskedPicture(const PictureRequest& request)>;

struct ScaleExperiment {
  ScaleDescription description;
  std::vector<ScaleTask> tasks;    ///< one for each of description.points
  std::vector<LightField> fields;  ///< with at least as many lights as any point
  /// Replaces the scene's surfaces. The tasks' settings then have its size and camera.
  std::optional<GBuffer> gbuffer{};
  std::size_t check_pixels = 1024;  ///< about how many pixels are compared with the reference
  std::uint64_t seed = 0;           ///< chooses these pixels
  /// Points' lights are of the scene's sources, so many each (setLightCounts), and the truth is by so many;
  /// 0: they are the fields' and the truth is by the same lights.
  std::uint32_t truth_lights = 0;
  int truth_samples = 1;      ///< samples a pixel that make the truth
  std::size_t too_exact = 0;  ///< points that were left out because summing each light takes too long
  std::vector<std::string> missing{};  ///< other methods' points that were left out, a line each, for people
};

/// The results of a point that are measured once: the error of its picture, and counts.
struct PointCheck {
  // Counts, and the maps of lists and bounds, are of Luciole's own pictures alone.
  /// Of a pixel and a light, or a cluster that stands for lights; and rays to sampled lights
  std::uint64_t pairs_evaluated = 0;
  std::uint64_t pairs_in_range = 0, pixels_lit = 0, list_entries = 0;
  double reach =
      0;  ///< metres: the range of the light that reaches farthest; infinite where one reaches everywhere
  std::uint64_t pixels = 0;  ///< compared with the reference
  ImageDifference error{};   ///< of these pixels from the reference: kImageMetrics alone are kept
  std::string picture{}, error_map{}, list_map{};  ///< files in the experiment's folder
  /// Where no light of a picture of one sample a pixel is summed by itself, and a map of the bounds
  std::optional<KeptBounds> bounds{};
  std::string bound_map{};
};

/// The names of a check's figures that aren't finite, which JSON can't hold, each with the reason.
std::vector<std::pair<std::string, std::string>> reasonsForNull(const PointCheck& check);

/// One timed run.
struct PointRun {
  std::vector<std::pair<std::string, double>> stages;  ///< milliseconds, in order
  std::uint64_t device_bytes = 0;
  std::uint64_t peak_bytes = 0;  ///< the most that the process had resident during the run
};

/// The results of a point so far.
struct PointRecord {
  std::optional<PointCheck> check;
  std::map<int, PointRun> runs;  ///< by repeat, counted from 0
};

/// The point in one line, and its key in the log: "lights=1000 culling=tiles tile=4".
std::string pointName(const ScaleDescription& description, const ScalePoint& point);

class ScaleLog;

/// A point that failed, and the reason.
struct ScaleFailure {
  std::string point, reason;
  bool is_of_method = false;  ///< another's, rather than the machine's
};

/// Measures what the log lacks of the points `mine` (indices): checks each once and writes its pictures into
/// the log's folder, then times all of them in rounds, after an untimed run of each point that this call
/// didn't check. Replaces the scene's lights. ask: for tasks whose `other` has no file. on_progress: gets
/// milliseconds as done and total; the total is an estimate. Returns the points at which the machine or
/// another method failed, which are left out. Throws InputError if a density is asked for and the camera sees
/// nothing, MachineError if the log can't be written, and what `ask` throws.
std::vector<ScaleFailure> runScale(OpenedDevice& device, Scene& scene, const ScaleExperiment& experiment,
                                   const std::vector<std::size_t>& mine, ScaleLog& log,
                                   const AskForPicture& ask, const OnProgress& on_progress);

}  // namespace luciole
