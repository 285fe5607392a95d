#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "base/clock.hpp"

namespace luciole {

/// A progress line on standard error that is rewritten: the work, its progress, and the estimated time left.
/// Only on a terminal, and not with --quiet. With an event log it is instead an event for each percent.
struct ProgressLine {
  explicit ProgressLine(bool quiet);

  /// Shows that `done` of `total` are done, in units that take about equally long.
  void show(const std::string& what, std::size_t done, std::size_t total);
  /// Shows work of unknown length.
  void showBusy(const std::string& what);
  /// Removes the line. Call it before something else is printed, and at the end.
  void clear();

  bool is_shown;
  double start = millisecondsSinceStart();
  std::string text;          ///< the line as it is shown
  std::optional<int> frame;  ///< the current one, for the event
  int percent = -1;          ///< of the last event

 private:
  void put(const std::string& line);
};

/// A RenderSettings::on_long_compile that shows that kernels are being compiled.
std::function<void()> compileReporter(ProgressLine& progress);

/// A time in minutes and seconds, from an hour on in hours, too: "0:07", "12:34" or "1:02:03".
std::string duration(double seconds);

}  // namespace luciole
