#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace luciole {

/// One line that is rewritten as work goes on: what is done, how much of it, and about how long it still
/// takes. On a terminal only, and not when --quiet.
struct ProgressLine {
  explicit ProgressLine(bool quiet);

  /// `done` of `total`, in any unit that takes about as long each time.
  void show(const std::string& what, std::size_t done, std::size_t total);
  /// Takes the line away, before something else is printed and at the end.
  void clear();

  bool is_shown;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  std::string text;  ///< what stands there
};

/// "0:07", "12:34" or "1:02:03".
std::string duration(double seconds);

}  // namespace luciole
