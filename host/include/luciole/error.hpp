#pragma once

#include <stdexcept>
#include <string>

namespace luciole {

/// The user's input or arguments are wrong. The message is one line: file, place in it, what is wrong,
/// what was expected.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The machine can't do it: no OpenCL device, out of memory, disk full.
struct MachineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace luciole
