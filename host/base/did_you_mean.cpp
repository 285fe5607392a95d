#include "base/did_you_mean.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace luciole {
namespace {

std::string_view withoutDashes(std::string_view name) {
  name.remove_prefix(std::min(name.find_first_not_of('-'), name.size()));
  return name;
}

}  // namespace

std::size_t editDistance(std::string_view a, std::string_view b) {
  // Row i holds the distances of a's first i letters from each prefix of b.
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = std::exchange(last, row);
  }
  return last[b.size()];
}

std::string didYouMean(std::string_view typed, const std::vector<std::string>& known) {
  const std::string_view word = withoutDashes(typed);
  std::optional<std::pair<std::size_t, std::string>> nearest;
  for (const std::string& name : known) {
    const std::string_view right = withoutDashes(name);
    const bool begins = word.size() > 1 && right.starts_with(word);
    const std::size_t distance = begins ? 1 : editDistance(word, right);
    if (distance > std::max(word.size() / 3, std::size_t{1}) || distance >= right.size()) continue;
    if (!nearest || distance < nearest->first) nearest.emplace(distance, name);
  }
  return nearest ? fmt::format("; did you mean {}?", nearest->second) : "";
}

}  // namespace luciole
