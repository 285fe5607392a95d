#pragma once

#include <cstdint>
#include <utility>

#include "base/clock.hpp"
#include "luciole/stats.hpp"

namespace luciole {

/// Whether a stage is part of a process's start rather than of a picture: opening the device, compiling
/// kernels, and waiting for them.
bool isStart(Stage stage);

/// Adds `milliseconds` to the stage, which starts at 0.
void addStage(Stats& stats, Stage stage, double milliseconds);

/// Adds the statistics of one of several devices that rendered a picture in parallel. Times are sums over the
/// devices. Counts of the scene, which all devices have, are taken from the first.
void addPart(const Stats& part, Stats& whole);

/// Ends a stage that began at `begin` (nanosecondsSinceStart()): records it for a trace, and returns the
/// milliseconds that it took.
double endStage(Stage stage, std::int64_t begin);

/// Wall-clock milliseconds that a function takes.
template <class Function>
double millisecondsOf(Function&& function) {
  const std::int64_t begin = nanosecondsSinceStart();
  function();
  return 1e-6 * double(nanosecondsSinceStart() - begin);
}

/// Runs a stage, adds its time, also if it throws, and records it for a trace. Returns its result.
template <class Function>
auto timed(Stats& stats, Stage stage, Function&& function) {
  struct Timer {
    Stats& stats;
    Stage stage;
    std::int64_t begin = nanosecondsSinceStart();
    ~Timer() { addStage(stats, stage, endStage(stage, begin)); }
  } timer{stats, stage};
  return function();
}

/// A stage's share of the picture's time, milliseconds: the time it took, or 0 if it ran beside others. The
/// sum over all stages is at most the picture's time.
double ownShare(const Stats& stats, const std::pair<Stage, double>& stage);

}  // namespace luciole
