#pragma once

#include <string>
#include <string_view>

namespace luciole {

/// Puts a file in place, whole or not at all; "-" is standard output. Throws InputError (no such folder,
/// read-only folder) or MachineError (disk full).
void writeTextFile(const std::string& path, std::string_view text);

}  // namespace luciole
