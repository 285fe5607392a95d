#include "base/clock.hpp"

#include <chrono>

namespace luciole {
namespace {

using Clock = std::chrono::steady_clock;

/// When the library was loaded.
const Clock::time_point kLoaded = Clock::now();

}  // namespace

std::int64_t nanosecondsSinceStart() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - kLoaded).count();
}

double millisecondsSinceStart() { return 1e-6 * double(nanosecondsSinceStart()); }

}  // namespace luciole
