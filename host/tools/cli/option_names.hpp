#pragma once

#include <string>

namespace luciole {

/// A message of the library with the names of fields replaced by options of the command line:
/// "settings.crop: 1,2,3,4: ..." becomes "--crop 1,2,3,4: ...".
std::string withOptionNames(std::string message);

}  // namespace luciole
