#include "tools/cli/mix_page.hpp"

#include <nlohmann/json.hpp>
#include <string_view>

#include "base/base64.hpp"
#include "base/dump_utf8.hpp"
#include "base/embedded_files.hpp"
#include "base/page_text.hpp"

namespace luciole {

std::string mixPage(const std::string& path, const std::vector<MixerTerm>& terms, double exposure) {
  std::vector<GroupFactor> groups;
  nlohmann::json shown = nlohmann::json::array();
  for (const MixerTerm& term : terms) {
    groups.push_back({term.group});
    shown.push_back({{"name", term.group}, {"factor", term.factor}, {"color", term.color}});
  }
  const SmallGroups small = smallGroups(path, groups, kPageBytes);
  const std::string_view bytes(reinterpret_cast<const char*>(small.halves.data()),
                               small.halves.size() * sizeof small.halves[0]);
  const nlohmann::json data{{"file", path},         {"width", small.width}, {"height", small.height},
                            {"exposure", exposure}, {"groups", shown},      {"halves", base64(bytes)}};
  const std::vector<EmbeddedFile>& files = mixPageFiles();
  const std::string_view parts = embeddedText(viewPageFiles(), "parts.js");
  return fillIn(embeddedText(files, "mix.html"),
                {{"mix.css", std::string(embeddedText(files, "mix.css"))},
                 {"data", embeddableJson(dumpUtf8(data))},
                 {"parts.js", embeddableScript(std::string(parts))},
                 {"mix.js", embeddableScript(std::string(embeddedText(files, "mix.js")))}});
}

}  // namespace luciole
