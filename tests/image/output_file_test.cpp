#include "image/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>

#include "error.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using test::TemporaryFolder;

std::span<const std::byte> bytes(const std::string& text) { return std::as_bytes(std::span(text)); }

std::string textOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(OutputFile, PiecesLieAtTheirOffsetsInWhateverOrderTheyCame) {
  const TemporaryFolder folder;
  OutputFile file(folder / "a");
  file.writeAt(4, bytes("56"));
  file.writeAt(0, bytes("1234"));
  file.writeAt(1, bytes("x"));
  file.putInPlace();
  EXPECT_EQ(textOf(folder / "a"), "1x3456");
}

TEST(OutputFile, TheOldFileStaysUntilTheNewOneIsInPlace) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << "old";
  {
    OutputFile given_up(folder / "a");
    given_up.writeAt(0, bytes("new"));
  }
  EXPECT_EQ(textOf(folder / "a"), "old");
  OutputFile file(folder / "a");
  file.writeAt(0, bytes("new"));
  EXPECT_EQ(textOf(folder / "a"), "old");
  file.putInPlace();
  EXPECT_EQ(textOf(folder / "a"), "new");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(OutputFile, SeveralAtOnceDontMeet) {
  const TemporaryFolder folder;
  OutputFile first(folder / "a"), second(folder / "b");
  first.writeAt(0, bytes("first"));
  second.writeAt(0, bytes("second"));
  second.putInPlace();
  first.putInPlace();
  EXPECT_EQ(textOf(folder / "a"), "first");
  EXPECT_EQ(textOf(folder / "b"), "second");
}

TEST(OutputFile, HasTheRightsThatTheUsersMaskLeaves) {
  const TemporaryFolder folder;
  const mode_t mask = umask(027);
  OutputFile file(folder / "a");
  file.putInPlace();
  umask(mask);
  struct stat status {};
  ASSERT_EQ(stat((folder / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST(OutputFile, StandardOutputCantGoBack) {
  OutputFile out("-");
  out.writeAt(0, bytes("\n"));
  EXPECT_THROW(out.writeAt(0, bytes("again")), MachineError);
}

}  // namespace
}  // namespace luciole
