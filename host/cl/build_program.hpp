#pragma once

#include <string>

#include "cl/device.hpp"

namespace luciole {

/// The program of this source, built with these options for the device: from its binary in the device's
/// program cache where that holds it, otherwise by the platform's compiler, and then kept there. Throws
/// cl::Error as OpenCL does (cl::BuildError with the compiler's log) and MachineError if memory is short.
Program buildProgram(const OpenedDevice& device, const std::string& source, const std::string& options);

/// Everything that determines the bits of a program, as text: its source and options, the device and its
/// driver, the environment variables that compilers read, and this program's version. Throws cl::Error.
std::string describeProgram(const OpenedDevice& device, const std::string& source,
                            const std::string& options);

/// The names and types of a kernel's arguments. Throws cl::Error if OpenCL has no information about them.
std::vector<DeclaredArgument> declaredArguments(const cl::Kernel& kernel);

/// The folder where binaries of this platform's programs are kept from one run to the next (see
/// program_cache.hpp). Empty if the platform keeps them itself, or if there is no place for them.
std::string programCacheOf(const std::string& platform);

}  // namespace luciole
