#include "image/write_file.hpp"

#include <span>

#include "image/oiio.hpp"

namespace luciole {

void writeTextFile(const std::string& path, std::string_view text) {
  deliver(MemoryFile(std::as_bytes(std::span(text))), path);
}

}  // namespace luciole
