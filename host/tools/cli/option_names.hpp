#pragma once

#include <string>

namespace luciole {

/// A message of the library with the options of the command line in the place of the fields that it names:
/// "settings.crop: 1,2,3,4: ..." becomes "--crop 1,2,3,4: ...".
std::string withOptionNames(std::string message);

}  // namespace luciole
