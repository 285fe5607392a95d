#pragma once

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

}  // namespace luciole
