#include "cl/pocl_cache.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string_view>

#include "base/text_file.hpp"
#include "cl/program_cache.hpp"

namespace luciole {
namespace {

namespace files = std::filesystem;

/// A list that is larger is none of ours: a line of it takes 17 bytes.
constexpr std::uintmax_t kLargestList = 1 << 20;

files::path listIn(const std::string& folder) { return files::path(folder) / "luciole-programs"; }

std::string lineOf(const std::string& description) { return hashOf(description) + "\n"; }

}  // namespace

std::string poclCache() {
  const auto setting = [](const char* name) -> std::string_view {
    const char* const value = std::getenv(name);
    return value ? value : "";
  };
  if (setting("POCL_KERNEL_CACHE") == "0") return "";
  // As pocl_cache_init_topdir() of PoCL 3.1 and 6.0 does.
  if (!setting("POCL_CACHE_DIR").empty()) return std::string(setting("POCL_CACHE_DIR"));
  if (!setting("XDG_CACHE_HOME").empty()) return files::path(setting("XDG_CACHE_HOME")) / "pocl" / "kcache";
  if (!setting("HOME").empty()) return files::path(setting("HOME")) / ".cache" / "pocl" / "kcache";
  return "";
}

bool isListed(const std::string& folder, const std::string& description) {
  const files::path list = listIn(folder);
  try {
    if (!isFile(list) || files::file_size(list) > kLargestList) return false;
    return readFile(list).find(lineOf(description)) != std::string::npos;
  } catch (const std::exception&) {
    return false;
  }
}

void addToList(const std::string& folder, const std::vector<std::string>& descriptions) {
  std::string lines;
  for (const std::string& description : descriptions) lines += lineOf(description);
  const std::string list = listIn(folder);
  std::error_code none;
  if (files::file_size(list, none) > kLargestList && !none) files::remove(list, none);
  const int file = open(list.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) return;
  // In one piece, so that lines of several processes don't mix. One that is cut off matches no program.
  [[maybe_unused]] const ssize_t written = write(file, lines.data(), lines.size());
  close(file);
}

}  // namespace luciole
