#include "tools/cli/cameras.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <string_view>

#include "base/text_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// Where `{camera}` stands in the file's name, from `start` on; npos if it doesn't.
std::size_t cameraPlace(const std::string& pattern, std::size_t start = 0) {
  const std::size_t slash = pattern.find_last_of('/');
  return pattern.find(kCameraPlace, std::max(start, slash == std::string::npos ? 0 : slash + 1));
}

std::string fitForFile(std::string name) {
  constexpr std::string_view kSafe = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.";
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 0x80 && kSafe.find(c) == std::string_view::npos) c = '_';
  if (name.front() == '.') name.front() = '_';
  return name;
}

}  // namespace

std::size_t findCamera(const Scene& scene, const std::string& wanted) {
  if (wanted.empty()) return 0;
  const auto& cameras = scene.cameras;
  const auto named = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const Camera& camera) { return camera.name == wanted; });
  if (named != cameras.end()) return std::size_t(named - cameras.begin());
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
  if (error == std::errc() && end == wanted.data() + wanted.size() && index < cameras.size()) return index;
  std::string names;
  for (const Camera& camera : cameras) names += (names.empty() ? "" : ", ") + camera.name;
  throw InputError(fmt::format("--camera {}: {} has {} ({}), by name or counted from 0", wanted, scene.name,
                               cameras.size() == 1 ? "one camera" : fmt::format("{} cameras", cameras.size()),
                               names.empty() ? "unnamed" : forMessage(names)));
}

std::vector<std::size_t> chosenCameras(const Scene& scene, const std::string& option) {
  if (option != "all") return {findCamera(scene, option)};
  std::vector<std::size_t> all(scene.cameras.size());
  std::iota(all.begin(), all.end(), std::size_t(0));
  return all;
}

std::string cameraFile(const std::string& pattern, const Scene& scene, std::size_t camera) {
  const std::string& own = scene.cameras[camera].name;
  const std::string name = own.empty() ? std::to_string(camera) : fitForFile(own);
  std::string file = pattern;
  const std::size_t length = std::string_view(kCameraPlace).size();
  for (std::size_t at = cameraPlace(file); at != std::string::npos; at = cameraPlace(file, at + name.size()))
    file.replace(at, length, name);
  return file;
}

std::vector<std::string> cameraFiles(const std::string& pattern, const Scene& scene,
                                     const std::vector<std::size_t>& cameras, const std::string& option) {
  if (cameras.size() > 1 && cameraPlace(pattern) == std::string::npos)
    throw InputError(
        fmt::format("{} {}: expected a name with {} in the place of the camera's, such as view_{}.png, for "
                    "the {} cameras of {}",
                    option, pattern, kCameraPlace, kCameraPlace, cameras.size(), scene.name));
  std::vector<std::string> files;
  for (const std::size_t camera : cameras) {
    files.push_back(cameraFile(pattern, scene, camera));
    const auto same = std::find(files.begin(), files.end(), files.back());
    if (same + 1 != files.end())
      throw InputError(fmt::format("{} {}: cameras {} and {} of {} would both be written to {}", option,
                                   pattern, cameras[std::size_t(same - files.begin())], camera, scene.name,
                                   files.back()));
  }
  return files;
}

}  // namespace luciole
