#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace luciole {

/// An OpenCL device.
struct DeviceDescription {
  std::string platform = {};
  std::string name = {};
  std::string version = {};  ///< the driver's
  int lanes = 1;  ///< pixels that a work-item shades: 16, 8, 4 or 1, by the device's native vector width
  unsigned compute_units = 0;  ///< work-groups that run at once; on a CPU, the device's threads
  /// A hash of its results for arithmetic corner cases. Devices of equal hashes make pictures of equal bits.
  /// Empty: not checked.
  std::string arithmetic = {};
};

/// Bytes that OpenCL buffers have copied and allocated. A device that shares the host's memory copies none.
struct Traffic {
  std::uint64_t bytes_up = 0;    ///< copied from the host to the device
  std::uint64_t bytes_down = 0;  ///< copied from the device to the host
  std::uint64_t bytes_made = 0;  ///< allocated by buffers, except for those in an array of the host's
};

/// All OpenCL devices of all platforms, in the runtime's order. Empty if there is none. Throws MachineError
/// if this process may not take the memory that a platform needs.
std::vector<DeviceDescription> listDevices();

struct OpenedDevice;

/// An OpenCL device that makes pictures. Any thread may use it; calls take turns.
class Device {
 public:
  /// Opens a device. "": PoCL's first where there is one, otherwise the first. A number: that one of
  /// listDevices(). Anything else: the first whose name or platform contains it, case ignored. A selector
  /// that ends in ",lanes=N" (1, 4, 8 or 16) sets its lanes. Throws InputError if none fits, and MachineError
  /// if there is no device at all or it fails. Takes some 50 ms on a CPU.
  static Device open(const std::string& selector = "");

  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;
  ~Device();

  const DeviceDescription& description() const;

 private:
  friend OpenedDevice& opened(Device& device);
  explicit Device(std::unique_ptr<OpenedDevice> opened);
  std::unique_ptr<OpenedDevice> opened_;
};

}  // namespace luciole
