#include "tools/view/view_page.hpp"

#include <string>

#include "base/embedded_files.hpp"
#include "base/page_text.hpp"

namespace luciole {

Answer viewPage() {
  const std::vector<EmbeddedFile>& files = viewPageFiles();
  const auto script = [&](const char* name) {
    return embeddableScript(std::string(embeddedText(files, name)));
  };
  const std::string nonce = randomToken();
  return {.type = "text/html; charset=utf-8",
          .body = fillIn(embeddedText(files, "view.html"),
                         {{"nonce", nonce},
                          {"view.css", std::string(embeddedText(files, "view.css"))},
                          {"parts.js", script("parts.js")},
                          {"view.js", script("view.js")},
                          {"files.js", script("files.js")}}),
          .nonce = nonce};
}

}  // namespace luciole
