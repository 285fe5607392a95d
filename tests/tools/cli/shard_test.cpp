#include "tools/cli/shard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <string>
#include <tuple>

#include "luciole/error.hpp"

namespace luciole {
namespace {

/// The environment of one task of a Slurm job array, while it lives. A null variable is not set.
struct SlurmTask {
  SlurmTask(const char* id, const char* count, const char* first, const char* last, const char* step) {
    set("SLURM_ARRAY_TASK_ID", id);
    set("SLURM_ARRAY_TASK_COUNT", count);
    set("SLURM_ARRAY_TASK_MIN", first);
    set("SLURM_ARRAY_TASK_MAX", last);
    set("SLURM_ARRAY_TASK_STEP", step);
    set("SLURM_STEP_NUM_TASKS", nullptr);
  }
  ~SlurmTask() {
    for (const char* name : {"ARRAY_TASK_ID", "ARRAY_TASK_COUNT", "ARRAY_TASK_MIN", "ARRAY_TASK_MAX",
                             "ARRAY_TASK_STEP", "STEP_NUM_TASKS"})
      unsetenv((std::string("SLURM_") + name).c_str());
  }
  static void set(const char* name, const char* value) {
    if (value)
      setenv(name, value, 1);
    else
      unsetenv(name);
  }
};

std::string errorOf(const std::string& option) {
  try {
    const Shard shard = chosenShard(option);
    return "none: " + std::to_string(shard.index) + " of " + std::to_string(shard.count);
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Shard, IsAllUnlessSomethingSaysOtherwise) {
  const SlurmTask none(nullptr, nullptr, nullptr, nullptr, nullptr);
  const Shard shard = chosenShard("");
  EXPECT_EQ(shard.index, 0);
  EXPECT_EQ(shard.count, 1);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_TRUE(isMine(shard, k));
}

TEST(Shard, IsCountedFromOneWhenTyped) {
  for (const auto& [text, index, count] : {std::tuple{"1/1", 0, 1},
                                           {"1/8", 0, 8},
                                           {"8/8", 7, 8},
                                           {"2147483647/2147483647", 2147483646, 2147483647}}) {
    const Shard shard = chosenShard(text);
    EXPECT_EQ(shard.index, index) << text;
    EXPECT_EQ(shard.count, count) << text;
  }
}

TEST(Shard, RefusesWhatIsNoPartOfAWhole) {
  for (const char* text : {"0/4", "5/4", "-1/4", "1/0", "1", "/", "1/", "/4", "1/4/2", "1.5/4", " 1/4", "a/b",
                           "1/99999999999"}) {
    EXPECT_THAT(errorOf(text), testing::StartsWith(std::string("--shard ") + text + ": expected I/N"));
  }
}

TEST(Shard, IsTheTaskOfASlurmArray) {
  // sbatch --array=0-3, =1-4%2, =10-40:10
  for (const auto& [id, first, last, step] :
       {std::tuple{"2", "0", "3", "1"}, {"3", "1", "4", "1"}, {"30", "10", "40", "10"}}) {
    const SlurmTask task(id, "4", first, last, step);
    const Shard shard = chosenShard("");
    EXPECT_EQ(shard.index, 2) << id;
    EXPECT_EQ(shard.count, 4) << id;
  }
}

TEST(Shard, TypedOnesWinOverSlurm) {
  const SlurmTask task("2", "4", "0", "3", "1");
  EXPECT_EQ(chosenShard("5/8").index, 4);
  EXPECT_EQ(chosenShard("5/8").count, 8);
}

TEST(Shard, RefusesSlurmVariablesThatMakeNoSense) {
  const auto expectError = [](const SlurmTask&, const std::string& what) {
    EXPECT_THAT(errorOf(""), testing::StartsWith(what));
  };
  expectError({"x", "4", "0", "3", "1"}, "SLURM_ARRAY_TASK_ID: expected a whole number of 0 or more");
  expectError({"", "4", "0", "3", "1"}, "SLURM_ARRAY_TASK_ID: expected");
  expectError({"0", nullptr, "0", "3", "1"}, "SLURM_ARRAY_TASK_COUNT: expected a whole number of 1 or more");
  expectError({"0", "0", "0", "3", "1"}, "SLURM_ARRAY_TASK_COUNT: expected");
  expectError({"0", "4", "-1", "3", "1"}, "SLURM_ARRAY_TASK_MIN: expected");
  expectError({"0", "4", "0", nullptr, "1"}, "SLURM_ARRAY_TASK_MAX: expected");
  expectError({"0", "4", "0", "3", "0"}, "SLURM_ARRAY_TASK_STEP: expected");
  expectError({"0", "4", "0", "3", "2147483648"}, "SLURM_ARRAY_TASK_STEP: expected");
  // Outside the array, or between its tasks.
  expectError({"4", "4", "0", "3", "1"}, "SLURM_ARRAY_TASK_ID: 4 is none of the 4 tasks");
  expectError({"0", "4", "1", "4", "1"}, "SLURM_ARRAY_TASK_ID: 0 is none of the 4 tasks");
  expectError({"3", "4", "0", "6", "2"}, "SLURM_ARRAY_TASK_ID: 3 is none of the 4 tasks");
}

TEST(Shard, RefusesEveryTaskOfAnArrayWithHoles) {
  // sbatch --array=1,3,7 and =0,3-4: Slurm says a step of 1, so that some would take a part that isn't
  // theirs, and one that nobody takes is left.
  for (const auto& [first, last, ids] :
       {std::tuple{"1", "7", std::array{"1", "3", "7"}}, {"0", "4", std::array{"0", "3", "4"}}})
    for (const char* id : ids) {
      const SlurmTask task(id, "3", first, last, "1");
      EXPECT_THAT(errorOf(""),
                  testing::AllOf(testing::StartsWith("SLURM_ARRAY_TASK_MAX: the array's 3 tasks"),
                                 testing::HasSubstr("1-3")))
          << id;
    }
}

TEST(Shard, RefusesATaskThatRunsSeveralProcesses) {
  // sbatch --array=1-4 -n2 --wrap 'srun luciole …'
  const SlurmTask task("2", "4", "1", "4", "1");
  SlurmTask::set("SLURM_STEP_NUM_TASKS", "2");
  EXPECT_THAT(errorOf(""), testing::StartsWith("SLURM_STEP_NUM_TASKS: 2 processes of one array task"));
  EXPECT_EQ(chosenShard("3/8").index, 2);
  SlurmTask::set("SLURM_STEP_NUM_TASKS", "1");
  EXPECT_EQ(chosenShard("").index, 1);
}

TEST(Shard, EveryPieceIsInExactlyOne) {
  for (const int count : {1, 2, 3, 7, 144}) {
    for (std::size_t k = 0; k < 300; ++k) {
      int owners = 0;
      for (int i = 0; i < count; ++i) owners += isMine({i, count}, k);
      EXPECT_EQ(owners, 1) << k << " of " << count;
    }
  }
}

}  // namespace
}  // namespace luciole
