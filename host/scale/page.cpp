#include "scale/page.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "base/embedded_files.hpp"
#include "base/error.hpp"

namespace luciole {
namespace {

void replaceAll(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
}

/// JSON in which an HTML parser sees no tag. In JSON a '<' stands only in strings, where it can be escaped.
std::string embeddableJson(std::string json) {
  replaceAll(json, "<", "\\u003c");
  return json;
}

/// A script without the texts that would end it early, or hide its end, in an HTML file. In a script they
/// stand in strings, regular expressions and comments, where the backslash changes nothing.
std::string embeddableScript(std::string script) {
  replaceAll(script, "</script", "<\\/script");
  replaceAll(script, "<!--", "<\\!--");
  return script;
}

std::string readChartLibrary(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (text.empty())
    throw MachineError(fmt::format(
        "{}: Chart.js is needed for the page of an experiment; apt-get install libjs-chart.js", path));
  return text;
}

/// `text` with each {{name}} replaced by what the list has for it, once: what is put in is not looked at
/// again.
std::string fillIn(std::string_view text,
                   const std::vector<std::pair<std::string_view, std::string>>& contents) {
  std::string filled;
  while (!text.empty()) {
    const std::size_t open = text.find("{{");
    filled += text.substr(0, open);
    if (open == std::string_view::npos) break;
    const std::size_t close = text.find("}}", open);
    const std::string_view name = text.substr(open + 2, close - open - 2);
    for (const auto& [key, content] : contents)
      if (key == name) filled += content;
    text.remove_prefix(close + 2);
  }
  return filled;
}

}  // namespace

void requireChartLibrary(const std::string& path) { readChartLibrary(path); }

std::string experimentPage(const std::string& data) {
  const std::vector<EmbeddedFile>& files = pageFiles();
  return fillIn(embeddedText(files, "page.html"),
                {{"page.css", std::string(embeddedText(files, "page.css"))},
                 {"data", embeddableJson(data)},
                 {"chart.js", embeddableScript(readChartLibrary(kChartLibrary))},
                 {"page.js", embeddableScript(std::string(embeddedText(files, "page.js")))}});
}

}  // namespace luciole
