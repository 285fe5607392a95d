#pragma once

#include <string>
#include <string_view>

namespace luciole {

/// The source of kernels/`name` with each of its includes in place of its first #include. #line directives
/// make a compiler's message name the real file and line. user_text: takes the place of user_text.clh's text
/// if it isn't empty. Throws std::logic_error for an unknown name.
std::string kernelSource(std::string_view name, std::string_view user_text = {});

/// The same for a kernel file that isn't embedded in the program, such as a test's. text: its content, which
/// may include embedded ones; name: what messages call it.
std::string expandKernelSource(std::string_view name, std::string_view text, std::string_view user_text = {});

}  // namespace luciole
