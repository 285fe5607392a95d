#pragma once

#include "tools/info/picture_work.hpp"

// What a picture would cost, before it is made: its work times costs of the steps. These are constants that
// were fitted to pictures of 17 scenes.
namespace luciole {

/// What the constants were fitted on.
inline constexpr const char* kEstimateMachine = "two cores of an AMD EPYC of 2024, PoCL 3.1";

/// Milliseconds from the program's start to its end, about: for a PNG, with all kernels compiled before, on
/// kEstimateMachine.
double estimatedMilliseconds(const PictureWork& work);

/// The part of these that pictures after the first one of a process don't take: starting and loading.
double estimatedStart(const PictureWork& work);

/// The most memory that the process takes, in bytes, about.
double estimatedBytes(const PictureWork& work);

}  // namespace luciole
