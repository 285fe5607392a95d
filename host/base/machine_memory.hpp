#pragma once

#include <string>

namespace luciole {

/// Bytes of physical memory of the machine.
double machineMemory();

/// The memory that this process may still take.
struct MemoryRoom {
  double bytes;            ///< ≥ 0
  std::string limited_by;  ///< "the machine", "the control group /a/b", "ulimit -v" or "ulimit -d"
};

/// The least of what these leave: nine tenths of the machine's memory, the control groups of this process,
/// and its resource limits RLIMIT_AS and RLIMIT_DATA. What this process has in use already is subtracted.
/// Reads /proc and /sys/fs/cgroup at every call.
MemoryRoom memoryRoom();

/// What the control groups of a process leave. `groups` is the text of its /proc/PID/cgroup, `mount` the
/// folder where the hierarchies are mounted. A group leaves its limit less its use, where files that the
/// kernel can drop don't count as use. Both version 1 (`memory/…/memory.limit_in_bytes`) and version 2
/// (`…/memory.max`) are read, for each group and all above it. Infinite where nothing limits it. Groups
/// without a folder are skipped: a container sees its own group as the topmost, under another path than the
/// text says.
MemoryRoom controlGroupRoom(const std::string& groups, const std::string& mount);

/// Throws MachineError if `bytes` are more than memoryRoom(). `what`: their use, for the message.
void requireMemory(double bytes, const std::string& what);

/// The same for a library that maps much memory and touches little of it. `addresses`: bytes of address
/// space, which `ulimit -v` limits. `writable`: how many of them may be written, which `ulimit -d` limits.
/// The stacks of `threads` threads are added to both.
void requireMappings(double addresses, double writable, unsigned threads, const std::string& what);

/// If address space is limited (`ulimit -v`), makes malloc use one arena for all threads. By default glibc
/// gives contending threads arenas of 64 MiB of addresses each, so the need for addresses would depend on
/// scheduling, and OpenCL's compiler aborts or hangs when they run out. Call it before any thread is started.
void limitMallocArenas();

}  // namespace luciole
