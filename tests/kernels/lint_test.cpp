#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdio.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "kernels/probe.hpp"
#include "render/features.hpp"
#include "shared_files.hpp"

// The kernels through a compiler that, unlike an OpenCL runtime's, warns.
namespace luciole::test {
namespace {

std::string findClang() {
  std::vector<std::string> names{"clang"};
  for (int version = 25; version >= 13; --version) names.push_back("clang-" + std::to_string(version));
  for (const std::string& name : names)
    if (programIsThere(name)) return name;
  return "clang";
}

std::string quoted(const std::filesystem::path& path) { return fmt::format("'{}'", path.string()); }

std::string filesIn(const char* folder, const std::vector<std::string>& extensions) {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(LUCIOLE_SOURCE_DIR) / folder))
    if (std::count(extensions.begin(), extensions.end(), entry.path().extension()) != 0)
      files.push_back(quoted(entry.path()));
  std::sort(files.begin(), files.end());
  std::string joined;
  for (const std::string& file : files) joined += " " + file;
  return joined;
}

/// Compiles each file alone, without writing anything. A header's functions are unused there.
void expectClean(const std::string& clang, const std::string& options) {
  const std::string command = clang +
                              " -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -Xclang "
                              "-fdeclare-opencl-builtins -fsyntax-only" +
                              " -Wall -Wextra -Werror -Wno-unused-parameter -Wno-unused-function -I " +
                              quoted(std::filesystem::path(LUCIOLE_SOURCE_DIR) / "kernels") + " " + options +
                              " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string output;
  char buffer[4096];
  for (std::size_t got; (got = fread(buffer, 1, sizeof buffer, pipe)) > 0;) output.append(buffer, got);
  const int status = pclose(pipe);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << options << "\n" << output;
}

TEST(KernelLint, EachFileAloneWithoutWarningsAtEveryWidth) {
  const std::string clang = findClang();
  if (clang == "clang") LUCIOLE_NEEDS_PROGRAM("clang", "clang");
  const std::string files = filesIn("kernels", {".cl", ".clh", ".h"}) + filesIn("tests/kernels", {".cl"}) +
                            filesIn("tests/cl", {".cl"});
  for (const int lanes : kAllLanes) expectClean(clang, "-DLANES=" + std::to_string(lanes) + files);
}

TEST(KernelLint, EachFeatureAloneAndNoneWithoutWarnings) {
  const std::string clang = findClang();
  if (clang == "clang") LUCIOLE_NEEDS_PROGRAM("clang", "clang");
  const std::string files = filesIn("kernels", {".cl"});
  expectClean(clang, featureDefines(FeatureSet{}) + files);
  for (std::size_t i = 0; i < kFeatureCount; ++i) {
    FeatureSet features;
    features.set(static_cast<Feature>(i));
    expectClean(clang, "-DLANES=8 " + featureDefines(features) + files);
  }
}

}  // namespace
}  // namespace luciole::test
