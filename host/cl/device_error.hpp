#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "base/error.hpp"

namespace luciole {

/// The error of an OpenCL call as the user reads it: `whose` (the device, and what it was doing), the call,
/// and the error's name in the standard, with "out of memory" for the errors that mean that.
MachineError deviceError(const cl::Error& error, const std::string& whose);

}  // namespace luciole
