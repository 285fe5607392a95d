#pragma once

#include <string>

namespace luciole {

/// Throws the MachineError that runGnuplot would meet where gnuplot isn't installed.
void requireGnuplot();

/// What gnuplot prints for a script on its standard input: with no `set output`, the picture. The user's own
/// settings don't count. Throws MachineError: not installed, or the first line of what it complains about.
std::string runGnuplot(const std::string& script);

/// Text as a string of a script, whatever characters it holds; control characters become '?'.
std::string gnuplotString(const std::string& text);

}  // namespace luciole
