#include "base/peak_memory.hpp"

#include <fstream>
#include <string>

namespace luciole {

// VmHWM rather than ru_maxrss of getrusage, which starts at what the parent process had.
std::uint64_t peakBytes() {
  std::ifstream status("/proc/self/status");
  std::uint64_t kibibytes = 0;
  for (std::string field; status >> field;)
    if (field == "VmHWM:") status >> kibibytes;
  return kibibytes * 1024;
}

void resetPeakBytes() { std::ofstream("/proc/self/clear_refs") << "5"; }

}  // namespace luciole
