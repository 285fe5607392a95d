// Runs that are given the same frames share them.
#include "tools/cli/frame_claims.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <atomic>
#include <chrono>
#include <optional>
#include <thread>
#include <vector>

#include "luciole/error.hpp"
#include "tools/cli/run_program.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

class FrameClaimsOfAFolder : public testing::Test {
 protected:
  bool isEmpty() const { return std::filesystem::is_empty(folder.path()); }

  const TemporaryFolder folder;
  const std::string pattern = folder / "f.####.png";
};

TEST_F(FrameClaimsOfAFolder, AFrameIsOneRunsUntilItEnds) {
  std::optional<FrameClaims> one(pattern), two(pattern);
  EXPECT_TRUE(one->claim(3));
  EXPECT_TRUE(one->claim(3));  // once more is nothing new
  EXPECT_TRUE(one->claim(5));
  EXPECT_TRUE(two->claim(4));
  EXPECT_FALSE(two->claim(3));
  EXPECT_FALSE(two->claim(5));
  EXPECT_FALSE(one->claim(4));
  one.reset();
  EXPECT_TRUE(two->claim(3));
}

TEST_F(FrameClaimsOfAFolder, OneThatIsFinishedIsNobodysAsLongAsAnyRunOfThemIsAtWork) {
  std::optional<FrameClaims> one(pattern), two(pattern);
  EXPECT_TRUE(one->claim(3));
  one->finish(3);
  EXPECT_FALSE(one->claim(3));
  EXPECT_FALSE(two->claim(3));
  one.reset();
  EXPECT_FALSE(two->claim(3));
  EXPECT_FALSE(one.emplace(pattern).claim(3));
  one.reset();
  two.reset();
  EXPECT_TRUE(FrameClaims(pattern).claim(3)) << "a later run makes all again";
}

TEST_F(FrameClaimsOfAFolder, WhoAwaitsAFrameGetsItWhereTheOtherRunEndsWithoutIt) {
  std::optional<FrameClaims> one(pattern), two(pattern);
  one->claim(1);
  one->claim(2);
  std::atomic<int> awaited = 0;
  std::thread waiting([&] {
    EXPECT_FALSE(two->await(1));
    awaited = 1;
    EXPECT_TRUE(two->await(2));
  });
  one->finish(1);
  while (awaited != 1) std::this_thread::yield();
  one.reset();
  waiting.join();
}

TEST_F(FrameClaimsOfAFolder, OtherFilesAreOthers) {
  FrameClaims one(pattern), two(folder / "g.####.png");
  EXPECT_TRUE(one.claim(3));
  EXPECT_TRUE(two.claim(3));
}

TEST_F(FrameClaimsOfAFolder, TheLastRunToEndLeavesNothingBehind) {
  std::optional<FrameClaims> one(pattern), two(pattern);
  one->claim(1);
  two->claim(2);
  one.reset();
  EXPECT_FALSE(isEmpty());
  EXPECT_FALSE(one.emplace(pattern).claim(2));
  two.reset();
  one.reset();
  EXPECT_TRUE(isEmpty());
}

TEST_F(FrameClaimsOfAFolder, WhatAKilledRunLeftIsNoClaim) {
  writeText(folder / ".f.####.png.lock", std::string(100, '\1'));
  {
    FrameClaims claims(pattern);
    EXPECT_TRUE(claims.claim(1));
    EXPECT_TRUE(claims.claim(50));
  }
  EXPECT_TRUE(isEmpty());
}

// Runs begin and end all the time; each frame of a round is one run's alone.
TEST_F(FrameClaimsOfAFolder, RunsThatComeAndGoNeverMakeAFrameTwiceAtOnce) {
  constexpr int kFrames = 50;
  std::array<std::atomic<int>, kFrames> makers{};
  std::atomic<bool> overlapped = false;
  std::vector<std::thread> runs;
  for (int i = 0; i < 8; ++i)
    runs.emplace_back([&] {
      for (int round = 0; round < 20; ++round) {
        FrameClaims claims(pattern);
        for (int frame = 0; frame < kFrames; ++frame) {
          if (!claims.claim(frame)) continue;
          if (++makers[std::size_t(frame)] != 1) overlapped = true;
          std::this_thread::yield();
          --makers[std::size_t(frame)];
          claims.finish(frame);
        }
      }
    });
  for (std::thread& run : runs) run.join();
  EXPECT_FALSE(overlapped);
  EXPECT_TRUE(isEmpty());
}

class SharedFrames : public testing::Test {
 protected:
  SharedFrames() { writeText(folder / "scene.json", kSmallScene); }

