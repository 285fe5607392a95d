#include "tools/scale/page.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <vector>

#include "base/embedded_files.hpp"
#include "base/page_text.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

std::string readChartLibrary(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (text.empty())
    throw MachineError(fmt::format(
        "{}: Chart.js is needed for the page of an experiment; apt-get install libjs-chart.js", path));
  return text;
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
