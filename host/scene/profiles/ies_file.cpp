// IES LM-63: "Standard File Format for the Electronic Transfer of Photometric Data", 1986, 1991, 1995, 2002
// and 2019.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/profiles/profile_table.hpp"

namespace luciole {
namespace {

/// A file's text, read from its beginning to its end.
struct IesText {
  std::string_view rest;
  const std::string& name;
  std::size_t line = 0;  ///< of what was read last, from 1 on
  bool at_line_end = true;

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", name, line, what));
  }

  /// Without blanks around it.
  std::string_view nextLine() {
    ++line;
    const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
    std::string_view words = rest.substr(0, end);
    rest.remove_prefix(end);
    if (rest.starts_with("\r\n")) rest.remove_prefix(1);
    if (!rest.empty()) rest.remove_prefix(1);
    const std::size_t first = words.find_first_not_of(" \t");
    return first == words.npos ? "" : words.substr(first, words.find_last_not_of(" \t") + 1 - first);
  }

  /// The next word of the lines that follow; "" at the end.
  std::string_view nextWord() {
    if (at_line_end) ++line;
    at_line_end = false;
    for (; !rest.empty() && std::string_view(" \t\r\n,\x1a").find(rest.front()) != rest.npos;
         rest.remove_prefix(1))
      line += rest.front() == '\n' || (rest.front() == '\r' && !rest.substr(1).starts_with('\n')) ? 1 : 0;
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n,\x1a"));
    rest.remove_prefix(word.size());
    return word;
  }

  double nextNumber(const std::string& what, double low = -1e12, double high = 1e12) {
    const std::string_view word = nextWord();
    double number = 0;
    const std::string_view digits = word.substr(word.starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (word.empty() || error != std::errc() || end != digits.data() + digits.size() ||
        !(number >= low && number <= high))
      refuse(fmt::format("{} is {}, expected a number from {} to {}", what,
                         word.empty() ? "missing" : fmt::format("'{}'", forMessage(word)), low, high));
    return number;
  }

  std::size_t nextCount(const std::string& what) {
    const double number = nextNumber(what, 1, double(kMostEntries));
    if (number != std::floor(number)) refuse(fmt::format("{} is {}, expected a whole number", what, number));
    return std::size_t(number);
  }

  std::vector<double> nextAngles(const std::string& what, std::size_t count) {
    std::vector<double> angles;
    for (std::size_t i = 0; i < count; ++i) {
      const double angle = nextNumber(fmt::format("{} angle {}", what, i + 1), -360, 360);
      if (i > 0 && angle <= angles.back())
        refuse(fmt::format("{} angle {} is {}, expected more than {}", what, i + 1, angle, angles.back()));
      angles.push_back(angle);
    }
    return angles;
  }
};

/// Reads up to the line of TILT. Returns whether the lamp's photometric factor counts: in 1995 the number in
/// its place lost its meaning, and in 2019 it got another.
bool readHead(IesText& text, std::vector<Warning>& warnings) {
  bool has_factor = true;
  for (bool is_first = true; !text.rest.empty(); is_first = false) {
    const std::string_view words = text.nextLine();
    if (is_first) has_factor = !words.starts_with("IESNA:LM-63-") && !words.starts_with("IES:LM-63-");
    if (!equalIgnoringCase(words.substr(0, 5), "TILT=")) continue;
    const std::string_view tilt = words.substr(5);
    if (equalIgnoringCase(tilt, "NONE")) return has_factor;
    warnings.push_back({fmt::format("{}: line {}: TILT={}, left out: light doesn't depend on the lamp's tilt",
                                    text.name, text.line, forMessage(tilt)),
                        "tilt"});
    if (!equalIgnoringCase(tilt, "INCLUDE")) return has_factor;
    text.nextNumber("the lamp's geometry");
    const std::size_t pairs = text.nextCount("the number of tilts");
    for (std::size_t i = 0; i < 2 * pairs; ++i) text.nextNumber("an angle or factor of the tilt");
    return has_factor;
  }
  text.refuse("no line TILT= up to the end, expected a file of IES LM-63, or EULUMDAT named .ldt");
}

}  // namespace

ProfileTable parseIes(std::string_view bytes, const std::string& name, std::vector<Warning>& warnings) {
  IesText text{bytes, name};
  const bool has_factor = readHead(text, warnings);
  ProfileTable table;
  const double lamps = text.nextNumber("the number of lamps"), lumens = text.nextNumber("lumens per lamp");
  double scale = text.nextNumber("the candela multiplier", 0);
  const std::size_t vertical = text.nextCount("the number of vertical angles"),
                    horizontal = text.nextCount("the number of horizontal angles");
  const double type = text.nextNumber("the photometric type", 1, 3);
  if (type != std::floor(type)) text.refuse(fmt::format("the photometric type is {}, expected 1 to 3", type));
  table.type = PhotometricType(int(type) - 1);
  for (const char* what : {"the units type", "the width", "the length", "the height"}) text.nextNumber(what);
  scale *= text.nextNumber("the ballast factor", 0);
  const double factor = text.nextNumber("the ballast-lamp photometric factor");
  if (has_factor && factor < 0)
    text.refuse(fmt::format("the ballast-lamp photometric factor is {}, expected 0 or more", factor));
  if (has_factor) scale *= factor;
  text.nextNumber("the input watts");
  // A number and a blank take two bytes.
  if (vertical * horizontal + vertical + horizontal > text.rest.size() / 2 + 2)
    text.refuse(fmt::format("{} vertical and {} horizontal angles, more than the file has numbers for",
                            vertical, horizontal));
  table.lamp_lumens = std::max(lamps * lumens, 0.0);  // a negative number: none are known
  table.vertical = text.nextAngles("vertical", vertical);
  table.horizontal = text.nextAngles("horizontal", horizontal);
  table.candela.reserve(vertical * horizontal);
  std::size_t negative_line = 0;
  for (std::size_t i = 0; i < vertical * horizontal; ++i) {
    const double candela = scale * text.nextNumber(fmt::format("candela value {}", i + 1));
    if (candela > 1e12) text.refuse(fmt::format("{} candela, expected 1e12 at most", candela));
    if (candela < 0 && negative_line == 0) negative_line = text.line;
    table.candela.push_back(float(std::max(candela, 0.0)));
  }
  if (negative_line > 0)
    warnings.push_back({fmt::format("{}: line {}: negative candela, taken for 0", name, negative_line),
                        "negative candela", true});
  if (!text.nextWord().empty())
    warnings.push_back({fmt::format("{}: line {}: more than its {} times {} candela values; left out", name,
                                    text.line, horizontal, vertical),
                        "candela values", true});
  return table;
}

}  // namespace luciole
