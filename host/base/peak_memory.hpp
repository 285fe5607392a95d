#pragma once

#include <cstdint>

namespace luciole {

/// The most memory that this process had resident, bytes, since it began or since resetPeakBytes().
std::uint64_t peakBytes();

/// Starts anew from what is resident now. Where the system can't (Linux before 4.0), nothing happens.
void resetPeakBytes();

}  // namespace luciole
