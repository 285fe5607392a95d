#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "luciole/error.hpp"

namespace luciole {

/// An error of a device.
struct DeviceError : MachineError {
  DeviceError(const std::string& message, bool out_of_memory)
      : MachineError(message), is_out_of_memory(out_of_memory) {}

  bool is_out_of_memory;  ///< a smaller piece of work may succeed
};

/// The error of an OpenCL call with a message for the user: `context` (the device and its work), the call,
/// and the error's name in the standard, with "out of memory" for the errors that mean that.
DeviceError deviceError(const cl::Error& error, const std::string& context);

}  // namespace luciole
