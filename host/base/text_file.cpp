#include "base/text_file.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <fstream>
#include <iterator>

#include "base/large_pages.hpp"
#include "base/machine_memory.hpp"
#include "base/utf8.hpp"
#include "luciole/error.hpp"

namespace luciole {

bool isFile(const std::filesystem::path& path) {
  std::error_code refused;
  return std::filesystem::is_regular_file(path, refused);
}

std::string readFile(const std::string& path) {
  std::error_code refused;
  if (std::filesystem::is_directory(path, refused)) throw InputError(path + ": is a folder, expected a file");
  std::ifstream file;
  do {
    errno = 0;
    file.clear();
    file.open(path, std::ios::binary);
  } while (!file && errno == EINTR);
  if (!file) throw InputError(path + ": can't be opened, expected a readable file");
  std::string bytes;
  std::error_code no_size;
  const std::uintmax_t size = std::filesystem::file_size(path, no_size);  // pipes have none
  if (!no_size) {
    requireMemory(double(size), path);
    reserveLarge(bytes, size);
  }
  char block[1 << 16];
  while (file.read(block, sizeof block) || file.gcount() > 0) bytes.append(block, file.gcount());
  if (file.bad()) throw InputError(path + ": can't be read to its end");
  return bytes;
}

std::string forMessage(std::string_view words) {
  constexpr std::size_t kLongest = 200;
  std::string line;
  while (!words.empty()) {
    const std::string character = utf8Of(words.substr(0, std::max<std::size_t>(utf8Length(words), 1)));
    if (line.size() + character.size() > kLongest) break;
    // U+0080 to U+009F are control characters, too.
    line += character.size() == 2 && character < "\xc2\xa0" ? " " : character;
    words.remove_prefix(std::max<std::size_t>(utf8Length(words), 1));
  }
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = ' ';
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

bool equalIgnoringCase(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

}  // namespace luciole
