#pragma once

#include <string>

namespace luciole {

/// Bytes of memory that the machine has.
double machineMemory();

/// What this process may still take.
struct MemoryRoom {
  double bytes;            ///< ≥ 0
  std::string limited_by;  ///< "the machine", "the control group /a/b", "ulimit -v" or "ulimit -d"
};

/// Beside what it has: the least of what nine tenths of the machine's memory, its control groups and its
/// resource limits leave.
MemoryRoom memoryRoom();

/// What the control groups that a process is in leave, by the text of its /proc/PID/cgroup and the folder
/// where their hierarchies are mounted: a group's limit less what the group has in use, files that the kernel
/// can drop left out. Version 1 (`memory/…/memory.limit_in_bytes`) and 2 (`…/memory.max`); a group above
/// counts as well. Infinite where nothing limits it. A container sees its own group as the topmost, under
/// another path than the text says; groups that aren't there are passed over.
MemoryRoom controlGroupRoom(const std::string& groups, const std::string& mount);

/// Throws MachineError where `bytes` are more than this process may still take; `what` is what needs them.
void requireMemory(double bytes, const std::string& what);

/// The same for what libraries map and hardly touch: addresses, which `ulimit -v` limits, and those of them
/// that may be written, which `ulimit -d` does. Comes on top: the stacks of `threads` threads.
void requireMappings(double addresses, double writable, unsigned threads, const std::string& what);

}  // namespace luciole
