// Runs that are given the same part of the frames: the second one sees what the first one claims.
#include "cli/frame_claims.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "base/error.hpp"
#include "cli/run_program.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

class FrameClaimsOfAFolder : public testing::Test {
 protected:
  std::string refusal(FrameClaims& claims, int frame) {
    try {
      claims.claim(frame);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
  bool isEmpty() const { return std::filesystem::is_empty(folder.path()); }

  const TemporaryFolder folder;
  const std::string pattern = folder / "f.####.png";
};

TEST_F(FrameClaimsOfAFolder, AFrameIsOneRunsUntilItEnds) {
  std::optional<FrameClaims> one(pattern), two(pattern);
  EXPECT_EQ(refusal(*one, 3), "");
  EXPECT_EQ(refusal(*one, 3), "");  // once more is nothing new
  EXPECT_EQ(refusal(*one, 5), "");
  EXPECT_EQ(refusal(*two, 4), "");
  EXPECT_THAT(refusal(*two, 3), testing::StartsWith("frame 3: another run is making it, as "));
  EXPECT_THAT(refusal(*two, 5), HasSubstr(".f.####.png.lock"));
  EXPECT_THAT(refusal(*one, 4), HasSubstr("frame 4"));
  one.reset();
  EXPECT_EQ(refusal(*two, 3), "");
}

TEST_F(FrameClaimsOfAFolder, OtherFilesAreOthers) {
  FrameClaims one(pattern), two(folder / "g.####.png");
  EXPECT_EQ(refusal(one, 3), "");
  EXPECT_EQ(refusal(two, 3), "");
}

TEST_F(FrameClaimsOfAFolder, TheLastRunToEndLeavesNothingBehind) {
  std::optional<FrameClaims> one(pattern), two(pattern);
  one->claim(1);
  two->claim(2);
  one.reset();
  EXPECT_FALSE(isEmpty());
  EXPECT_THAT(refusal(one.emplace(pattern), 2), HasSubstr("frame 2"));
  two.reset();
  one.reset();
  EXPECT_TRUE(isEmpty());
}

TEST_F(FrameClaimsOfAFolder, OneThatWasOpenedBeforeTheFileWentHoldsInTheNextFile) {
  std::optional<FrameClaims> one(pattern), two(pattern);
  one->claim(1);
  one.reset();  // takes the file away that the other one has open
  EXPECT_TRUE(isEmpty());
  EXPECT_EQ(refusal(*two, 1), "");
  FrameClaims three(pattern);
  EXPECT_THAT(refusal(three, 1), HasSubstr("frame 1"));
}

TEST_F(FrameClaimsOfAFolder, WhatAKilledRunLeftIsNoClaim) {
  writeText(folder / ".f.####.png.lock", "");
  {
    FrameClaims claims(pattern);
    EXPECT_EQ(refusal(claims, 1), "");
  }
  EXPECT_TRUE(isEmpty());
}

class SharedFrames : public testing::Test {
 protected:
  SharedFrames() { writeText(folder / "scene.json", kSmallScene); }

  Outcome render(const std::string& environment, const std::string& arguments) {
    return runLine(
        folder, environment + " luciole render scene.json --size 32x18 --quiet -o f.####.png " + arguments);
  }
  const TemporaryFolder folder;
};

TEST_F(SharedFrames, ASecondRunOfTheSamePartIsRefusedAndAnotherPartIsNot) {
  FrameClaims first(folder / "f.####.png");  // frames 2 and 4, the second of two parts
  first.claim(2);
  const std::string task =
      "export SLURM_ARRAY_TASK_COUNT=2 SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=2 SLURM_ARRAY_TASK_STEP=1 "
      "SLURM_ARRAY_TASK_ID=";
  for (const auto& [environment, arguments] :
       {std::pair<std::string, std::string>{fmt::format("{}2;", task), "--frames 1-4"},
        {fmt::format("{}2;", task), "--frames 1-4 --resume"},
        {"", "--frames 1-4 --shard 2/2"},
        {"", "--frames 2-4 --shard 1/1"}}) {
    const Outcome second = render(environment, arguments);
    EXPECT_EQ(second.status, 2) << arguments << second.err;
    EXPECT_TRUE(isOneLine(second.err)) << second.err;
    EXPECT_THAT(second.err, HasSubstr("frame 2: another run is making it")) << arguments;
    for (const int frame : {2, 3, 4})
      EXPECT_FALSE(std::filesystem::exists(folder / fmt::format("f.000{}.png", frame))) << frame;
  }
  const Outcome other = render(fmt::format("{}1;", task), "--frames 1-4");
  EXPECT_EQ(other.status, 0) << other.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "f.0003.png"));
}

TEST_F(SharedFrames, ARunStopsBeforeAFrameThatAnotherHasClaimedMeanwhile) {
  FrameClaims other(folder / "f.####.png");
  other.claim(3);
  const Outcome run = render("", "--frames 1-4 --shard 1/1");
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("frame 3: another run is making it"));
  EXPECT_TRUE(std::filesystem::exists(folder / "f.0002.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "f.0004.png"));
}

TEST_F(SharedFrames, LeaveNoFileButThePictures) {
  EXPECT_EQ(render("", "--frames 1-2 --shard 1/1").status, 0);
  std::filesystem::remove(folder / "f.0001.png");
  std::filesystem::remove(folder / "f.0002.png");
  std::filesystem::remove(folder / "scene.json");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace luciole::test
