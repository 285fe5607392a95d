#include "base/write_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "luciole/error.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

TEST(WriteFile, ReplacesAFileByExactlyTheText) {
  const test::TemporaryFolder folder;
  for (const std::string& text : {std::string("{ \"longer\": 1 }\n"), std::string("{}"), std::string()}) {
    writeTextFile(folder / "a.json", text);
    EXPECT_EQ(test::readText(folder / "a.json"), text);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteFile, UnwritableFoldersAreInputErrors) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(writeTextFile(folder / "no/a.json", "{}"), InputError);
  // Linux lets nobody, root included, create files in /proc.
  EXPECT_THROW(writeTextFile("/proc/a.json", "{}"), InputError);
}

TEST(WriteFile, PlacesAreCheckedWhereTheirLinksLead) {
  const test::TemporaryFolder folder;
  // Linux lets nobody, root included, create files in /proc.
  std::filesystem::create_symlink("/proc/a.json", folder / "unwritable");
  EXPECT_THROW(writeTextFile(folder / "unwritable", "{}"), InputError);
  std::filesystem::create_symlink("no/a.json", folder / "nowhere");
  EXPECT_THROW(checkPlace(folder / "nowhere"), InputError);
  std::filesystem::create_symlink("a.json", folder / "new");
  EXPECT_NO_THROW(checkPlace(folder / "new"));
  EXPECT_NO_THROW(checkPlace("/dev/null"));
}

}  // namespace
}  // namespace luciole
