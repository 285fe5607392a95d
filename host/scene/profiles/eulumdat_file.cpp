// EULUMDAT: A. Stockmar, "EULUMDAT – ein Leuchtendatenformat für den europäischen Beleuchtungsplaner" (1990).
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/profiles/profile_table.hpp"

namespace luciole {
namespace {

/// The lines of a file, a value each.
struct LdtText {
  const std::string& name;
  std::vector<std::string_view> lines = {};

  [[noreturn]] void refuse(std::size_t line, const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", name, line, what));
  }

  /// line: from 1 on. A comma counts as the decimal point.
  double number(std::size_t line, const std::string& what, double low = -1e12, double high = 1e12) const {
    std::string word(line <= lines.size() ? lines[line - 1] : "");
    word.erase(0, word.find_first_not_of(" \t+"));
    word.erase(word.find_last_not_of(" \t\x1a") + 1);
    std::replace(word.begin(), word.end(), ',', '.');
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size() ||
        !(value >= low && value <= high))
      refuse(line, fmt::format("{} is {}, expected a number from {} to {}", what,
                               word.empty() ? "missing" : fmt::format("'{}'", forMessage(word)), low, high));
    return value;
  }

  std::size_t count(std::size_t line, const std::string& what, double low, double high) const {
    const double value = number(line, what, low, high);
    if (value != std::floor(value))
      refuse(line, fmt::format("{} is {}, expected a whole number", what, value));
    return std::size_t(value);
  }

  std::vector<double> angles(std::size_t line, const std::string& what, std::size_t count,
                             double high) const {
    std::vector<double> all;
    for (std::size_t i = 0; i < count; ++i) {
      all.push_back(number(line + i, fmt::format("{} angle {}", what, i + 1), 0, high));
      if (i > 0 && all[i] <= all[i - 1])
        refuse(line + i,
               fmt::format("{} angle {} is {}, expected more than {}", what, i + 1, all[i], all[i - 1]));
    }
    return all;
  }
};

std::vector<std::string_view> linesOf(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end);
    if (text.starts_with("\r\n")) text.remove_prefix(1);
    if (!text.empty()) text.remove_prefix(1);
  }
  return lines;
}

}  // namespace

ProfileTable parseEulumdat(std::string_view bytes, const std::string& name, std::vector<Warning>& warnings) {
  // Numbers of lines as the format counts them, without sets of lamps and what follows these.
  enum : std::size_t { kSymmetry = 3, kPlanes = 4, kAngles = 6, kFactor = 24, kSets = 26, kSetLines = 6 };
  const LdtText text{name, linesOf(bytes)};
  const std::size_t symmetry = text.count(kSymmetry, "the symmetry Isym", 0, 4),
                    planes = text.count(kPlanes, "the number of planes", 1, double(kMostEntries)),
                    angles = text.count(kAngles, "the number of angles", 2, double(kMostEntries)),
                    sets = text.count(kSets, "the number of sets of lamps", 1, 1e6);
  if (symmetry > 1 && planes % (symmetry == 2 ? 2 : 4) != 0)
    text.refuse(kPlanes, fmt::format("{} planes, expected a multiple of {} for the symmetry {}", planes,
                                     symmetry == 2 ? 2 : 4, symmetry));
  constexpr std::size_t kRoomIndices = 10;
  const std::size_t first_plane = kSets + 1 + sets * kSetLines + kRoomIndices,
                    first_angle = first_plane + planes, first_value = first_angle + angles;
  const std::size_t stored = symmetry == 0   ? planes
                             : symmetry == 1 ? 1
                             : symmetry == 4 ? planes / 4 + 1
                                             : planes / 2 + 1;
  if (first_value - 1 + stored * angles > text.lines.size())
    text.refuse(text.lines.size(), fmt::format("the file ends, expected {} lines for {} planes of {} angles",
                                               first_value - 1 + stored * angles, stored, angles));
  // Candela are told for a thousand lumens of the first set's lamps.
  const double lumens = text.number(kSets + 3, "the lamps' luminous flux", 0);
  const double factor = text.number(kFactor, "the conversion factor", 0), scale = lumens / 1000 * factor;
  ProfileTable table;
  table.lamp_lumens = lumens;
  table.vertical = text.angles(first_angle, "vertical", angles, 180);
  const std::vector<double> all = text.angles(first_plane, "plane", planes, 360);
  if (all.front() != 0) text.refuse(first_plane, fmt::format("plane angle 1 is {}, expected 0", all.front()));
  // Of symmetry 3 the planes from 270 over 0 to 90 degrees are stored; what they mirror goes from 270 down to
  // 90, and is turned around.
  for (std::size_t i = 0; i < stored; ++i)
    table.horizontal.push_back(symmetry == 3 ? all[planes / 4 + i] : all[i]);
  if (symmetry == 0 && all.back() != 360) table.horizontal.push_back(360);
  std::size_t negative_line = 0;
  for (std::size_t i = 0; i < table.horizontal.size(); ++i) {
    const std::size_t plane = symmetry == 3 ? stored - 1 - i : i % stored;
    for (std::size_t j = 0; j < angles; ++j) {
      const std::size_t line = first_value + plane * angles + j;
      const double candela = scale * text.number(line, "a luminous intensity");
      if (candela > 1e12) text.refuse(line, fmt::format("{} candela, expected 1e12 at most", candela));
      if (candela < 0 && negative_line == 0) negative_line = line;
      table.candela.push_back(float(std::max(candela, 0.0)));
    }
  }
  if (negative_line > 0)
    warnings.push_back({fmt::format("{}: line {}: negative candela, taken for 0", name, negative_line),
                        "negative candela", true});
  return table;
}

}  // namespace luciole
