#include "scene/find_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "shared_files.hpp"

namespace luciole {
namespace {

/// Files wood.png, maps/brick.png and, in the folder `other`, stone.png and maps/sand.png.
class FindFile : public testing::Test {
 protected:
  FindFile() {
    for (const char* name : {"wood.png", "maps/brick.png", "other/stone.png", "other/maps/sand.png"}) {
      std::filesystem::create_directories((folder.path() / name).parent_path());
      std::ofstream(folder / name) << "a picture";
    }
  }
  std::string found(const std::string& name) {
    const std::string inside = folder.path().string();
    const std::string path = findFile(name, {inside, {inside + "/other"}}).value_or("");
    return path.empty() ? path : std::filesystem::relative(path, inside).string();
  }
  test::TemporaryFolder folder;
};

TEST_F(FindFile, FindsWhatIsWhereItsNameSays) {
  EXPECT_EQ(found("wood.png"), "wood.png");
  EXPECT_EQ(found("./maps/../wood.png"), "wood.png");
  EXPECT_EQ(found(folder / "maps/brick.png"), "maps/brick.png");
}

TEST_F(FindFile, TakesBackslashesForSlashes) {
  EXPECT_EQ(found("maps\\brick.png"), "maps/brick.png");
  std::ofstream(folder / "a\\b.png") << "a file of such a name goes first";
  EXPECT_EQ(found("a\\b.png"), "a\\b.png");
}

TEST_F(FindFile, FindsBesideTheFileWhatHasAPathOfAnotherMachine) {
  EXPECT_EQ(found("C:\\Users\\Ana\\wood.png"), "wood.png");
  EXPECT_EQ(found("/home/ana/wood.png"), "wood.png");
  EXPECT_EQ(found("elsewhere/wood.png"), "wood.png");
}

TEST_F(FindFile, LooksInTheOtherFoldersLast) {
  EXPECT_EQ(found("stone.png"), "other/stone.png");
  EXPECT_EQ(found("maps/sand.png"), "other/maps/sand.png");
  EXPECT_EQ(found("D:\\textures\\stone.png"), "other/stone.png");
}

TEST_F(FindFile, FindsNothingWhereThereIsNothing) {
  EXPECT_EQ(found("glass.png"), "");
  EXPECT_EQ(found("maps"), "") << "a folder is no file";
  EXPECT_EQ(found(""), "");
}

}  // namespace
}  // namespace luciole
