#include "image/write_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "error.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

TEST(WriteFile, ReplacesAFileByExactlyTheText) {
  const test::TemporaryFolder folder;
  for (const std::string& text : {std::string("{ \"longer\": 1 }\n"), std::string("{}"), std::string()}) {
    writeTextFile(folder / "a.json", text);
    std::ifstream file(folder / "a.json");
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), text);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteFile, UnwritableFoldersAreInputErrors) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(writeTextFile(folder / "no/a.json", "{}"), InputError);
  // Linux lets nobody, root included, create files in /proc.
  EXPECT_THROW(writeTextFile("/proc/a.json", "{}"), InputError);
}

}  // namespace
}  // namespace luciole
