#pragma once

#include <cstdint>

namespace luciole {

/// The most memory, in bytes, that this process had resident since it began or since resetPeakBytes(). 0
/// where /proc doesn't tell.
std::uint64_t peakBytes();

/// Sets the peak to what is resident at this moment. Where the system can't (Linux before 4.0), nothing
/// happens.
void resetPeakBytes();

}  // namespace luciole
