#pragma once

#include <cstdint>
#include <string>

#include "cl/device.hpp"

namespace luciole {

/// What figures were measured on.
struct Machine {
  std::string processor;
  unsigned threads = 0;
  std::uint64_t memory_bytes = 0;
  std::string system;  ///< its name and version
  DeviceDescription device;
  std::string compiler;
};

/// This machine, with an opened device.
Machine describeMachine(const Device& device);

}  // namespace luciole
