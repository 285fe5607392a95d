#pragma once

#include <string>
#include <vector>

// PoCL keeps what it has compiled in a folder, and doesn't tell what is there. A file of ours in that folder
// lists the programs that are, so that it is known which others take seconds to compile. Who removes the
// folder removes the list with it.
namespace luciole {

inline constexpr const char* kPoclPlatform = "Portable Computing Language";

/// The folder of PoCL's cache, as the environment names it. Empty if PoCL keeps nothing.
std::string poclCache();

/// Whether the list in this folder names the program of this description (describeProgram). A list that
/// can't be read is empty.
bool isListed(const std::string& folder, const std::string& description);

/// Adds programs that PoCL has kept to the list. Any number of processes may do so at once. A folder that
/// can't be written to is no error.
void addToList(const std::string& folder, const std::vector<std::string>& descriptions);

}  // namespace luciole
