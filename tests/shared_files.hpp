#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace luciole::test {

/// The folder of real scenes that are not part of this project: $LUCIOLE_SHARED, or ../shared beside the
/// checkout.
inline std::filesystem::path sharedFolder() {
  if (const char* place = std::getenv("LUCIOLE_SHARED")) return place;
  return std::filesystem::path(LUCIOLE_SOURCE_DIR) / ".." / "shared";
}
inline std::filesystem::path sharedScenes() { return sharedFolder() / "scenes"; }

/// A folder of this test's own, empty, removed with everything in it at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "luciole-test-XXXXXX").string();
    if (!mkdtemp(pattern.data())) std::abort();
    path_ = pattern;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The file's bytes; none where there is no such file.
inline std::string readText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void writeText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// Names of the folder's files, in alphabetical order.
inline std::vector<std::string> filesIn(const TemporaryFolder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

inline bool programIsThere(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null 2>&1").c_str()) == 0;
}

/// Whether the system's archive lacks the package, as the launcher found ($LUCIOLE_UNAVAILABLE: names apart
/// by spaces).
inline bool packageIsUnavailable(const std::string& package) {
  const char* names = std::getenv("LUCIOLE_UNAVAILABLE");
  return names && (" " + std::string(names) + " ").find(" " + package + " ") != std::string::npos;
}

}  // namespace luciole::test

/// For tests that run another program. The launcher installs what the system's archive has; where everything
/// is demanded
/// ($LUCIOLE_SHARED is set, as CI does), only what the archive lacks may be missing.
#define LUCIOLE_NEEDS_PROGRAM(name, package)                                                \
  do {                                                                                      \
    if (!luciole::test::programIsThere(name)) {                                             \
      if (luciole::test::packageIsUnavailable(package))                                     \
        GTEST_SKIP() << "needs " name ", which this system's archive lacks";                \
      if (std::getenv("LUCIOLE_SHARED")) FAIL() << "no " name " (apt install " package ")"; \
      GTEST_SKIP() << "needs " name " (apt install " package ")";                           \
    }                                                                                       \
  } while (false)

/// For tests that need the shared scenes. Where $LUCIOLE_SHARED says where they are, missing files are a
/// failure; without them anywhere, the test says that it was skipped.
#define LUCIOLE_NEEDS_SHARED()                                                                         \
  do {                                                                                                 \
    if (!std::filesystem::is_directory(luciole::test::sharedScenes())) {                               \
      if (std::getenv("LUCIOLE_SHARED")) FAIL() << "no scenes in " << luciole::test::sharedScenes();   \
      GTEST_SKIP() << "needs the shared scenes (set LUCIOLE_SHARED to the folder that holds scenes/)"; \
    }                                                                                                  \
  } while (false)
