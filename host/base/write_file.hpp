#pragma once

#include <string>
#include <string_view>

namespace luciole {

/// Writes a file whole or not at all (see OutputFile); "-" is standard output. Throws InputError (no such
/// folder, read-only folder) or MachineError (disk full).
void writeTextFile(const std::string& path, std::string_view text);

/// Throws the InputError that writing any file to `path` would meet, before any work is done: no such folder,
/// a read-only one, a folder in the file's place.
void checkPlace(const std::string& path);

}  // namespace luciole
