#include "cl/program_cache.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "setting.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

/// A program of so many bytes, each of this value.
KeptProgram programOf(std::size_t bytes, unsigned char value) {
  return {std::vector<unsigned char>(bytes, value),
          {{"probe", {{"out", "float*", CL_KERNEL_ARG_ADDRESS_GLOBAL, false}}}}};
}

std::string fileOf(const TemporaryFolder& folder) { return folder / filesIn(folder).front(); }

TEST(ProgramCache, GivesBackWhatWasKept) {
  const TemporaryFolder folder;
  const std::string below = folder / "not/there/yet";
  const KeptProgram program{{0, 255, 10, 13},
                            {{"first", {}},
                             {"second",
                              {{"in", "Own*", CL_KERNEL_ARG_ADDRESS_GLOBAL, true},
                               {"count", "uint", CL_KERNEL_ARG_ADDRESS_PRIVATE, false}}}}};
  EXPECT_FALSE(findProgram(below, "one"));
  keepProgram(below, "one", program);
  const std::optional<KeptProgram> found = findProgram(below, "one");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->binary, program.binary);
  ASSERT_EQ(found->arguments.size(), 2u);
  EXPECT_TRUE(found->arguments.at("first").empty());
  const std::vector<DeclaredArgument>& arguments = found->arguments.at("second");
  ASSERT_EQ(arguments.size(), 2u);
  EXPECT_EQ(arguments[0].name, "in");
  EXPECT_EQ(arguments[0].type, "Own*");
  EXPECT_EQ(arguments[0].space, cl_kernel_arg_address_qualifier(CL_KERNEL_ARG_ADDRESS_GLOBAL));
  EXPECT_TRUE(arguments[0].is_const);
  EXPECT_EQ(arguments[1].name, "count");
  EXPECT_FALSE(arguments[1].is_const);
  EXPECT_FALSE(findProgram(below, "another"));
}

// As if both had one hash.
TEST(ProgramCache, AFileInAnothersPlaceIsNotTakenForIt) {
  const TemporaryFolder one, another;
  keepProgram(one.path(), "one", programOf(100, 1));
  keepProgram(another.path(), "another", programOf(100, 2));
  std::filesystem::copy_file(fileOf(another), fileOf(one), std::filesystem::copy_options::overwrite_existing);
  EXPECT_FALSE(findProgram(one.path(), "one"));
}

TEST(ProgramCache, ADamagedFileIsNone) {
  const TemporaryFolder folder;
  keepProgram(folder.path(), "one", programOf(200, 7));
  const std::string file = fileOf(folder), whole = readText(file);
  ASSERT_TRUE(findProgram(folder.path(), "one"));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    writeText(file, whole.substr(0, length));
    EXPECT_FALSE(findProgram(folder.path(), "one")) << length << " bytes of it";
  }
  for (std::size_t place = 0; place < whole.size(); ++place) {
    std::string damaged = whole;
    damaged[place] ^= 4;
    writeText(file, damaged);
    EXPECT_FALSE(findProgram(folder.path(), "one")) << "byte " << place;
  }
  keepProgram(folder.path(), "one", programOf(200, 7));
  EXPECT_EQ(readText(file), whole);
}

TEST(ProgramCache, AFolderThatCannotBeWrittenIsNoError) {
  const TemporaryFolder folder;
  writeText(folder / "file", "");
  for (const std::string& place : {folder / "file", folder / "file/below", std::string("/proc/none")}) {
    keepProgram(place, "one", programOf(100, 1));
    EXPECT_FALSE(findProgram(place, "one")) << place;
  }
  EXPECT_EQ(filesIn(folder), std::vector<std::string>{"file"});
}

TEST(ProgramCache, ManyMayReadAndWriteAtOnce) {
  const TemporaryFolder folder;
  std::vector<std::thread> threads;
  for (unsigned char value = 1; value <= 4; ++value)
    threads.emplace_back([&folder, value] {
      for (int i = 0; i < 20; ++i) {
        keepProgram(folder.path(), "shared", programOf(20000, value));
        const std::optional<KeptProgram> found = findProgram(folder.path(), "shared");
        ASSERT_TRUE(found) << "it was kept, and is replaced only by whole ones";
        EXPECT_THAT(found->binary, testing::Each(found->binary.front()));
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(filesIn(folder).size(), 1u) << "the hidden names are gone";
}

TEST(ProgramCache, WhatWasUsedLongestAgoMakesRoom) {
  const TemporaryFolder folder;
  constexpr std::uintmax_t kRoom = 3500;  // three of 1000 bytes with their descriptions
  const auto now = std::filesystem::file_time_type::clock::now();
  for (const char* name : {"a", "b", "c"}) {
    keepProgram(folder.path(), name, programOf(1000, 1), kRoom);
    ASSERT_TRUE(findProgram(folder.path(), name));
  }
  writeText(folder / "notes.txt", std::string(5000, 'x'));  // somebody else's
  for (const std::string& name : filesIn(folder))
    std::filesystem::last_write_time(folder / name, now - std::chrono::hours(1));
  ASSERT_TRUE(findProgram(folder.path(), "a"));  // used
  ASSERT_TRUE(findProgram(folder.path(), "c"));
  keepProgram(folder.path(), "d", programOf(1000, 1), kRoom);
  EXPECT_FALSE(findProgram(folder.path(), "b"));
  for (const char* name : {"a", "c", "d"}) EXPECT_TRUE(findProgram(folder.path(), name)) << name;
  EXPECT_TRUE(std::filesystem::exists(folder / "notes.txt"));
}

TEST(UserProgramCache, IsBelowTheUsersCacheFolder) {
  const Setting home("HOME", "/home/someone");
  {
    const Setting cache("XDG_CACHE_HOME", "/elsewhere");
    EXPECT_EQ(userProgramCache(), "/elsewhere/luciole/programs");
  }
  for (const std::optional<std::string>& none : {std::optional<std::string>(), std::optional<std::string>(""),
                                                 std::optional<std::string>("relative/path")}) {
    const Setting cache("XDG_CACHE_HOME", none);
    EXPECT_EQ(userProgramCache(), "/home/someone/.cache/luciole/programs");
    const Setting homeless("HOME", std::nullopt);
    EXPECT_EQ(userProgramCache(), "");
  }
}

}  // namespace
}  // namespace luciole::test
