#include "base/embedded_files.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace luciole {

std::string_view embeddedText(const std::vector<EmbeddedFile>& files, std::string_view name) {
  for (const EmbeddedFile& file : files)
    if (file.name == name) return file.text;
  throw std::logic_error(fmt::format("no embedded file '{}'", name));
}

}  // namespace luciole
