#pragma once

#include <cstddef>
#include <string>

namespace luciole {

/// One of several runs that share a job. Of the job's pieces, counted from 0, it does every count-th from
/// `index` on. The default does all.
struct Shard {
  int index = 0;  ///< 0 ≤ index < count
  int count = 1;
};

/// The shard that --shard names ("2/8": the second of eight). If `option` is empty: this task of a Slurm job
/// array (SLURM_ARRAY_TASK_ID, _COUNT, _MIN, _MAX and _STEP), or all outside of one. Throws InputError that
/// names the option or the variable, also for a Slurm array whose tasks aren't numbered evenly, and for a
/// task that runs several processes.
Shard chosenShard(const std::string& option);

/// Whether this shard does piece k.
inline bool isMine(Shard shard, std::size_t k) {
  return k % static_cast<std::size_t>(shard.count) == static_cast<std::size_t>(shard.index);
}

}  // namespace luciole
