// A libFuzzer program for the reader of one kind of file, by its extension LUCIOLE_FUZZED.
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

#include "fuzz/reader.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

/// Whether a scene of few bytes asks for much memory by right: a count or segments of more than two digits.
bool asksForMuch(std::string_view bytes) {
  for (const std::string_view key : {"\"count\"", "\"segments\""}) {
    for (std::size_t at = bytes.find(key); at != bytes.npos; at = bytes.find(key, at + 1)) {
      const std::size_t number = bytes.find_first_of("0123456789", at);
      if (number != bytes.npos && bytes.find_first_of(" \t\r\n,}", number) - number > 2) return true;
    }
  }
  return false;
}

}  // namespace
}  // namespace luciole::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace luciole::test;
  // Files that the one fuzzed may name: its own ("file" and the extension) as an OBJ's materials, and these.
  static const TemporaryFolder folder;
  static const std::string path = [] {
    std::ofstream(folder / "mesh.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::ofstream(folder / "picture.ppm") << "P3 1 1 255 10 20 30\n";
    return folder / ("file." LUCIOLE_FUZZED);
  }();
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (std::string_view(LUCIOLE_FUZZED) == "json" && asksForMuch(bytes)) return 0;
  std::ofstream(path, std::ios::binary) << bytes;
  readStrangersFile(path);
  return 0;
}
