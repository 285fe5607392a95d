#include "cl/device.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <new>
#include <optional>

#include "base/clock.hpp"
#include "base/machine_memory.hpp"
#include "base/threads.hpp"
#include "base/trace.hpp"
#include "cl/build_program.hpp"
#include "cl/command_trace.hpp"
#include "cl/device_error.hpp"
#include "cl/driver_call.hpp"
#include "cl/pocl_cache.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

constexpr std::string_view kLanesSuffix = ",lanes=";

struct FoundDevice {
  cl::Platform platform;
  cl::Device device;
  DeviceDescription description;
};

/// Some platforms' strings end with their terminator and blanks.
std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == '\0' || std::isspace(static_cast<unsigned char>(text.back()))))
    text.pop_back();
  return text;
}

/// The lanes that suit a device. Those of 8 floats, with AVX2, take two registers for 16 lanes: inner loops
/// take as long for a lane, and what is done once a row is done half as often.
int nativeLanes(const cl::Device& device) {
  if (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) return 1;
  const unsigned width = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
  return width >= 8 ? 16 : width >= 4 ? 4 : 1;
}

/// Bytes that a platform and its compiler take at least: resident, of address space, and of data segment. A
/// part of it is taken when kernels are compiled. Measured with PoCL 3.1 and an empty kernel cache:
/// - a control group of 144 MiB killed it, one of 160 MiB didn't;
/// - under `ulimit -v` of 720 MiB or `ulimit -d` of 320 MiB it aborted or hung, under 760 and 360 MiB it
///   worked. Of these, this program and the stacks of two threads a core, ours and the platform's, took 130
///   and 40 MiB.
constexpr double kPlatformBytes = 192 << 20, kPlatformAddresses = 640 << 20, kPlatformData = 320 << 20;

DeviceDescription describe(const cl::Platform& platform, const cl::Device& device) {
  return {trimmed(platform.getInfo<CL_PLATFORM_NAME>()), trimmed(device.getInfo<CL_DEVICE_NAME>()),
          trimmed(device.getInfo<CL_DRIVER_VERSION>()), nativeLanes(device),
          device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()};
}

/// Calls `install`(handler, more …) of a library that is loaded, if it has it.
template <class Handler, class... More>
void installHandler(void* library, const char* install, Handler handler, More... more) {
  if (void* const function = library ? dlsym(library, install) : nullptr)
    reinterpret_cast<void (*)(Handler, More...)>(function)(handler, more...);
}

/// LLVM, the compiler of PoCL and of others, writes lines and ends the process where malloc() fails in it, or
/// a file that it keeps can't be written. After this it throws, as it does where operator new fails in it.
/// Does nothing where no platform brought a shared library of LLVM along.
void letCompilersThrow() {
  static const bool is_done = [] {
    std::vector<std::string> libraries;
    dl_iterate_phdr(
        [](dl_phdr_info* object, std::size_t, void* names) {
          if (std::strstr(object->dlpi_name, "/libLLVM"))
            static_cast<std::vector<std::string>*>(names)->emplace_back(object->dlpi_name);
          return 0;
        },
        &libraries);
    for (const std::string& name : libraries) {
      void* const library = dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD);
      // llvm::install_bad_alloc_error_handler(void (*)(void*, const char*, bool), void*)
      installHandler(
          library, "_ZN4llvm31install_bad_alloc_error_handlerEPFvPvPKcbES0_",
          +[](void*, const char*, bool) { throw std::bad_alloc(); }, static_cast<void*>(nullptr));
      installHandler(
          library, "LLVMInstallFatalErrorHandler", +[](const char* why) {
            throw MachineError(fmt::format("the compiler of kernels gave up: {}", why));
          });
    }
    return true;
  }();
  static_cast<void>(is_done);
}

/// While one exists, what libraries do about signals that abort the process is undone at its end. LLVM's
/// handler, which a driver brings, returns to abort(), which then ends the process by itself.
class KeptAbortHandlers {
 public:
  KeptAbortHandlers() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], nullptr, &kept_[i]);
  }
  ~KeptAbortHandlers() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &kept_[i], nullptr);
  }
  KeptAbortHandlers(const KeptAbortHandlers&) = delete;
  KeptAbortHandlers& operator=(const KeptAbortHandlers&) = delete;

 private:
  static constexpr std::array kSignals{SIGABRT, SIGTRAP};
  std::array<struct sigaction, kSignals.size()> kept_{};
};

