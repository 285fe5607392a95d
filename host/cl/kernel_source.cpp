#include "cl/kernel_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/embedded_files.hpp"

namespace luciole {
namespace {

void appendText(std::string_view name, std::string_view text, std::vector<std::string_view>& seen,
                std::string& source) {
  source += fmt::format("#line 1 \"kernels/{}\"\n", name);
  constexpr std::string_view kInclude = "#include \"";
  for (int line_number = 1; !text.empty(); ++line_number) {
    const std::size_t length = std::min(text.find('\n'), text.size() - 1) + 1;
    const std::string_view line = text.substr(0, length);
    text.remove_prefix(length);
    if (!line.starts_with(kInclude)) {
      source += line;
      continue;
    }
    const std::string_view included =
        line.substr(kInclude.size(), line.find('"', kInclude.size()) - kInclude.size());
    if (std::find(seen.begin(), seen.end(), included) == seen.end()) {
      seen.push_back(included);
      appendText(included, embeddedText(embeddedKernels(), included), seen, source);
      source += fmt::format("#line {} \"kernels/{}\"\n", line_number + 1, name);
    } else {
      source += "\n";
    }
  }
}

}  // namespace

std::string kernelSource(std::string_view name) {
  return expandKernelSource(name, embeddedText(embeddedKernels(), name));
}

std::string expandKernelSource(std::string_view name, std::string_view text) {
  std::vector<std::string_view> seen;
  std::string source;
  appendText(name, text, seen, source);
  return source;
}

}  // namespace luciole
