#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace luciole {

/// Whether there is a regular file of this name. False, too, for a name that the system refuses, such as one
/// of thousands of characters, for which std::filesystem throws.
bool isFile(const std::filesystem::path& path);

/// The whole file. Throws InputError where it can't be read.
std::string readFile(const std::string& path);

/// Words from a file or a library made fit for a one-line message: control characters become blanks, trailing
/// blanks go, and what is longer than 200 characters is cut.
std::string forMessage(std::string_view words);

/// ASCII letters alone.
bool equalIgnoringCase(std::string_view a, std::string_view b);

}  // namespace luciole
