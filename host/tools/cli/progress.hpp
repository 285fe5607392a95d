#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "base/clock.hpp"

namespace luciole {

/// A line on standard error that is rewritten as work goes on: what is done, how much of it, and about how
/// long it will still take. Only on a terminal, and not with --quiet. With an event log, in place of the
/// line, an event for each percent that is done.
struct ProgressLine {
  explicit ProgressLine(bool quiet);

  /// Shows that `done` of `total` are done, in units that take about equally long.
  void show(const std::string& what, std::size_t done, std::size_t total);
  /// Says what is waited for, and nobody knows how long.
  void tell(const std::string& what);
  /// Removes the line. Call it before something else is printed, and at the end.
  void clear();

  bool is_shown;
  double start = millisecondsSinceStart();
  std::string text;          ///< the line as it is shown
  std::optional<int> frame;  ///< that is being made, for the event
  int percent = -1;          ///< that the last event told

 private:
  void put(const std::string& line);
};

/// What tells that kernels are being compiled, for RenderSettings::on_long_compile.
std::function<void()> compileReporter(ProgressLine& progress);

/// A time in minutes and seconds, from an hour on in hours, too: "0:07", "12:34" or "1:02:03".
std::string duration(double seconds);

}  // namespace luciole
