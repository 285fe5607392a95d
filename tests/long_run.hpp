#pragma once

#include <cstdlib>

namespace luciole::test {

/// Whether LUCIOLE_LONG is set. Tests that try as much as a fixed budget allows (random scenes, sizes,
/// repetitions) then try more; what they expect stays the same.
inline bool longRun() { return std::getenv("LUCIOLE_LONG") != nullptr; }

}  // namespace luciole::test
