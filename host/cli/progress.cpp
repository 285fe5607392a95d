#include "cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>

namespace luciole {

ProgressLine::ProgressLine(bool quiet) : is_shown(!quiet && isatty(STDERR_FILENO)) {}

void ProgressLine::show(const std::string& what, std::size_t done, std::size_t total) {
  if (!is_shown) return;
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  std::string line = what;
  if (total > 0) line += fmt::format(": {} %", 100 * std::uint64_t(done) / total);
  if (done > 0)
    line += fmt::format(", {} left", duration(passed.count() / double(done) * double(total - done)));
  if (line == text) return;
  text = line;
  fmt::print(stderr, "\r\x1b[K{}", text);
  std::fflush(stderr);
}

void ProgressLine::clear() {
  if (text.empty()) return;
  text.clear();
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
}

std::string duration(double seconds) {
  const auto whole = std::int64_t(seconds + 0.5);
  return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                      : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace luciole