std::vector<FoundDevice> findDevices() {
  const KeptAbortHandlers kept;
  requireMemory(kPlatformBytes, "OpenCL");
  requireMappings(kPlatformAddresses, kPlatformData, 2 * threadCount(), "OpenCL");
  std::vector<FoundDevice> found;
  std::vector<cl::Platform> platforms;
  try {
    callDriver([&] { cl::Platform::get(&platforms); });
    letCompilersThrow();
  } catch (const cl::Error&) {
    return found;  // the loader reports "no platform" as an error
  }
  for (const cl::Platform& platform : platforms) {
    std::vector<cl::Device> devices;
    try {
      callDriver([&] { platform.getDevices(CL_DEVICE_TYPE_ALL, &devices); });
      for (const cl::Device& device : devices)
        found.push_back({platform, device, callDriver([&] { return describe(platform, device); })});
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
      if (devices[i].platform == kPoclPlatform) return i;
    return 0;
  }
  if (wanted == kAllDevices)
    throw InputError(fmt::format("device: {}: only render takes several devices", selector));
  if (const auto number = parseNumber(wanted)) {
    if (*number < devices.size()) return *number;
    throw InputError(
        fmt::format("device: {}: there are {} devices, counted from 0", selector, devices.size()));
  }
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (lowered(devices[i].platform + " " + devices[i].name).find(wanted) != std::string::npos) return i;
  throw InputError(fmt::format("device: {}: no device has this in its name", selector));
}

void openDevice(const std::string& selector, OpenedDevice& device) {
  const std::int64_t begin = nanosecondsSinceStart();
  const std::vector<FoundDevice> found = findDevices();
  std::vector<DeviceDescription> descriptions;
  for (const FoundDevice& one : found) descriptions.push_back(one.description);
  const FoundDevice& chosen = found[selectDevice(descriptions, selector)];
  device.description = chosen.description;
  device.selector = selector;
  const auto is_set = [](const char* name, std::string_view to) {
    const char* const value = std::getenv(name);
    return value && value == to;
  };
  device.optimizes = !is_set("LUCIOLE_OPTIMIZE", "0");
  device.always_lights_generally = is_set("LUCIOLE_GENERAL", "1");
  device.program_cache = programCacheOf(chosen.description.platform);
  if (chosen.description.platform == kPoclPlatform) device.pocl_cache = poclCache();
  if (const std::size_t suffix = selector.find(kLanesSuffix); suffix != std::string::npos) {
    const auto lanes = parseNumber(std::string_view(selector).substr(suffix + kLanesSuffix.size()));
    if (lanes != 1 && lanes != 4 && lanes != 8 && lanes != 16)
      throw InputError(fmt::format("device: {}: lanes must be 1, 4, 8 or 16", selector));
    device.description.lanes = static_cast<int>(*lanes);
  }
  try {
    device.device = chosen.device;
    device.context = callDriver([&] { return cl::Context(chosen.device); });
    const bool is_profiled = isTracing();
    device.queue = callDriver([&] {
      return cl::CommandQueue(device.context, chosen.device, is_profiled ? CL_QUEUE_PROFILING_ENABLE : 0);
    });
    if (is_profiled)
      device.trace = std::make_shared<CommandTrace>(CommandTrace{deviceTrack(device.description.name)});
    const bool rounds_quotients =
        (chosen.device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
    device.arithmetic = std::string("-cl-denorms-are-zero ") +
                        (rounds_quotients ? "-cl-fp32-correctly-rounded-divide-sqrt" : "-DOWN_QUOTIENTS");
    device.shares_host_memory = (chosen.device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
  const std::int64_t end = nanosecondsSinceStart();
  device.milliseconds_to_open = 1e-6 * double(end - begin);
  traceEvent("open device", kTraceStage, begin, end);
}

void startDevice(const std::string& selector, OpenedDevice& device, std::function<void()> then) {
  device.opening = std::async(std::launch::async, [selector, &device, then = std::move(then)] {
                     const TraceThread thread("device opener");
                     openDevice(selector, device);
                     if (then) then();
                   }).share();
}

void awaitDevice(const OpenedDevice& device) {
  if (device.opening.valid()) device.opening.get();
}

Traffic trafficOf(OpenedDevice& device) {
  const std::lock_guard lock(device.notes_mutex);
  return device.traffic;
}

void finish(OpenedDevice& device) {
  try {
    callDriver([&] { device.queue.finish(); });
  } catch (const cl::Error& error) {
    const std::lock_guard lock(device.notes_mutex);
    throw deviceError(
        error, fmt::format("{}: kernel '{}' or one before", device.description.name, device.running_kernel));
  }
  recordCommands(device);
}

Device Device::open(const std::string& selector) {
  auto opened = std::make_unique<OpenedDevice>();
  openDevice(selector, *opened);
  return Device(std::move(opened));
}

Device::Device(std::unique_ptr<OpenedDevice> opened) : opened_(std::move(opened)) {}
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

const DeviceDescription& Device::description() const { return opened_->description; }

OpenedDevice& opened(Device& device) { return *device.opened_; }

}  // namespace luciole
