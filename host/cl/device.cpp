#include "cl/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <memory>
#include <new>
#include <optional>
#include <thread>

#include "base/array_memory.hpp"
#include "base/error.hpp"
#include "base/machine_memory.hpp"
#include "cl/kernel_source.hpp"

namespace luciole {
namespace {

constexpr std::string_view kLanesSuffix = ",lanes=";

struct FoundDevice {
  cl::Platform platform;
  cl::Device device;
  DeviceDescription description;
};

/// OpenCL strings may carry their terminator and blanks along.
std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == '\0' || std::isspace(static_cast<unsigned char>(text.back()))))
    text.pop_back();
  return text;
}

int nativeLanes(const cl::Device& device) {
  if (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) return 1;
  const unsigned width = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
  return width >= 16 ? 16 : width >= 8 ? 8 : width >= 4 ? 4 : 1;
}

/// What a platform takes at the least with its compiler, a part of it when kernels are compiled. Measured
/// with PoCL 3.1 and no kernel in its cache: killed in a control group of 144 MiB, well in one of 160; ended
/// by itself or hung under `ulimit -v` of 720 MiB and `ulimit -d` of 320, well under 760 and 360, of which
/// this program and the stacks of a thread a core of the platform's and of ours took 130 and 40.
constexpr double kPlatformBytes = 192 << 20, kPlatformAddresses = 640 << 20, kPlatformData = 320 << 20;
/// Of that, what must be left when a program is compiled.
constexpr double kCompilerBytes = 64 << 20;

std::vector<FoundDevice> findDevices() {
  requireMemory(kPlatformBytes, "OpenCL");
  requireMappings(kPlatformAddresses, kPlatformData, 2 * std::thread::hardware_concurrency(), "OpenCL");
  std::vector<FoundDevice> found;
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {
    return found;  // the loader reports "no platform" as an error
  }
  for (const cl::Platform& platform : platforms) {
    std::vector<cl::Device> devices;
    try {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
      for (const cl::Device& device : devices)
        found.push_back(
            {platform,
             device,
             {trimmed(platform.getInfo<CL_PLATFORM_NAME>()), trimmed(device.getInfo<CL_DEVICE_NAME>()),
              trimmed(device.getInfo<CL_DRIVER_VERSION>()), nativeLanes(device)}});
    } catch (const cl::Error&) {
      continue;  // a platform without usable devices
    }
  }
  return found;
}

