#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace luciole {

/// The number of bytes that must be inserted, removed, replaced or swapped with their neighbour, each at most
/// once, to turn one word into the other (F. Damerau, "A technique for computer detection and correction of
/// spelling errors", 1964). O(|a|·|b|).
std::size_t editDistance(std::string_view a, std::string_view b);

/// "; did you mean NAME?" with the known name nearest to what was typed: one that starts with it, or one
/// whose editDistance() is at most 1 or a third of what was typed. Empty if there is none.
std::string didYouMean(std::string_view typed, const std::vector<std::string>& known);

/// A validator that accepts these names only, and suggests one of them for others.
CLI::Validator oneOf(const std::vector<std::string>& names);

/// Explains why the command line couldn't be parsed: " COMMAND: " and the first argument that the command
/// doesn't take, with a suggestion. Empty if no argument is left over, so that something else is wrong.
std::string describeUnexpected(const CLI::App& app);

}  // namespace luciole
