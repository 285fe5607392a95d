#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "luciole/error.hpp"

namespace luciole {

/// What a device couldn't do.
struct DeviceError : MachineError {
  DeviceError(const std::string& message, bool out_of_memory)
      : MachineError(message), is_out_of_memory(out_of_memory) {}

  bool is_out_of_memory;  ///< so that it may manage less
};

/// The error of an OpenCL call as the user reads it: `whose` (the device, and what it was doing), the call,
/// and the error's name in the standard, with "out of memory" for the errors that mean that.
DeviceError deviceError(const cl::Error& error, const std::string& whose);

}  // namespace luciole
