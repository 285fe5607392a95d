#pragma once

#include <optional>
#include <string>

namespace luciole {

/// How many kernels this process has compiled because the platform's cache on disk hadn't got them: 0 is a
/// warm start. platform: its name. Empty for any platform but PoCL, since others don't tell.
std::optional<int> kernelsCompiled(const std::string& platform);

}  // namespace luciole
