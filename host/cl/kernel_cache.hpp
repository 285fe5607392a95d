#pragma once

#include <optional>
#include <string>

namespace luciole {

/// Milliseconds since this process started. The system tells the start in steps of 10 ms, so up to that much
/// more than was.
double millisecondsSinceStart();

/// How many kernels this process had to compile because the platform's cache on the disk hadn't got them: 0
/// is a warm start. Empty where the platform doesn't tell, which is any but PoCL.
std::optional<int> kernelsCompiled(const std::string& platform);

}  // namespace luciole
