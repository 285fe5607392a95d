#pragma once

#include <string>
#include <string_view>

namespace luciole {

/// The source of kernels/`name` with its includes put in place, each once, under #line directives so that a
/// compiler's message names the real file and line. Throws std::logic_error for a name that isn't there.
std::string kernelSource(std::string_view name);

/// The same for a kernel file that is not among the embedded ones, such as a test's: its text, which may
/// include them.
std::string expandKernelSource(std::string_view name, std::string_view text);

}  // namespace luciole
