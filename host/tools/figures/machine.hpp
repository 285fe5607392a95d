#pragma once

#include <cstdint>
#include <string>

#include "cl/device.hpp"

namespace luciole {

/// The machine that figures were measured on.
struct Machine {
  std::string processor;
  unsigned threads = 0;  ///< see threadCount()
  std::uint64_t memory_bytes = 0;
  std::string system;  ///< the operating system's name and version
  DeviceDescription device;
  std::string compiler;
};

/// Describes this machine, with an opened device. What the system doesn't tell is "unknown".
Machine describeMachine(const OpenedDevice& device);

}  // namespace luciole
