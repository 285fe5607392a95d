#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace luciole {

/// How many letters must be inserted, left out, replaced or swapped with their neighbour to turn one word
/// into the other, none of them twice (F. Damerau 1964, "A technique for computer detection and correction of
/// spelling errors").
std::size_t editDistance(std::string_view a, std::string_view b);

/// "; did you mean NAME?" with the known name that is nearest to what was typed: one that it is the beginning
/// of, or one within a third of its letters. Empty where none is.
std::string didYouMean(std::string_view typed, const std::vector<std::string>& known);

/// Takes one of these names, and suggests one in the place of another.
CLI::Validator oneOf(const std::vector<std::string>& names);

/// After the command line could not be parsed: " COMMAND: " and what was typed that the command doesn't take,
/// the first of it, with a suggestion. Empty where nothing is left over, so that something else is wrong.
std::string describeUnexpected(const CLI::App& app);

}  // namespace luciole
