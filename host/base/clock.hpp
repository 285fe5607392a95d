#pragma once

#include <cstdint>

namespace luciole {

/// Nanoseconds since the program was loaded into this process. A shell may have lived in it before. The one
/// clock of stages, statistics and traces; it runs at the same pace whatever is done to the time of day.
std::int64_t nanosecondsSinceStart();

/// The same in milliseconds.
double millisecondsSinceStart();

}  // namespace luciole
