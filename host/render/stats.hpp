#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cl/device.hpp"

namespace luciole {

/// The steps to a picture that are timed, roughly in their order.
enum class Stage : std::uint8_t {
  kLoadScene,
  kReadGBuffer,
  kOpenDevice,
  kCompileKernels,
  kWaitForDevice,
  kWaitForKernels,
  kRayTree,
  kPrepareLights,
  kGatherVertices,
  kRasterize,
  kCull,
  kFindShadowTexels,
  kShadowMaps,
  kClassify,
  kTraceUnsure,
  kShade,
  kReadBack,
  kResolve,
  kCountLights,
  kCheckGBuffer,
  kWrite,
};

/// As --stats, bench and scale call it.
const char* stageName(Stage stage);

/// Whether it is done once a program, and so is no work on the picture: the device's and the kernels' start.
bool isStart(Stage stage);

/// What a picture cost: the content of --stats.
struct Stats {
  std::string command;
  DeviceDescription device;
  std::uint64_t triangles = 0;
  std::uint64_t lights = 0;
  std::vector<std::string> features;
  std::vector<std::string> warnings;  ///< see Scene::warnings
  int width = 0, height = 0, samples = 1;
  std::vector<std::pair<Stage, double>>
      stages;  ///< milliseconds, summed over the samples, in order of first use
  /// Of the stages, those that ran in threads of their own while others did
  std::vector<Stage> beside;
  double began = 0;  ///< when the picture was begun, in milliseconds since the process's start
  std::vector<std::pair<std::string, std::uint64_t>> counts;
  std::vector<std::pair<std::string, double>> errors;  ///< measured ones, where a command measures any
  /// OpenCL buffers of one sample of the largest band, those shared with the host included
  std::size_t device_bytes = 0;
  Traffic traffic;  ///< of the whole picture, compiling its kernels included
};

/// Adds `milliseconds` to the stage.
void addStage(Stats& stats, Stage stage, double milliseconds);

/// The milliseconds of the clock that a function takes.
template <class Function>
double millisecondsOf(Function&& function) {
  const auto start = std::chrono::steady_clock::now();
  function();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Runs a stage and adds the time it took.
template <class Function>
auto timed(Stats& stats, Stage stage, Function&& function) {
  struct Timer {
    Stats& stats;
    Stage stage;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    ~Timer() {
      addStage(stats, stage,
               std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
  } timer{stats, stage};
  return function();
}

/// How much of the picture's time passed in a stage: what it took, or nothing of one that ran beside others.
/// Of all stages that adds up to the picture's time at most.
double ownShare(const Stats& stats, const std::pair<Stage, double>& stage);

/// Milliseconds of a stage; 0 for one that did not run.
double stageTime(const Stats& stats, Stage stage);

/// A count of the statistics; 0 for one that isn't there.
std::uint64_t countOf(const Stats& stats, std::string_view name);

/// Milliseconds since the picture was begun.
double pictureMilliseconds(const Stats& stats);

/// The JSON text that --stats writes, by the names of the interface. Of the time it says:
/// - stages: how long each took, in milliseconds. The device is opened and kernels are compiled by threads of
///   their own while other stages run, so the sum may be more than the whole; "wait for …" is what was left
///   to wait for them. wall_milliseconds of a stage: its own share of the whole (see ownShare).
/// - picture_milliseconds: the whole, from the picture's beginning to this text. The first picture's is the
///   process's start.
/// - wall_milliseconds: from the process's start to this text (see millisecondsSinceStart).
/// - cold_start_milliseconds: opening the device and compiling the kernels.
/// - kernels_compiled: whether that start was a cold one: how many kernels weren't in the cache, 0 where all
///   were, null where the platform doesn't tell (see kernelsCompiled).
/// Of memory it says:
/// - peak_bytes: of the process, by the system. device_bytes: see Stats.
/// - uploaded_bytes, downloaded_bytes, made_bytes: see Traffic.
std::string statsJson(const Stats& stats);

}  // namespace luciole
