#include "image/label_font.hpp"

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

namespace luciole {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name, const std::string& otherwise) {
  const char* value = std::getenv(name);
  return value && *value ? value : otherwise;
}

std::vector<fs::path> fontFolders() {
  std::vector<fs::path> folders{fs::path(variable("XDG_DATA_HOME", variable("HOME", "/") + "/.local/share")) /
                                "fonts"};
  std::istringstream others(variable("XDG_DATA_DIRS", "/usr/local/share:/usr/share"));
  for (std::string folder; std::getline(others, folder, ':');) folders.push_back(fs::path(folder) / "fonts");
  return folders;
}

}  // namespace

std::string findLabelFont() {
  for (const fs::path& folder : fontFolders()) {
    std::error_code error;
    fs::recursive_directory_iterator file(folder, fs::directory_options::skip_permission_denied, error), end;
    for (; !error && file != end; file.increment(error))
      if (file->path().filename() == "DejaVuSans.ttf") return file->path().string();
  }
  return "";
}

}  // namespace luciole
