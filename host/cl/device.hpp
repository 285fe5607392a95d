#pragma once

#include <CL/opencl.hpp>
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

/// A device, opened, with what every launch on it needs.
struct Device {
  DeviceDescription description;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;  ///< in order
  bool shares_host_memory = false;

  /// Programs built so far, by options and file or source; guarded by `programs_mutex`.
  std::map<std::string, cl::Program> programs;
  std::mutex programs_mutex;

  double milliseconds_to_open = 0;  ///< 0 again once a picture's statistics have told it

  /// The thread of startDevice. Last, so that it has ended before anything it works on goes.
  std::shared_future<void> opening;
};

/// A kernel, which knows what it and its device are called.
struct Kernel {
  cl::Kernel kernel;
  std::string name, device_name;

  /// Throws MachineError where the device refuses the value, naming the kernel and the argument's number.
  template <class Value>
  void setArg(cl_uint number, const Value& value) {
    try {
      kernel.setArg(number, value);
    } catch (const cl::Error& error) {
      refuseArgument(number, error);
    }
  }

 private:
  [[noreturn]] void refuseArgument(cl_uint number, const cl::Error& error) const;
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

/// The kernel `name` of kernels/`file`, compiled for the device with LANES and the given -D options. A
/// program is built once a device. Throws MachineError with the compiler's first message.
Kernel makeKernel(Device& device, const std::string& file, const char* name, const std::string& defines);

/// The same for any source text whose includes are in place (see expandKernelSource).
Kernel makeKernelFromSource(Device& device, const std::string& source, const char* name,
                            const std::string& defines);

/// A buffer with these bytes to read from; shared in place where device and host share memory, so the bytes
/// must outlive it. Empty input makes a small buffer, as OpenCL has no empty ones.
cl::Buffer inputBuffer(Device& device, const void* data, std::size_t bytes);
template <class Container>
cl::Buffer inputBuffer(Device& device, const Container& values) {
  return inputBuffer(device, values.data(), values.size() * sizeof(*values.data()));
}

/// A buffer on the device for `bytes` bytes, contents undefined. Throws MachineError where they don't fit.
cl::Buffer deviceBuffer(Device& device, std::size_t bytes);

/// A buffer for `bytes` bytes to write, which readBuffer() brings to `data`; in place where device and host
/// share memory, so `data` must outlive it.
cl::Buffer outputBuffer(Device& device, void* data, std::size_t bytes);

/// The same, but it starts as what `data` holds; bytes > 0.
cl::Buffer updateBuffer(Device& device, void* data, std::size_t bytes);

/// Copies `bytes` bytes of the buffer, from the byte `offset` on, to the host once everything queued is done.
void readBuffer(Device& device, const cl::Buffer& buffer, void* data, std::size_t bytes,
                std::size_t offset = 0);

/// Queues `items` work-items in groups of `group`, a power of two that divides them, or as many of them as
/// the device takes in a group for this kernel. Groups must mean nothing to the kernel.
void launch(Device& device, Kernel& kernel, std::size_t items, std::size_t group);

/// Waits until everything queued is done.
void finish(Device& device);

}  // namespace luciole
