#pragma once

#include "tools/info/picture_work.hpp"

// Estimates of a picture's time and memory: its work, times the costs of the steps. These are constants that
// were fitted to pictures of 17 scenes.
namespace luciole {

/// The machine that the constants were fitted on.
inline constexpr const char* kEstimateMachine = "two cores of an AMD EPYC of 2024, PoCL 3.1";

/// Estimated milliseconds from the program's start to its end, for a PNG, with all kernels in the cache, on
/// kEstimateMachine.
double estimatedMilliseconds(const PictureWork& work);

/// The part of estimatedMilliseconds() for starting and loading, which only the first picture of a process
/// takes.
double estimatedStart(const PictureWork& work);

/// The estimated peak memory of the process, in bytes.
double estimatedBytes(const PictureWork& work);

}  // namespace luciole
