#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <string>

#include "error.hpp"

namespace luciole {

/// Bytes of memory that the machine has.
inline double machineMemory() { return double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE)); }

/// Throws MachineError where `bytes` are more than the machine has to give; `what` is what takes them.
inline void requireMemory(double bytes, const std::string& what) {
  if (bytes > 0.9 * machineMemory())
    throw MachineError(fmt::format("{} takes about {:.0f} GiB of memory, and the machine has {:.0f}", what,
                                   bytes / (1 << 30), machineMemory() / (1 << 30)));
}

}  // namespace luciole
