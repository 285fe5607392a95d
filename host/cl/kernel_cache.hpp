#pragma once

#include <optional>
#include <string>

namespace luciole {

/// The number of kernels that this process has compiled because the platform's cache on disk lacked them: 0
/// is a warm start. platform: its name. Empty for any platform but PoCL: others don't provide it.
std::optional<int> kernelsCompiled(const std::string& platform);

}  // namespace luciole
