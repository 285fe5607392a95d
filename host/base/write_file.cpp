#include "base/write_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <span>
#include <system_error>

#include "base/output_file.hpp"
#include "luciole/error.hpp"

namespace luciole {

void writeTextFile(const std::string& path, std::string_view text) {
  OutputFile file(path);
  file.writeAt(0, std::as_bytes(std::span(text)));
  file.putInPlace();
}

void checkPlace(const std::string& path) {
  if (path == "-") return;
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw InputError(path + ": is a folder, expected a file");
  if (leadsToStream(path)) {
    if (access(path.c_str(), W_OK) != 0)
      throw InputError(fmt::format("{}: can't write to it: {}", path, systemReason()));
    return;
  }
  const std::string folder = folderOf(followLinks(path));
  if (!std::filesystem::is_directory(folder, error)) throw InputError(path + ": no such folder");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(fmt::format("{}: can't write to its folder: {}", path, systemReason()));
}

}  // namespace luciole
