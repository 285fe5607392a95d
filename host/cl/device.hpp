#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "cl/program.hpp"

namespace luciole {

struct CommandTrace;

/// An OpenCL device as `luciole devices` lists it.
struct DeviceDescription {
  std::string platform;
  std::string name;
  std::string version;  ///< the driver's
  int lanes = 1;        ///< pixels a work-item shades: 16, 8, 4 or 1, by the device's native vector width
  unsigned compute_units = 0;  ///< work-groups that run at once; on a CPU, the device's threads
  /// The hash of what it makes of hard numbers (see ArithmeticCheck). Empty: nobody has asked.
  std::string arithmetic = {};
};

/// Bytes that buffers have copied and allocated. A device that shares the host's memory copies nothing.
struct Traffic {
  std::uint64_t bytes_up = 0;    ///< copied from the host to the device
  std::uint64_t bytes_down = 0;  ///< copied from the device to the host
  std::uint64_t bytes_made =
      0;  ///< allocated as memory of buffers; those that lie in an array of the host's don't count
};

/// An opened device, and what every launch on it needs.
struct Device {
  DeviceDescription description;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;           ///< in order; profiled only if a trace is recorded
  bool shares_host_memory = false;  ///< true on a CPU; not to be changed once a buffer is made
  /// The compiler's options by which it computes: what denormals are, and who rounds quotients
  /// (quotient.clh).
  std::string arithmetic;

  /// Programs built so far, by options and file or source; guarded by `programs_mutex`.
  std::map<std::string, Program> programs;
  std::mutex programs_mutex;
  /// The folder with their binaries (see program_cache.hpp). Empty where the platform keeps them itself.
  std::string program_cache;

  Traffic traffic;             ///< since it was opened; guarded by `notes_mutex`
  std::string running_kernel;  ///< the kernel queued last, for messages; guarded by `notes_mutex`
  /// Null unless a trace was recorded when the device was opened (see command_trace.hpp); what it points to
  /// is guarded by `notes_mutex`.
  std::shared_ptr<CommandTrace> trace;
  std::mutex notes_mutex;

  double milliseconds_to_open = 0;  ///< the first picture's statistics take it and set it to 0

  /// The thread of startDevice. The last member, so that it is destroyed first and waits for the thread.
  std::shared_future<void> opening;
};

/// All OpenCL devices of all platforms, in the runtime's order. Empty if there is none. Throws MachineError
/// if this process may not take the memory that a platform needs.
std::vector<DeviceDescription> listDevices();

/// Which of listDevices() a selector means. "": PoCL's first device where there is one, otherwise the first.
/// A number: that one. Anything else: the first whose name or platform contains it, case ignored. Throws
/// InputError if none fits and MachineError if there is no device at all. A suffix ",lanes=N" (1, 4, 8, 16)
/// is left to openDevice.
std::size_t selectDevice(std::span<const DeviceDescription> devices, const std::string& selector);

/// Opens the device that `selector` means, for profiling if a trace is recorded. A selector that ends in
/// ",lanes=N" sets its lanes. Throws as selectDevice and listDevices do, InputError for other lanes than 1,
/// 4, 8 and 16, and MachineError if the device fails.
void openDevice(const std::string& selector, Device& device);

/// The selector that means all devices, where a command takes several.
constexpr const char* kAllDevices = "all";

/// openDevice(), and then `then` if there is one, in a thread of its own. Nobody else may use `device` until
/// awaitDevice() has returned.
void startDevice(const std::string& selector, Device& device, std::function<void()> then = {});

/// Waits until the device is open. Throws what that thread threw. For a device that no thread opens it does
/// nothing.
void awaitDevice(const Device& device);

/// The bytes that buffers have copied and allocated so far. Any thread may ask.
Traffic trafficOf(Device& device);

/// Waits until everything queued is done, and records it if there is a trace. Throws MachineError if a kernel
/// failed. The message names the kernel queued last: OpenCL doesn't tell which one it was.
void finish(Device& device);

}  // namespace luciole
