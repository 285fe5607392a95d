#include "tools/figures/machine.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <fstream>

#include "base/machine_memory.hpp"
#include "base/threads.hpp"

namespace luciole {
namespace {

/// "model name" of Linux's /proc/cpuinfo; "unknown" where there is none.
std::string processorName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(std::min(line.find(": ") + 2, line.size()));
  return "unknown";
}

std::string systemName() {
  utsname name{};
  return uname(&name) == 0 ? std::string(name.sysname) + " " + name.release : "unknown";
}

}  // namespace

Machine describeMachine(const OpenedDevice& device) {
  return {.processor = processorName(),
          .threads = threadCount(),
          .memory_bytes = std::uint64_t(machineMemory()),
          .system = systemName(),
          .device = device.description,
          .compiler = __VERSION__};
}

}  // namespace luciole
