#pragma once

#include <string>

namespace luciole {

bool isUtf8(const std::string& text);

/// A text of a picture's header, or a name in it, as UTF-8: where it isn't, its bytes are taken for Latin-1.
std::string headerText(const std::string& bytes);

}  // namespace luciole
