#include "tools/view/watched_files.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "base/text_file.hpp"

namespace luciole {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostWatched = 1024;

fs::file_time_type timeOf(const std::string& path) {
  std::error_code none;
  const fs::file_time_type time = fs::last_write_time(path, none);
  return none ? fs::file_time_type::min() : time;
}

void watch(const std::string& path, WatchedFiles& watched) {
  if (watched.size() < kMostWatched && !watched.contains(path)) watched.emplace(path, timeOf(path));
}

/// Calls found(name) for each text in quotes that has an extension. A million lights have none.
template <class Found>
void eachQuotedName(std::string_view text, const Found& found) {
  for (std::size_t open = text.find('"'); open != text.npos; open = text.find('"', open)) {
    const std::size_t close = text.find('"', open + 1);
    if (close == text.npos) return;
    const std::string_view name = text.substr(open + 1, close - open - 1);
    const std::size_t dot = name.rfind('.');
    if (name.size() < 1024 && dot != name.npos && name.size() - dot <= 5 && name.find('\n') == name.npos)
      found(std::string(name));
    open = close + 1;
  }
}

/// Calls found(name) for each file of materials that an OBJ names.
template <class Found>
void eachMaterialFile(std::string_view text, const Found& found) {
  constexpr std::string_view kWord = "mtllib ";
  for (std::size_t at = text.find(kWord); at != text.npos; at = text.find(kWord, at + 1)) {
    std::string_view name = text.substr(at + kWord.size(), 1024);
    name = name.substr(0, name.find_first_of("\r\n"));
    found(std::string(name.substr(0, name.find_last_not_of(" \t") + 1)));
  }
}

void watchAll(const std::string& path, WatchedFiles& watched) {
  if (watched.contains(path)) return;
  watch(path, watched);
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  const bool is_json = extension == ".json" || extension == ".gltf";
  if (!is_json && extension != ".obj") return;
  const auto found = [&](const std::string& name) {
    watchAll((fs::path(path).parent_path() / name).string(), watched);
  };
  try {
    const std::string text = readFile(path);
    if (is_json)
      eachQuotedName(text, found);
    else
      eachMaterialFile(text, found);
  } catch (const std::runtime_error&) {  // who reads the scene says what is wrong with it
  }
}

}  // namespace

WatchedFiles filesOf(const std::string& path) {
  WatchedFiles watched;
  watchAll(path, watched);
  return watched;
}

void watchTextures(const Scene& scene, WatchedFiles& watched) {
  for (const Texture& texture : scene.textures) watch(texture.name, watched);
  for (const Shader& shader : scene.user_models) watch(shader.path, watched);
}

bool haveChanged(const WatchedFiles& watched) {
  return std::any_of(watched.begin(), watched.end(),
                     [](const auto& file) { return timeOf(file.first) != file.second; });
}

}  // namespace luciole
