#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "base/error.hpp"

namespace luciole {

/// The error of an OpenCL call as the user reads it: whose it is (the device, and what it was at), the call,
/// and the error's name in the standard. It says so where memory is short.
MachineError deviceError(const cl::Error& error, const std::string& whose);

}  // namespace luciole
