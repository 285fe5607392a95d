#pragma once

#include <string>

namespace luciole {

/// The path of DejaVuSans.ttf in the folders where a desktop keeps fonts (XDG: $XDG_DATA_HOME/fonts, then
/// fonts in each of $XDG_DATA_DIRS), or "" where there is none.
std::string findLabelFont();

}  // namespace luciole
