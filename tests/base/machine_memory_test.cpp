#include "base/machine_memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <latch>
#include <string>
#include <thread>
#include <vector>

#include "luciole/error.hpp"
#include "shared_files.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

class ControlGroups : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) {
    std::filesystem::create_directories(std::filesystem::path(folder / file).parent_path());
    std::ofstream(folder / file) << text;
  }
  MemoryRoom room(const std::string& groups) { return controlGroupRoom(groups, folder.path().string()); }
  TemporaryFolder folder;
};

TEST_F(ControlGroups, RoomIsALimitLessWhatIsInUseAndCannotBeDropped) {
  write("job/memory.max", "1000000\n");
  write("job/memory.current", "700000\n");
  write("job/memory.stat", "anon 400000\nfile 300000\ninactive_file 200000\nactive_file 100000\n");
  EXPECT_EQ(room("0::/job\n").bytes, 500000);
  EXPECT_EQ(room("0::/job\n").limited_by, "the control group /job");
  write("memory/job/memory.limit_in_bytes", "1000000\n");
  write("memory/job/memory.usage_in_bytes", "700000\n");
  write("memory/job/memory.stat", "inactive_file 1\ntotal_inactive_file 100000\n");
  EXPECT_EQ(room("5:cpu,memory:/job\n2:cpuset:/other\n").bytes, 400000);
}

TEST_F(ControlGroups, EveryGroupAboveCountsToo) {
  write("a/b/c/memory.max", "max\n");
  write("a/b/memory.max", "500\n");
  write("a/b/memory.current", "100\n");
  write("a/memory.max", "600\n");
  write("a/memory.current", "300\n");
  EXPECT_EQ(room("0::/a/b/c\n").bytes, 300);
  EXPECT_EQ(room("0::/a/b/c\n").limited_by, "the control group /a");
}

TEST_F(ControlGroups, TheTopmostCountsWhereAContainerSeesNoOther) {
  // The text names the group as the machine does; the container's mount shows that group as the root.
  write("memory/memory.limit_in_bytes", "800\n");
  write("memory/memory.usage_in_bytes", "200\n");
  EXPECT_EQ(room("4:memory:/docker/0123456789\n").bytes, 600);
  EXPECT_EQ(room("4:memory:/docker/0123456789\n").limited_by, "the control group /");
}

TEST_F(ControlGroups, WithoutALimitThereIsNone) {
  write("job/memory.max", "max\n");
  for (const char* groups : {"0::/job\n", "0::/\n", "", "3:cpu:/job\n", "nonsense\n", "0::/no/such/group\n"})
    EXPECT_TRUE(std::isinf(room(groups).bytes)) << groups;
}

TEST_F(ControlGroups, AGroupThatIsFullLeavesNothing) {
  write("job/memory.max", "100\n");
  write("job/memory.current", "150\n");
  EXPECT_EQ(room("0::/job\n").bytes, 0);
}

TEST(MachineMemory, WhatIsTooMuchIsRefusedInFigures) {
  EXPECT_GT(memoryRoom().bytes, 0);
  EXPECT_LE(memoryRoom().bytes, machineMemory());
  requireMemory(1, "a byte");
  for (const double bytes : {1e18, std::nan("")}) {
    try {
      requireMemory(bytes, "a lot");
      ADD_FAILURE() << bytes;
    } catch (const MachineError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("a lot needs "));
      EXPECT_THAT(error.what(), HasSubstr(" of memory, and may use "));
      EXPECT_THAT(error.what(), HasSubstr(memoryRoom().limited_by));
    }
  }
}

/// Arenas from which this process's threads allocate, when there are eight of them at once.
int arenasOfThreads() {
  std::latch all_here(8);
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      const std::vector<char> memory(1000);
      all_here.arrive_and_wait();
    });
  for (std::thread& thread : threads) thread.join();
  char* text = nullptr;
  std::size_t size = 0;
  FILE* file = open_memstream(&text, &size);
  malloc_info(0, file);
  std::fclose(file);
  int arenas = 0;
  for (const char* place = text; (place = std::strstr(place, "<heap nr=")) != nullptr; ++place) ++arenas;
  std::free(text);
  return arenas;
}

TEST(MachineMemory, WhereAddressesAreLimitedThreadsShareAnArena) {
  // Ends with the number of arenas, in a process of its own, which keeps the limit.
  const auto endWithArenas = [](rlim_t most) {
    rlimit limit{};
    getrlimit(RLIMIT_AS, &limit);
    limit.rlim_cur = most;
    setrlimit(RLIMIT_AS, &limit);
    limitMallocArenas();
    std::_Exit(arenasOfThreads());
  };
  // A limit, but more than even the sanitizers take.
  EXPECT_EXIT(endWithArenas(rlim_t{1} << 50), testing::ExitedWithCode(1), "");
}

}  // namespace
}  // namespace luciole::test
