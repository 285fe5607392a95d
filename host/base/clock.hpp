#pragma once

#include <cstdint>

namespace luciole {

/// Nanoseconds since the program was loaded. That may be later than the process's start, if a shell became
/// the program by exec. The clock of stages, statistics and traces; it is monotonic.
std::int64_t nanosecondsSinceStart();

/// The same in milliseconds.
double millisecondsSinceStart();

}  // namespace luciole
