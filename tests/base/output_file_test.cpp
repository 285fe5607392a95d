#include "base/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>
#include <utility>

#include "luciole/error.hpp"
#include "shared_files.hpp"

namespace luciole {
namespace {

using test::readText;
using test::TemporaryFolder;

std::span<const std::byte> bytes(const std::string& text) { return std::as_bytes(std::span(text)); }

TEST(OutputFile, PiecesLieAtTheirOffsetsInWhateverOrderTheyCame) {
  const TemporaryFolder folder;
  OutputFile file(folder / "a");
  file.writeAt(4, bytes("56"));
  file.writeAt(0, bytes("1234"));
  file.writeAt(1, bytes("x"));
  file.putInPlace();
  EXPECT_EQ(readText(folder / "a"), "1x3456");
}

TEST(OutputFile, TheOldFileStaysUntilTheNewOneIsInPlace) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << "old";
  {
    OutputFile given_up(folder / "a");
    given_up.writeAt(0, bytes("new"));
  }
  EXPECT_EQ(readText(folder / "a"), "old");
  OutputFile file(folder / "a");
  file.writeAt(0, bytes("new"));
  EXPECT_EQ(readText(folder / "a"), "old");
  file.putInPlace();
  EXPECT_EQ(readText(folder / "a"), "new");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(OutputFile, SeveralAtOnceDontMeet) {
  const TemporaryFolder folder;
  OutputFile first(folder / "a"), second(folder / "b");
  first.writeAt(0, bytes("first"));
  second.writeAt(0, bytes("second"));
  second.putInPlace();
  first.putInPlace();
  EXPECT_EQ(readText(folder / "a"), "first");
  EXPECT_EQ(readText(folder / "b"), "second");
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

TEST(OutputFile, LinksStayAndWhatTheyLeadToIsReplacedWhole) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "shelf/box");
  std::ofstream(folder / "shelf/box/target") << "old";
  std::filesystem::create_symlink("box/target", folder / "shelf/inner");  // beside the link
  std::filesystem::create_symlink(folder / "shelf/inner", folder / "a");  // from the root
  std::filesystem::create_symlink("shelf/none yet", folder / "dangling");
  for (const auto& [link, target] : {std::pair("a", "shelf/box/target"), {"dangling", "shelf/none yet"}}) {
    OutputFile file(folder / link);
    file.writeAt(0, bytes("new"));
    EXPECT_NE(readText(folder / target), "new") << "before it is whole";
    file.putInPlace();
    EXPECT_EQ(readText(folder / target), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / link));
    EXPECT_FALSE(std::filesystem::is_symlink(folder / target));
  }
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "shelf/inner"));
  std::filesystem::create_symlink("round", folder / "round");
  EXPECT_THROW(OutputFile(folder / "round"), InputError);
}

TEST(OutputFile, WhatIsNoFileGetsTheBytesAndStaysWhatItIs) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "fifo").c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = readText(folder / "fifo"); });
  OutputFile file(folder / "fifo");
  EXPECT_TRUE(file.isStream());
  file.writeAt(0, bytes("one, "));
  file.writeAt(5, bytes("two"));
  EXPECT_THROW(file.writeAt(0, bytes("again")), MachineError);
  file.putInPlace();
  reader.join();
  EXPECT_EQ(read, "one, two");
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "fifo"));
  // Through links, so that a mistake here costs the machine no device.
  std::filesystem::create_symlink("/dev/null", folder / "null");
  OutputFile null(folder / "null");
  null.writeAt(0, bytes("gone"));
  null.putInPlace();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "null"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  std::filesystem::create_symlink("/dev/full", folder / "full");
  OutputFile full(folder / "full");
  EXPECT_THROW(full.writeAt(0, bytes("too much")), MachineError);
}

TEST(OutputFile, StandardOutputCantGoBack) {
  OutputFile out("-");
  out.writeAt(0, bytes("\n"));
  EXPECT_THROW(out.writeAt(0, bytes("again")), MachineError);
}

}  // namespace
}  // namespace luciole
