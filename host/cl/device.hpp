#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <cstdint>
#include <future>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace luciole {

/// An OpenCL device as `luciole devices` lists it.
struct DeviceDescription {
  std::string platform;
  std::string name;
  std::string version;  ///< the driver's
  int lanes = 1;        ///< pixels a work-item shades: 16, 8, 4 or 1, by the device's native vector width
};

/// What buffers cost a device, in bytes. Where it shares the host's memory nothing is copied.
struct Traffic {
  std::uint64_t bytes_up = 0;    ///< copied from the host to the device
  std::uint64_t bytes_down = 0;  ///< copied from the device to the host
  std::uint64_t bytes_made =
      0;  ///< of memory that buffers were given; arrays of the host's in their place are none
};

/// A device, opened, with what every launch on it needs.
struct Device {
  DeviceDescription description;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;           ///< in order
  bool shares_host_memory = false;  ///< set it before the first buffer is made

  /// Programs built so far, by options and file or source; guarded by `programs_mutex`.
  std::map<std::string, cl::Program> programs;
  std::mutex programs_mutex;

  Traffic traffic;             ///< since it was opened; guarded by `notes_mutex`
  std::string running_kernel;  ///< the last that was queued; guarded by `notes_mutex`
  std::mutex notes_mutex;

  double milliseconds_to_open = 0;  ///< 0 again once a picture's statistics have told it

  /// The thread of startDevice. Last, so that it has ended before anything it works on goes.
  std::shared_future<void> opening;
};

/// All OpenCL devices of all platforms, in the order the runtime names them. Empty where there is none.
std::vector<DeviceDescription> listDevices();

/// Which of listDevices() a selector means. "": PoCL's first device where there is one, otherwise the first.
/// A number: that one. Anything else: the first whose name or platform contains it, case ignored. Throws
/// InputError if none fits and MachineError if there is no device at all. A suffix ",lanes=N" (1, 4, 8, 16)
/// is left to openDevice.
std::size_t selectDevice(std::span<const DeviceDescription> devices, const std::string& selector);

/// Opens the device that `selector` means, its lanes forced where the selector ends in ",lanes=N".
/// Throws as selectDevice does, and MachineError if the device fails.
void openDevice(const std::string& selector, Device& device);

/// The same in a thread of its own. Until awaitDevice() returns, `device` is the thread's.
void startDevice(const std::string& selector, Device& device);

/// Waits until the device is open. Throws what openDevice() threw. For a device that no thread opens it does
/// nothing.
void awaitDevice(const Device& device);

/// What buffers have cost the device so far.
Traffic trafficOf(Device& device);

/// Waits until everything queued is done. Throws MachineError where a kernel failed, naming the last that was
/// queued.
void finish(Device& device);

}  // namespace luciole
