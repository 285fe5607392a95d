#include "base/machine_memory.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include "luciole/error.hpp"

namespace luciole {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// The number that a file holds; empty where there is no such file or, as "max", no number in it.
std::optional<double> numberIn(const std::string& path) {
  std::ifstream file(path);
  double number = 0;
  if (!(file >> number)) return std::nullopt;
  return number;
}

/// The number after a word that begins a line of the file; 0 where there is none.
double numberAfter(const std::string& path, const std::string& word) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (line.rfind(word, 0) == 0) return std::strtod(line.c_str() + word.size(), nullptr);
  return 0;
}

/// Whether a comma-separated list holds a name.
bool names(const std::string& list, const std::string& name) {
  std::istringstream entries(list);
  for (std::string entry; std::getline(entries, entry, ',');)
    if (entry == name) return true;
  return false;
}

/// Files of one version of control groups; `droppable` is a field of memory.stat.
struct GroupFiles {
  const char *limit, *use, *droppable;
};
constexpr GroupFiles kVersion1{"/memory.limit_in_bytes", "/memory.usage_in_bytes", "total_inactive_file "};
constexpr GroupFiles kVersion2{"/memory.max", "/memory.current", "inactive_file "};

double roomInGroup(const std::string& folder, const GroupFiles& files) {
  const std::optional<double> limit = numberIn(folder + files.limit);
  if (!limit) return kUnlimited;
  const double used = numberIn(folder + files.use).value_or(0);
  return *limit - std::max(used - numberAfter(folder + "/memory.stat", files.droppable), 0.0);
}

/// Reduces `room` to the memory that a control group and all groups above it leave.
void narrow(MemoryRoom& room, const std::string& mount, std::string group, const GroupFiles& files) {
  for (;; group.erase(group.rfind('/'))) {
    const double left = roomInGroup(mount + group, files);
    if (left < room.bytes) room = {left, "the control group " + (group.empty() ? "/" : group)};
    if (group.find('/') == std::string::npos) return;
  }
}

/// Reduces `room` to the memory that a resource limit leaves. `used`: the field of /proc/self/status with the
/// use in kB.
void narrow(MemoryRoom& room, __rlimit_resource_t resource, const char* used, const char* name) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  const double left = double(limit.rlim_cur) - 1024 * numberAfter("/proc/self/status", used);
  if (left < room.bytes) room = {left, name};
}

/// Stack size of a new thread, bytes; 0 if unknown.
double stackBytes() {
  pthread_attr_t attributes;
  std::size_t bytes = 0;
  if (pthread_attr_init(&attributes) != 0) return 0;
  pthread_attr_getstacksize(&attributes, &bytes);
  pthread_attr_destroy(&attributes);
  return double(bytes);
}

std::string formatBytes(double bytes) {
  return bytes < double(1 << 30) ? fmt::format("{:.0f} MiB", bytes / (1 << 20))
                                 : fmt::format("{:.1f} GiB", bytes / (1 << 30));
}

void require(double bytes, MemoryRoom room, const std::string& what) {
  room.bytes = std::max(room.bytes, 0.0);
  // The comparison is negated so that NaN, which a product of sizes may be, is refused.
  if (!(bytes <= room.bytes))
    throw MachineError(fmt::format("{} needs {} of memory, and may use {} ({})", what, formatBytes(bytes),
                                   formatBytes(room.bytes), room.limited_by));
}

}  // namespace

double machineMemory() { return double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE)); }

MemoryRoom controlGroupRoom(const std::string& groups, const std::string& mount) {
  MemoryRoom room{kUnlimited, "the machine"};
  std::istringstream lines(groups);
  // Lines are "number:controllers:/group"; version 2 has no controllers there.
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    std::string group = line.substr(second + 1);
    while (!group.empty() && group.back() == '/') group.pop_back();
    if (controllers.empty())
      narrow(room, mount, group, kVersion2);
    else if (names(controllers, "memory"))
      narrow(room, mount + "/memory", group, kVersion1);
  }
  room.bytes = std::max(room.bytes, 0.0);
  return room;
}

MemoryRoom memoryRoom() {
  std::ifstream file("/proc/self/cgroup");
  std::ostringstream groups;
  groups << file.rdbuf();
  MemoryRoom room = controlGroupRoom(groups.str(), "/sys/fs/cgroup");
  const double machine = 0.9 * machineMemory() - 1024 * numberAfter("/proc/self/status", "VmRSS:");
  if (machine < room.bytes) room = {machine, "the machine"};
  narrow(room, RLIMIT_AS, "VmSize:", "ulimit -v");
  narrow(room, RLIMIT_DATA, "VmData:", "ulimit -d");
  room.bytes = std::max(room.bytes, 0.0);
  return room;
}

void requireMemory(double bytes, const std::string& what) { require(bytes, memoryRoom(), what); }

void requireMappings(double addresses, double writable, unsigned threads, const std::string& what) {
  const double stacks = threads * stackBytes();
  MemoryRoom mapped{kUnlimited, ""}, data{kUnlimited, ""};
  narrow(mapped, RLIMIT_AS, "VmSize:", "ulimit -v");
  narrow(data, RLIMIT_DATA, "VmData:", "ulimit -d");
  require(addresses + stacks, mapped, what);
  require(writable + stacks, data, what);
}

void limitMallocArenas() {
#if defined(__GLIBC__)
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) mallopt(M_ARENA_MAX, 1);
#endif
}

}  // namespace luciole
