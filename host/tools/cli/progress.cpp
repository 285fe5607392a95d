#include "tools/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>

#include "tools/cli/event_log.hpp"

namespace luciole {

ProgressLine::ProgressLine(bool quiet) : is_shown(!quiet && !logsEvents() && isatty(STDERR_FILENO)) {}

void ProgressLine::show(const std::string& what, std::size_t done, std::size_t total) {
  if (!is_shown && !logsEvents()) return;
  const int percent_done = total > 0 ? int(100 * std::uint64_t(done) / total) : 0;
  const double passed = 1e-3 * (millisecondsSinceStart() - start);
  const double left = done > 0 ? passed / double(done) * double(total - done) : 0;
  if (logsEvents()) {
    if (std::exchange(percent, percent_done) == percent_done) return;
    EventFields fields;
    if (frame) fields["frame"] = *frame;
    fields["what"] = what;
    fields["percent"] = percent_done;
    if (done > 0) fields["milliseconds_left"] = std::round(1000 * left);
    logEvent("progress", fields);
    return;
  }
  std::string line = what;
  if (total > 0) line += fmt::format(": {} %", percent_done);
  if (done > 0) line += fmt::format(", {} left", duration(left));
  put(line);
}

void ProgressLine::showBusy(const std::string& what) {
  if (logsEvents()) {
    EventFields fields;
    if (frame) fields["frame"] = *frame;
    fields["what"] = what;
    logEvent("progress", fields);
  } else if (is_shown) {
    put(what);
  }
}

void ProgressLine::put(const std::string& line) {
  if (line == text) return;
  text = line;
  writeError(fmt::format("\r\x1b[K{}", text));
}

void ProgressLine::clear() {
  if (text.empty()) return;
  text.clear();
  writeError("\r\x1b[K");
}

std::function<void()> compileReporter(ProgressLine& progress) {
  return [&progress] { progress.showBusy("compiling kernels"); };
}

std::string duration(double seconds) {
  const auto whole = std::int64_t(seconds + 0.5);
  return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                      : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace luciole
