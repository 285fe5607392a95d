#include "cl/build_program.hpp"

#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>

#include "base/machine_memory.hpp"
#include "cl/driver_call.hpp"
#include "cl/kernel_source.hpp"
#include "cl/pocl_cache.hpp"
#include "cl/program_cache.hpp"

namespace luciole {
namespace {

/// Platforms without our cache: two have a cache of their own, and Oclgrind, which interprets kernels to find
/// their mistakes, needs their source.
constexpr std::string_view kWithoutOurCache[] = {kPoclPlatform, "NVIDIA CUDA", "Oclgrind"};

/// Prefixes of environment variables that change what Intel's and PoCL's compilers make.
constexpr std::string_view kCompilerSettings[] = {"CL_CONFIG_", "IGC_", "POCL_EXTRA_BUILD_FLAGS",
                                                  "POCL_WORK_GROUP_METHOD"};

/// Bytes of memory that must be free when a program is compiled: the compiler's part of kPlatformBytes
/// (device.cpp), measured in the same way.
constexpr double kCompilerBytes = 64 << 20;

cl::Kernel kernelOf(const cl::Program& program, const char* name) {
  return callDriver([&] { return cl::Kernel(program, name); });
}

cl::Program built(const OpenedDevice& device, const std::string& source, const std::string& options) {
  const cl::Program program = callDriver([&] { return cl::Program(device.context, source); });
  callDriver([&] { program.build({device.device}, options.c_str()); });
  return program;
}

cl::Program compile(const OpenedDevice& device, const std::string& source, const std::string& options) {
  requireMemory(kCompilerBytes, "compiling kernels");
  if (device.description.platform == kPoclPlatform) {
    try {
      return built(device, kernelSource("builtins.clh") + source, options + " -D_OPENCL_H_");
    } catch (const cl::BuildError& error) {
      if (error.err() != CL_BUILD_PROGRAM_FAILURE) throw;
      // It has an error, or uses a builtin that builtins.clh doesn't declare. Try again with PoCL's own
      // header.
    }
  }
  return built(device, source, options);
}

/// The program of a cached binary. Empty if the driver rejects it, or if its kernels aren't those of the
/// cache entry.
std::optional<Program> restored(const OpenedDevice& device, KeptProgram kept, const std::string& options) {
  try {
    const cl::Program program = callDriver([&] {
      return cl::Program(device.context, {device.device}, cl::Program::Binaries{std::move(kept.binary)});
    });
    callDriver([&] { program.build({device.device}, options.c_str()); });
    for (const auto& [name, arguments] : kept.arguments)
      if (kernelOf(program, name.c_str()).getInfo<CL_KERNEL_NUM_ARGS>() != arguments.size())
        return std::nullopt;
    return Program{program, std::move(kept.arguments)};
  } catch (const cl::Error&) {
    return std::nullopt;
  }
}

/// The cache entry of a program for one device. Empty if OpenCL doesn't provide all of it.
std::optional<KeptProgram> toKeep(const cl::Program& program) {
  try {
    KeptProgram kept;
    kept.binary = callDriver([&] { return program.getInfo<CL_PROGRAM_BINARIES>().front(); });
    std::istringstream names(callDriver([&] { return program.getInfo<CL_PROGRAM_KERNEL_NAMES>(); }));
    for (std::string name; std::getline(names, name, ';');) {
      name = name.c_str();  // some platforms leave the terminator in the text
      kept.arguments[name] = declaredArguments(kernelOf(program, name.c_str()));
    }
    if (kept.binary.empty() || kept.arguments.empty()) return std::nullopt;
    return kept;
  } catch (const cl::Error&) {
    return std::nullopt;
  }
}

}  // namespace

std::string describeProgram(const OpenedDevice& device, const std::string& source,
                            const std::string& options) {
  const cl::Platform platform(device.device.getInfo<CL_DEVICE_PLATFORM>());
  std::ostringstream text;
  text << "Luciole " LUCIOLE_VERSION "\n"
       << platform.getInfo<CL_PLATFORM_NAME>() << '\n'
       << platform.getInfo<CL_PLATFORM_VERSION>() << '\n'
       << device.device.getInfo<CL_DEVICE_VENDOR>() << '\n'
       << device.device.getInfo<CL_DEVICE_NAME>() << '\n'
       << device.device.getInfo<CL_DEVICE_VERSION>() << '\n'
       << device.device.getInfo<CL_DRIVER_VERSION>() << '\n'
       << device.device.getInfo<CL_DEVICE_EXTENSIONS>()
       << '\n'
       // Devices of one name may differ in their instructions, as a virtual machine may be denied some.
       << device.device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_CHAR>() << ' '
       << device.device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>() << ' '
       << device.device.getInfo<CL_DEVICE_ADDRESS_BITS>() << '\n';
  std::vector<std::string> settings;
  for (char** setting = environ; *setting; ++setting)
    for (const std::string_view beginning : kCompilerSettings)
      if (std::string_view(*setting).starts_with(beginning)) settings.push_back(*setting);
  std::sort(settings.begin(), settings.end());
  for (const std::string& setting : settings) text << setting << '\n';
  text << options << '\n' << source;
  return text.str();
}

std::vector<DeclaredArgument> declaredArguments(const cl::Kernel& kernel) {
  std::vector<DeclaredArgument> arguments;
  callDriver([&] {
    const cl_uint count = kernel.getInfo<CL_KERNEL_NUM_ARGS>();
    for (cl_uint i = 0; i < count; ++i) {
      // Some platforms leave the terminator in the text.
      arguments.push_back(
          {kernel.getArgInfo<CL_KERNEL_ARG_NAME>(i).c_str(),
           kernel.getArgInfo<CL_KERNEL_ARG_TYPE_NAME>(i).c_str(),
           kernel.getArgInfo<CL_KERNEL_ARG_ADDRESS_QUALIFIER>(i),
           (kernel.getArgInfo<CL_KERNEL_ARG_TYPE_QUALIFIER>(i) & CL_KERNEL_ARG_TYPE_CONST) != 0});
    }
  });
  return arguments;
}

Program buildProgram(const OpenedDevice& device, const std::string& source, const std::string& options) {
  if (device.program_cache.empty()) return {compile(device, source, options), {}};
  const std::string description = describeProgram(device, source, options);
  if (std::optional<KeptProgram> kept = findProgram(device.program_cache, description))
    if (std::optional<Program> program = restored(device, std::move(*kept), options)) return *program;
  Program program{compile(device, source, options), {}};
  if (const std::optional<KeptProgram> kept = toKeep(program.program))
    keepProgram(device.program_cache, description, *kept);
  return program;
}

std::string programCacheOf(const std::string& platform) {
  const bool needs_none = std::find(std::begin(kWithoutOurCache), std::end(kWithoutOurCache), platform) !=
                          std::end(kWithoutOurCache);
  return needs_none ? "" : userProgramCache();
}

}  // namespace luciole
