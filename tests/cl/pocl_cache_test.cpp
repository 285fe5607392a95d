#include "cl/pocl_cache.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "setting.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

TEST(PoclCache, IsWhereTheEnvironmentSays) {
  const Setting home("HOME", "/home/someone"), none("XDG_CACHE_HOME", std::nullopt);
  {
    const Setting own("POCL_CACHE_DIR", std::nullopt);
    EXPECT_EQ(poclCache(), "/home/someone/.cache/pocl/kcache");
    const Setting user("XDG_CACHE_HOME", "/caches");
    EXPECT_EQ(poclCache(), "/caches/pocl/kcache");
    const Setting homeless("HOME", std::nullopt), nowhere("XDG_CACHE_HOME", "");
    EXPECT_EQ(poclCache(), "");
  }
  const Setting own("POCL_CACHE_DIR", "/own");
  EXPECT_EQ(poclCache(), "/own");
  const Setting off("POCL_KERNEL_CACHE", "0");
  EXPECT_EQ(poclCache(), "");
}

TEST(PoclCache, ListsWhatWasAddedToItAndNothingElse) {
  const TemporaryFolder folder;
  const std::string place = folder / "";
  EXPECT_FALSE(isListed(place, "one"));
  addToList(place, {"one", "two"});
  addToList(place, {"three"});
  for (const char* description : {"one", "two", "three"}) EXPECT_TRUE(isListed(place, description));
  for (const char* description : {"on", "four", ""}) EXPECT_FALSE(isListed(place, description));
}

TEST(PoclCache, IsEmptyWhereItsListIsNoneOfOurs) {
  const TemporaryFolder folder;
  const std::string place = folder / "", list = folder / "luciole-programs";
  addToList(place, {"one"});
  writeText(list, readText(list).substr(0, 8));  // cut off, as on a full disk
  EXPECT_FALSE(isListed(place, "one"));
  std::filesystem::resize_file(list, std::uintmax_t(1) << 31);
  EXPECT_FALSE(isListed(place, "one"));
  addToList(place, {"one"});
  EXPECT_TRUE(isListed(place, "one"));
  EXPECT_LT(std::filesystem::file_size(list), 100u);
  std::filesystem::remove(list);
  std::filesystem::create_directory(list);
  EXPECT_FALSE(isListed(place, "one"));
  addToList(place, {"one"});
  addToList(folder / "missing", {"one"});
  EXPECT_FALSE(isListed(folder / "missing", "one"));
}

}  // namespace
}  // namespace luciole::test
