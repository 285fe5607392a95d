#include "tools/cli/sweep.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/text_file.hpp"
#include "luciole/error.hpp"
#include "scene/json/scene_changes.hpp"

namespace luciole {
namespace {

constexpr std::size_t kMostPictures = 400;

/// The texts between commas that are in no brackets or quotes.
std::vector<std::string> splitValues(const std::string& text) {
  std::vector<std::string> values(1);
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\' && i + 1 < text.size()) values.back() += text[i++];
    if (c == '"') quoted = !quoted;
    if (!quoted) depth += (c == '[' || c == '{') - (c == ']' || c == '}');
    if (c == ',' && depth == 0 && !quoted)
      values.emplace_back();
    else
      values.back() += text[i];
  }
  return values;
}

}  // namespace

std::vector<Sweep> readSweeps(const std::vector<std::string>& texts) {
  if (texts.size() > 2) throw InputError("--sweep: expected one, or two for rows and columns");
  std::vector<Sweep> sweeps;
  std::size_t count = 1;
  for (const std::string& text : texts) {
    const std::size_t length = placeLength(text, "--sweep");
    Sweep sweep{text.substr(0, length), splitValues(text.substr(length + 1))};
    for (const std::string& value : sweep.values)
      if (value.empty())
        throw InputError(
            fmt::format("--sweep {}: a value is empty, expected PATH=VALUE,VALUE,...", forMessage(text)));
    count *= sweep.values.size();
    sweeps.push_back(std::move(sweep));
  }
  if (count > kMostPictures)
    throw InputError(fmt::format("--sweep: {} pictures, expected {} at most", count, kMostPictures));
  return sweeps;
}

std::vector<SweepPicture> sweepPictures(const std::vector<Sweep>& sweeps) {
  std::vector<SweepPicture> pictures;
  const auto set = [](const Sweep& sweep, std::size_t i) { return sweep.place + "=" + sweep.values[i]; };
  for (std::size_t row = 0; row < (sweeps.size() > 1 ? sweeps[1].values.size() : 1); ++row)
    for (std::size_t column = 0; column < sweeps[0].values.size(); ++column) {
      pictures.push_back({set(sweeps[0], column)});
      if (sweeps.size() > 1) pictures.back().push_back(set(sweeps[1], row));
    }
  return pictures;
}

std::string briefLabel(const SweepPicture& picture) {
  std::string label;
  for (const std::string& change : picture) {
    const std::size_t dot = change.rfind('.', placeLength(change, "--sweep"));
    label += (label.empty() ? "" : ", ") + (dot == std::string::npos ? change : change.substr(dot + 1));
  }
  return label;
}

int sweepColumns(const std::vector<Sweep>& sweeps) {
  const std::size_t count = sweeps[0].values.size();
  return int(sweeps.size() > 1 || count <= 4 ? double(count) : std::ceil(std::sqrt(double(count))));
}

}  // namespace luciole
