#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "cl/program.hpp"
#include "luciole/device.hpp"

namespace luciole {

struct CommandTrace;

/// An opened device and its OpenCL objects.
struct OpenedDevice {
  std::mutex use;  ///< held by a call of the library while it works on the device
  DeviceDescription description;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;           ///< in order; profiled only if a trace is recorded
  bool shares_host_memory = false;  ///< true on a CPU; not to be changed once a buffer is made
  /// The compiler's options for its arithmetic: whether denormals are flushed, and how quotients are rounded
  /// (quotient.clh).
  std::string arithmetic;

  /// Programs built so far, by options and file or source; guarded by `programs_mutex`.
  std::map<std::string, Program> programs;
  std::mutex programs_mutex;
  /// What compileKernels() has compiled; of the thread that compiles a picture's kernels.
  std::set<std::string> ready;
  /// The folder with their binaries (see program_cache.hpp). Empty where the platform keeps them itself.
  std::string program_cache;

  std::string selector;    ///< that it was opened by
  std::string pocl_cache;  ///< see poclCache(); empty for other platforms, and if PoCL keeps nothing
  /// Whether programs that PoCL hasn't kept are compiled without optimization. That takes a third of the time
  /// and gives the same bits, but they run some six times as long.
  bool compiles_quickly = false;
  /// False, by LUCIOLE_OPTIMIZE=0 in the environment: PoCL's programs are all compiled quickly.
  bool optimizes = true;
  /// Whether pictures are lit by the general program (generalFeatures), where it may take the place of their
  /// own.
  bool lights_generally = false;
  /// True by LUCIOLE_GENERAL=1 in the environment: all are.
  bool always_lights_generally = false;
  /// The program file whose command `compile` compiles for this device in a process of its own (see
  /// compile_helper.hpp); empty: none does.
  std::string helper;
  bool owns_stderr = false;          ///< this process may close it for a while (QuietStderr)
  bool makes_one_picture = false;    ///< which may be made by programs that are compiled quickly
  std::function<void()> self_check;  ///< called once, by the thread that compiles a picture's kernels
  std::function<void(const std::string&)> warn;  ///< called with what went wrong, but was made good
  std::vector<std::string> left_over;  ///< for the helper: programs to be optimized after that picture

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

/// Which of listDevices() a selector means. "": PoCL's first device where there is one, otherwise the first.
/// A number: that one. Anything else: the first whose name or platform contains it, case ignored. Throws
/// InputError if none fits and MachineError if there is no device at all. A suffix ",lanes=N" (1, 4, 8, 16)
/// is left to openDevice.
std::size_t selectDevice(std::span<const DeviceDescription> devices, const std::string& selector);

/// Opens the device that `selector` means, for profiling if a trace is recorded. A selector that ends in
/// ",lanes=N" sets its lanes. Throws as selectDevice and listDevices do, InputError for other lanes than 1,
/// 4, 8 and 16, and MachineError if the device fails.
void openDevice(const std::string& selector, OpenedDevice& device);

/// The selector that means all devices, where a command takes several.
constexpr const char* kAllDevices = "all";

/// Calls openDevice(), and then `then` if it is set, in a thread of its own. No other thread may use `device`
/// until awaitDevice() has returned.
void startDevice(const std::string& selector, OpenedDevice& device, std::function<void()> then = {});

/// Waits for the thread of startDevice(), if any. Throws what that thread threw.
void awaitDevice(const OpenedDevice& device);

/// The bytes that buffers have copied and allocated so far. Any thread may ask.
Traffic trafficOf(OpenedDevice& device);

/// The device inside the public class Device.
OpenedDevice& opened(Device& device);

/// Waits until everything queued is done, and records it if there is a trace. Throws MachineError if a kernel
/// failed. The message names the kernel queued last: OpenCL doesn't tell which one it was.
void finish(OpenedDevice& device);

}  // namespace luciole
