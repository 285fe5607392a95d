#include "tools/cli/shard.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "luciole/error.hpp"

namespace luciole {
namespace {

std::optional<int> wholeNumber(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// The value of one of the variables that Slurm sets in a job array. Throws InputError unless it is a whole
/// number of at least `least`.
int slurmNumber(const char* name, int least) {
  const char* text = std::getenv(name);
  const std::optional<int> number = text ? wholeNumber(text) : std::nullopt;
  if (!number || *number < least)
    throw InputError(fmt::format("{}: expected a whole number of {} or more, as Slurm sets it, got {}", name,
                                 least, text ? fmt::format("'{}'", text) : "nothing"));
  return *number;
}

/// Throws InputError in a task that runs several processes: all of them would do the same shard.
void refuseManyProcesses() {
  const char* text = std::getenv("SLURM_STEP_NUM_TASKS");
  const std::optional<int> processes = text ? wholeNumber(text) : std::nullopt;
  if (processes && *processes > 1)
    throw InputError(fmt::format(
        "SLURM_STEP_NUM_TASKS: {} processes of one array task would all do its part; expected one, as by "
        "srun -n1, or say each one's by --shard",
        *processes));
}

Shard slurmShard() {
  const int id = slurmNumber("SLURM_ARRAY_TASK_ID", 0);
  const int count = slurmNumber("SLURM_ARRAY_TASK_COUNT", 1);
  const int first = slurmNumber("SLURM_ARRAY_TASK_MIN", 0);
  const int last = slurmNumber("SLURM_ARRAY_TASK_MAX", 0);
  const int step = slurmNumber("SLURM_ARRAY_TASK_STEP", 1);
  refuseManyProcesses();
  // In an array with gaps, such as --array=1,3,7, a task can't tell how many come before it.
  if (std::int64_t(first) + std::int64_t(count - 1) * step != last)
    throw InputError(fmt::format(
        "SLURM_ARRAY_TASK_MAX: the array's {} tasks from {} to {} aren't numbered evenly; expected an array "
        "such as 1-{}, or say which part this is by --shard",
        count, first, last, count));
  const int steps = (id - first) / step;
  if (id < first || (id - first) % step != 0 || steps >= count)
    throw InputError(
        fmt::format("SLURM_ARRAY_TASK_ID: {} is none of the {} tasks {}, {}, …; say which one by --shard", id,
                    count, first, std::int64_t(first) + step));
  return {steps, count};
}

}  // namespace

Shard chosenShard(const std::string& option) {
  if (option.empty()) return std::getenv("SLURM_ARRAY_TASK_ID") ? slurmShard() : Shard{};
  const std::size_t slash = option.find('/');
  const std::string_view text = option;
  const int number = wholeNumber(text.substr(0, slash)).value_or(0);
  const int count = slash == std::string::npos ? 0 : wholeNumber(text.substr(slash + 1)).value_or(0);
  if (number < 1 || number > count)
    throw InputError(fmt::format(
        "--shard {}: expected I/N with I from 1 to N, such as 2/8 for the second of eight", option));
  return {number - 1, count};
}

}  // namespace luciole
