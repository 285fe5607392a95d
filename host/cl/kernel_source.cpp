#include "cl/kernel_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/embedded_files.hpp"

namespace luciole {
namespace {

/// The header that a user's text takes the place of.
constexpr std::string_view kUserText = "user_text.clh";

void appendText(std::string_view name, std::string_view text, std::string_view user_text,
                std::vector<std::string_view>& seen, std::string& source) {
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
      if (included == kUserText && !user_text.empty())
        source += user_text;
      else
        appendText(included, embeddedText(embeddedKernels(), included), user_text, seen, source);
      source += fmt::format("#line {} \"kernels/{}\"\n", line_number + 1, name);
    } else {
      source += "\n";
    }
  }
}

}  // namespace

std::string kernelSource(std::string_view name, std::string_view user_text) {
  return expandKernelSource(name, embeddedText(embeddedKernels(), name), user_text);
}

std::string expandKernelSource(std::string_view name, std::string_view text, std::string_view user_text) {
  std::vector<std::string_view> seen;
  std::string source;
  appendText(name, text, user_text, seen, source);
  return source;
}

}  // namespace luciole
