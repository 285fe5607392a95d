#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "luciole/device.hpp"

namespace luciole {

/// The steps to a picture that are timed, roughly in their order.
enum class Stage : std::uint8_t {
  kLoadScene,
  kReadGBuffer,
  kOpenDevice,
  kCompileKernels,
  kWaitForDevice,
  kWaitForKernels,
  kMeasureExposure,
  kTriangleTree,
  kPrepareLights,
  kGatherVertices,
  kRasterize,
  kChangeSurfaces,
  kCull,
  kFindShadowTexels,
  kShadowMaps,
  kBeamShadows,
  kShadowRays,
  kClusteredLight,
  kSampledLight,
  kShade,
  kReadBack,
  kScreens,
  kResolve,
  kCountLights,
  kCheckGBuffer,
  kWrite,
};

/// The stage's name in statsJson() and statsCsv().
const char* stageName(Stage stage);

/// Half widths of the intervals of light by ShadeSettings::light_error, in all channels of all points that
/// were lit, in linear radiance before exposure.
struct LightErrorStats {
  double largest = 0, sum = 0;
  double proven = 0;  ///< the sum of their proven parts
  /// The least E that would allow all proven parts: the largest of them / max(light_error_floor, colour).
  double least = 0;
  std::uint64_t values = 0;
};

/// The part of a picture that one of several devices made.
struct DeviceShare {
  DeviceDescription device = {};
  std::uint64_t rows = 0;   ///< that it made
  double milliseconds = 0;  ///< of work on these rows
  std::string error = {};   ///< why it dropped out; empty: it didn't
};

/// The statistics of a picture.
struct Stats {
  std::string command = {};
  DeviceDescription device = {};
  std::vector<DeviceShare> shares = {};  ///< where several devices made the picture
  std::uint64_t triangles = 0;
  std::uint64_t lights = 0;
  std::vector<std::string> features = {};
  std::vector<std::string> warnings = {};  ///< the scene's (Scene::warnings), then the picture's own
  int width = 0, height = 0, samples = 1;
  std::optional<double> measured_exposure = {};  ///< stops, if the picture's exposure was measured
  std::vector<std::pair<Stage, double>>
      stages;  ///< milliseconds, summed over the samples, in order of first use
  /// Stages that ran in threads of their own, in parallel to others
  std::vector<Stage> beside = {};
  double began = 0;       ///< when the picture was begun, in milliseconds since the program's start
  std::string hash = {};  ///< SHA-256 of the picture's linear floats, in hexadecimal; empty: not computed
  std::vector<std::pair<std::string, std::uint64_t>> counts = {};
  std::vector<std::pair<std::string, double>> errors = {};  ///< by name, if the command measures any
  LightErrorStats light_error = {};                         ///< without values if each light was summed
  /// Bytes of OpenCL buffers for one sample of the largest band, including those in the host's arrays
  std::size_t device_bytes = 0;
  Traffic traffic = {};  ///< of the whole picture, compiling its kernels included
};

/// Milliseconds of a stage; 0 if it did not run.
double stageTime(const Stats& stats, Stage stage);

/// A count by its name; 0 if there is none.
std::uint64_t countOf(const Stats& stats, std::string_view name);

/// The statistics as JSON. ended: when the picture was done, in milliseconds since the program's start.
/// Times:
/// - stages: how long each took, in milliseconds. Opening the device and compiling kernels run in threads of
///   their own beside other stages, so the sum may be more than the whole; "wait for …" is the time that the
///   picture had to wait for them. wall_milliseconds of a stage: its time, or 0 if it ran beside others.
/// - picture_milliseconds: the whole, from the picture's beginning to its end. The first picture's beginning
///   is the program's start.
/// - wall_milliseconds: from the program's start to the picture's end.
/// - cold_start_milliseconds: opening the device and compiling the kernels.
/// - kernels_compiled: how many kernels weren't in the cache: 0 if the start was a warm one, null if the
///   platform doesn't report it, as all but PoCL.
/// - threads: those that the process has now. device.compute_units: see DeviceDescription.
/// Memory:
/// - peak_bytes: of the process, as the system counts it. device_bytes: see Stats.
/// - uploaded_bytes, downloaded_bytes, made_bytes: see Traffic.
std::string statsJson(const Stats& stats, double ended);

/// The same as two lines of CSV: names, and values. The columns are always the same, so that the files of
/// many runs make one table; a cell is empty where there is no such figure, and 0 for a stage that did not
/// run or a count of nothing. What has no fixed number of values (features, warnings, several devices) is in
/// the JSON alone.
std::string statsCsv(const Stats& stats, double ended);

}  // namespace luciole
