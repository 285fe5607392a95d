#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace luciole {

/// Whether there is a regular file of this name. False, too, for a name that the system refuses, such as one
/// of thousands of characters, for which std::filesystem throws.
bool isFile(const std::filesystem::path& path);

/// All bytes of a file. Throws InputError where it can't be read, MachineError where it doesn't fit into
/// memory.
std::string readFile(const std::string& path);

/// Text from a file or a library, made fit for a one-line message: control characters become blanks, trailing
/// blanks are removed, at most 200 bytes are kept, and what isn't UTF-8 is taken as Latin-1.
std::string forMessage(std::string_view words);

/// Whether two texts are equal if the case of ASCII letters is ignored.
bool equalIgnoringCase(std::string_view a, std::string_view b);

}  // namespace luciole