std::string lowered(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::optional<std::size_t> parseNumber(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Memory of ours that a buffer lies in.
struct HostArray {
  void* memory;
  std::size_t bytes;
  explicit HostArray(std::size_t size) : memory(allocateArray(size)), bytes(size) {}
  HostArray(const HostArray&) = delete;
  HostArray& operator=(const HostArray&) = delete;
  ~HostArray() { freeArray(memory, bytes); }
};

void CL_CALLBACK freeHostArray(cl_mem, void* array) { delete static_cast<HostArray*>(array); }

/// An error's name in the standard, or its number where it isn't one of OpenCL 1.2's.
std::string errorName(cl_int error) {
#define NAMED(name) \
  case name:        \
    return #name
  switch (error) {
    NAMED(CL_DEVICE_NOT_FOUND);
    NAMED(CL_DEVICE_NOT_AVAILABLE);
    NAMED(CL_COMPILER_NOT_AVAILABLE);
    NAMED(CL_MEM_OBJECT_ALLOCATION_FAILURE);
    NAMED(CL_OUT_OF_RESOURCES);
    NAMED(CL_OUT_OF_HOST_MEMORY);
    NAMED(CL_MEM_COPY_OVERLAP);
    NAMED(CL_BUILD_PROGRAM_FAILURE);
    NAMED(CL_MAP_FAILURE);
    NAMED(CL_MISALIGNED_SUB_BUFFER_OFFSET);
    NAMED(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST);
    NAMED(CL_KERNEL_ARG_INFO_NOT_AVAILABLE);
    NAMED(CL_INVALID_VALUE);
    NAMED(CL_INVALID_PLATFORM);
    NAMED(CL_INVALID_DEVICE);
    NAMED(CL_INVALID_CONTEXT);
    NAMED(CL_INVALID_QUEUE_PROPERTIES);
    NAMED(CL_INVALID_COMMAND_QUEUE);
    NAMED(CL_INVALID_HOST_PTR);
    NAMED(CL_INVALID_MEM_OBJECT);
    NAMED(CL_INVALID_BINARY);
    NAMED(CL_INVALID_BUILD_OPTIONS);
    NAMED(CL_INVALID_PROGRAM);
    NAMED(CL_INVALID_PROGRAM_EXECUTABLE);
    NAMED(CL_INVALID_KERNEL_NAME);
    NAMED(CL_INVALID_KERNEL_DEFINITION);
    NAMED(CL_INVALID_KERNEL);
    NAMED(CL_INVALID_ARG_INDEX);
    NAMED(CL_INVALID_ARG_VALUE);
    NAMED(CL_INVALID_ARG_SIZE);
    NAMED(CL_INVALID_KERNEL_ARGS);
    NAMED(CL_INVALID_WORK_DIMENSION);
    NAMED(CL_INVALID_WORK_GROUP_SIZE);
    NAMED(CL_INVALID_WORK_ITEM_SIZE);
    NAMED(CL_INVALID_GLOBAL_OFFSET);
    NAMED(CL_INVALID_EVENT_WAIT_LIST);
    NAMED(CL_INVALID_EVENT);
    NAMED(CL_INVALID_OPERATION);
    NAMED(CL_INVALID_BUFFER_SIZE);
    NAMED(CL_INVALID_GLOBAL_WORK_SIZE);
    NAMED(CL_INVALID_PROPERTY);
  }
#undef NAMED
  return fmt::format("OpenCL error {}", error);
}

MachineError deviceError(const cl::Error& error, const std::string& device) {
  if (error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE || error.err() == CL_OUT_OF_HOST_MEMORY ||
      error.err() == CL_OUT_OF_RESOURCES || error.err() == CL_INVALID_BUFFER_SIZE)
    return MachineError(
        fmt::format("{}: out of memory ({}: {})", device, error.what(), errorName(error.err())));
  return MachineError(fmt::format("{}: {} failed: {}", device, error.what(), errorName(error.err())));
}

}  // namespace

std::vector<DeviceDescription> listDevices() {
  std::vector<DeviceDescription> descriptions;
  for (FoundDevice& found : findDevices()) descriptions.push_back(std::move(found.description));
  return descriptions;
}

std::size_t selectDevice(std::span<const DeviceDescription> devices, const std::string& selector) {
  if (devices.empty())
    throw MachineError(
        "no OpenCL device: install one, for example PoCL for the CPU (apt install pocl-opencl-icd)");
  const std::string wanted = lowered(selector.substr(0, selector.find(kLanesSuffix)));
  if (wanted.empty()) {
    for (std::size_t i = 0; i < devices.size(); ++i)
      if (devices[i].platform == "Portable Computing Language") return i;
    return 0;
  }
  if (const auto number = parseNumber(wanted)) {
    if (*number < devices.size()) return *number;
    throw InputError(fmt::format("--device {}: there are {} devices, counted from 0 (see luciole devices)",
                                 selector, devices.size()));
  }
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (lowered(devices[i].platform + " " + devices[i].name).find(wanted) != std::string::npos) return i;
  throw InputError(
      fmt::format("--device {}: no device has this in its name (see luciole devices)", selector));
}

void openDevice(const std::string& selector, Device& device) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<FoundDevice> found = findDevices();
  std::vector<DeviceDescription> descriptions;
  for (const FoundDevice& one : found) descriptions.push_back(one.description);
  const FoundDevice& chosen = found[selectDevice(descriptions, selector)];
  device.description = chosen.description;
  if (const std::size_t suffix = selector.find(kLanesSuffix); suffix != std::string::npos) {
    const auto lanes = parseNumber(std::string_view(selector).substr(suffix + kLanesSuffix.size()));
    if (lanes != 1 && lanes != 4 && lanes != 8 && lanes != 16)
      throw InputError(fmt::format("--device {}: lanes must be 1, 4, 8 or 16", selector));
    device.description.lanes = static_cast<int>(*lanes);
  }
  try {
    device.device = chosen.device;
    device.context = cl::Context(chosen.device);
    device.queue = cl::CommandQueue(device.context, chosen.device);
    device.shares_host_memory = (chosen.device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
  device.milliseconds_to_open =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void startDevice(const std::string& selector, Device& device) {
  device.opening =
      std::async(std::launch::async, [selector, &device] { openDevice(selector, device); }).share();
}

void awaitDevice(const Device& device) {
  if (device.opening.valid()) device.opening.get();
}

namespace {

/// The kernel `name` of the program known by `key`, which is built from the source that source() gives where
/// it isn't there yet.
template <class Source>
Kernel makeKernelOf(Device& device, const std::string& key, const char* name, const std::string& defines,
                    Source&& source) {
  const std::lock_guard lock(device.programs_mutex);
  try {
    const std::string options = fmt::format("-cl-std=CL1.2 -cl-denorms-are-zero -DLANES={} {}",
                                            device.description.lanes, defines);
    auto place = device.programs.find(options + key);
    if (place == device.programs.end()) {
      requireMemory(kCompilerBytes, "compiling kernels");
      cl::Program program(device.context, source());
      program.build({device.device}, options.c_str());
      place = device.programs.emplace(options + key, std::move(program)).first;
    }
    return {cl::Kernel(place->second, name), name, device.description.name};
  } catch (const cl::BuildError& error) {
    std::string log;
    for (const auto& [where, text] : error.getBuildLog()) log += text;
    std::replace(log.begin(), log.end(), '\n', ' ');
    throw MachineError(fmt::format("{}: kernel '{}' does not compile: {}", device.description.name, name,
                                   log.substr(0, 1000)));
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
}

}  // namespace

void Kernel::refuseArgument(cl_uint number, const cl::Error& error) const {
  throw MachineError(fmt::format("{}: kernel '{}', argument {}: {} failed: {}", device_name, name, number,
                                 error.what(), errorName(error.err())));
}

Kernel makeKernel(Device& device, const std::string& file, const char* name, const std::string& defines) {
  return makeKernelOf(device, file, name, defines, [&] { return kernelSource(file); });
}

Kernel makeKernelFromSource(Device& device, const std::string& source, const char* name,
                            const std::string& defines) {
  return makeKernelOf(device, source, name, defines, [&] { return source; });
}

cl::Buffer inputBuffer(Device& device, const void* data, std::size_t bytes) {
  if (bytes == 0) return deviceBuffer(device, sizeof(cl_float4));
  try {
    const cl_mem_flags how = device.shares_host_memory ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR;
    return cl::Buffer(device.context, CL_MEM_READ_ONLY | how, bytes, const_cast<void*>(data));
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
}

cl::Buffer deviceBuffer(Device& device, std::size_t bytes) {
  bytes = std::max(bytes, sizeof(cl_float4));
  try {
    if (!device.shares_host_memory) return cl::Buffer(device.context, CL_MEM_READ_WRITE, bytes);
    // Our own memory, for its larger pages.
    auto array = std::make_unique<HostArray>(bytes);
    cl::Buffer buffer(device.context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, array->memory);
    buffer.setDestructorCallback(freeHostArray, array.get());
    array.release();
    return buffer;
  } catch (const std::bad_alloc&) {
    throw MachineError(fmt::format("{}: out of memory", device.description.name));
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
}

cl::Buffer outputBuffer(Device& device, void* data, std::size_t bytes) {
  if (!device.shares_host_memory || bytes == 0) return deviceBuffer(device, bytes);
  try {
    return cl::Buffer(device.context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, data);
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
}

cl::Buffer updateBuffer(Device& device, void* data, std::size_t bytes) {
  try {
    const cl_mem_flags how = device.shares_host_memory ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR;
    return cl::Buffer(device.context, CL_MEM_READ_WRITE | how, bytes, data);
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
}

void readBuffer(Device& device, const cl::Buffer& buffer, void* data, std::size_t bytes, std::size_t offset) {
  if (bytes == 0) return;
  try {
    if (buffer.getInfo<CL_MEM_HOST_PTR>() == data && offset == 0) {
      // The buffer is this very memory: mapping it is what makes its content the host's.
      void* mapped = device.queue.enqueueMapBuffer(buffer, CL_TRUE, CL_MAP_READ, 0, bytes);
      device.queue.enqueueUnmapMemObject(buffer, mapped);
      device.queue.finish();
      return;
    }
    device.queue.enqueueReadBuffer(buffer, CL_TRUE, offset, bytes, data);
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
}

void launch(Device& device, Kernel& kernel, std::size_t items, std::size_t group) {
  if (items == 0) return;
  try {
    const std::size_t most =
        std::min(kernel.kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device.device),
                 device.device.getInfo<CL_DEVICE_MAX_WORK_ITEM_SIZES>().front());
    while (group > std::max<std::size_t>(most, 1)) group /= 2;
    device.queue.enqueueNDRangeKernel(kernel.kernel, cl::NullRange, cl::NDRange(items), cl::NDRange(group));
  } catch (const cl::Error& error) {
    throw deviceError(error, fmt::format("{}: kernel '{}'", device.description.name, kernel.name));
  }
}

void finish(Device& device) {
  try {
    device.queue.finish();
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
}

}  // namespace luciole
