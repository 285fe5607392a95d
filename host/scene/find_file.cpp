#include "scene/find_file.hpp"

#include <algorithm>
#include <filesystem>

#include "base/text_file.hpp"
#include "base/utf8.hpp"

namespace luciole {

namespace {

std::optional<std::string> findByBytes(const std::string& name, const SearchFolders& where) {
  std::string with_slashes = name;
  std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
  const std::filesystem::path whole(with_slashes), last = whole.filename(), folder(where.folder);
  std::vector<std::filesystem::path> places{folder / name, folder / whole, folder / last};
  for (const std::string& other : where.others) {
    if (whole.is_relative()) places.push_back(other / whole);
    places.push_back(other / last);
  }
  const auto found = std::find_if(places.begin(), places.end(), isFile);
  if (found == places.end()) return std::nullopt;
  return found->lexically_normal().string();
}

}  // namespace

std::optional<std::string> findFile(const std::string& name, const SearchFolders& where) {
  const std::optional<std::string> found = findByBytes(name, where);
  return found || isUtf8(name) ? found : findByBytes(utf8Of(name), where);
}

}  // namespace luciole
