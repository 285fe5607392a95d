#include "base/page_text.hpp"

namespace luciole {
namespace {

void replaceAll(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
}

}  // namespace

std::string embeddableJson(std::string json) {
  replaceAll(json, "<", "\\u003c");
  return json;
}

std::string embeddableScript(std::string script) {
  replaceAll(script, "</script", "<\\/script");
  replaceAll(script, "<!--", "<\\!--");
  return script;
}

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

}  // namespace luciole
