#include "tools/view/watched_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <string>

#include "shared_files.hpp"

namespace luciole::test {
namespace {

using testing::Contains;
using testing::Key;
using testing::Not;

TEST(WatchedFiles, AreThoseThatASceneNamesAndTheseName) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.json") << R"({"objects": [{"mesh": "b.obj"}, {"primitive": "box"}],
    "lights": [{"type": "spot"}], "materials": {"m": {"diffuse_map": "c.png", "alpha": "0.5"}}})";
  std::ofstream(folder / "b.obj") << "# mesh\nmtllib d.mtl\r\nv 0 0 0\n";
  const WatchedFiles watched = filesOf(folder / "a.json");
  for (const char* name : {"a.json", "b.obj", "c.png", "d.mtl"})
    EXPECT_THAT(watched, Contains(Key(folder / name))) << name;
  EXPECT_THAT(watched, Not(Contains(Key(folder / "box"))));
}

TEST(WatchedFiles, ChangeWhereOneIsWrittenComesOrGoes) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.json") << R"({"objects": [{"mesh": "b.obj"}]})";
  const WatchedFiles without = filesOf(folder / "a.json");
  EXPECT_FALSE(haveChanged(without));
  std::ofstream(folder / "b.obj") << "v 0 0 0\n";
  EXPECT_TRUE(haveChanged(without)) << "it came";
  const WatchedFiles with = filesOf(folder / "a.json");
  EXPECT_FALSE(haveChanged(with));
  std::filesystem::last_write_time(
      folder / "b.obj", std::filesystem::last_write_time(folder / "b.obj") + std::chrono::seconds(1));
  EXPECT_TRUE(haveChanged(with)) << "it was written";
  const WatchedFiles again = filesOf(folder / "a.json");
  std::filesystem::remove(folder / "b.obj");
  EXPECT_TRUE(haveChanged(again)) << "it went";
}

TEST(WatchedFiles, FilesThatNameEachOtherEnd) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.json") << R"({"objects": [{"mesh": "a.json"}, {"mesh": "b.json"}]})";
  std::ofstream(folder / "b.json") << R"({"objects": [{"mesh": "a.json"}]})";
  EXPECT_EQ(filesOf(folder / "a.json").size(), 2u);
}

}  // namespace
}  // namespace luciole::test