  static std::string command(const std::string& arguments) {
    return "luciole render scene.json --size 32x18 -o f.####.png " + arguments;
  }
  std::string file(int frame) const { return folder / fmt::format("f.{:04}.png", frame); }
  /// Which file of that name this is: another one has another number or time.
  std::pair<ino_t, long> identity(int frame) const {
    struct stat status {};
    EXPECT_EQ(stat(file(frame).c_str(), &status), 0) << frame;
    return {status.st_ino, status.st_mtim.tv_nsec};
  }
  /// Waits for a file; false if that takes more than a minute.
  static bool appears(const std::string& path) {
    for (int tries = 0; tries < 6000 && !std::filesystem::exists(path); ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return std::filesystem::exists(path);
  }
  bool hasLock() const { return std::filesystem::exists(folder / ".f.####.png.lock"); }
  const TemporaryFolder folder;
};

TEST_F(SharedFrames, RunsThatAreStartedTogetherMakeEachFrameOnce) {
  const std::string run = command("--frames 1-40 --log json");
  const Outcome both = runLine(folder, run + " 2>one & " + run + " 2>two; a=$?; wait $! && exit $a");
  EXPECT_EQ(both.status, 0) << readText(folder / "one") << readText(folder / "two");
  const std::string events = readText(folder / "one") + readText(folder / "two");
  for (int frame = 1; frame <= 40; ++frame) {
    const std::string done = fmt::format("\"event\":\"frame_done\",\"frame\":{},", frame);
    const auto first = events.find(done);
    EXPECT_NE(first, std::string::npos) << frame;
    EXPECT_EQ(events.find(done, first + 1), std::string::npos) << frame;
    EXPECT_GT(std::filesystem::file_size(file(frame)), 0u);
  }
  EXPECT_FALSE(hasLock());
}

TEST_F(SharedFrames, AnotherRunLeavesThoseThatAreBeingMadeAndEndsWhenTheyAreMade) {
  FrameClaims other(folder / "f.####.png");
  other.claim(2);
  other.claim(3);
  other.finish(3);
  Outcome run;
  std::thread waiting([&] { run = runLine(folder, command("--frames 1-4")); });
  EXPECT_TRUE(appears(file(4)));
  EXPECT_FALSE(std::filesystem::exists(file(2)));
  other.finish(2);
  waiting.join();
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("made by other runs: 2 of 4 frames\n"));
  EXPECT_TRUE(std::filesystem::exists(file(1)));
  EXPECT_FALSE(std::filesystem::exists(file(2)));
  EXPECT_FALSE(std::filesystem::exists(file(3)));
}

TEST_F(SharedFrames, AreTheSameHoweverTheirNameIsTyped) {
  FrameClaims other(folder / "f.####.png");
  other.claim(1);
  other.finish(1);
  const Outcome run = runLine(folder, "luciole render scene.json --size 32x18 --frames 1-2 -o f.%04d.png");
  EXPECT_THAT(run.err, HasSubstr("made by other runs: 1 of 2 frames\n"));
}

TEST_F(SharedFrames, TheFrameThatAKilledRunWasAtIsTakenOver) {
  const Outcome second =
      runLine(folder, "(exec '" LUCIOLE_BINARY
                      "' render scene.json --size 640x360 --frames 1-4 -o f.####.png --log json 2>log) & "
                      "first=$!; until grep -q frame_begun log || ! kill -0 $first; do sleep 0.01; done; "
                      "kill -STOP $first; " +
                          command("--frames 1-4 2>err") +
                          " & second=$!; until [ -e f.0004.png ] || ! kill -0 $second; do sleep 0.01; done; "
                          "kill -KILL $first; wait $second");
  EXPECT_EQ(second.status, 0) << readText(folder / "err");
  for (int frame = 1; frame <= 4; ++frame) EXPECT_TRUE(std::filesystem::exists(file(frame))) << frame;
  EXPECT_FALSE(hasLock());
}

TEST_F(SharedFrames, ATakenOverFrameOfAnOrbitIsSeenFromItsOwnSide) {
  std::optional<FrameClaims> other(folder / "f.####.png");
  other->claim(2);
  Outcome run;
  std::thread waiting([&] { run = runLine(folder, command("--orbit 4 --hash")); });
  EXPECT_TRUE(appears(file(4)));
  other.reset();
  waiting.join();
  const Outcome alone = runLine(folder,
                                "luciole render scene.json --size 32x18 --orbit 4 --frames 2 --hash "
                                "-o f.0002.png");
  EXPECT_THAT(run.out, HasSubstr(alone.out)) << run.err << alone.err;
}

TEST_F(SharedFrames, ALaterRunMakesAllAgainButWithResume) {
  EXPECT_EQ(runLine(folder, command("--frames 1-2")).status, 0);
  const auto first = identity(1);
  EXPECT_EQ(runLine(folder, command("--frames 1-2 --resume")).status, 0);
  EXPECT_EQ(identity(1), first);
  EXPECT_EQ(runLine(folder, command("--frames 1-2")).status, 0);
  EXPECT_NE(identity(1), first);
}

TEST_F(SharedFrames, LeaveNoFileButThePictures) {
  writeText(folder / ".f.####.png.lock", "what a killed run left");
  EXPECT_EQ(runLine(folder, command("--frames 1-2")).status, 0);
  std::filesystem::remove(folder / "f.0001.png");
  std::filesystem::remove(folder / "f.0002.png");
  std::filesystem::remove(folder / "scene.json");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace luciole::test
