#include "cl/launch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/quiet_stderr.hpp"
#include "cl/build_program.hpp"
#include "cl/command_trace.hpp"
#include "cl/device_error.hpp"
#include "cl/driver_call.hpp"
#include "cl/kernel_source.hpp"
#include "cl/pocl_cache.hpp"
#include "luciole/error.hpp"
#include "shaders/shader_text.hpp"

namespace luciole {
namespace {

/// The compiler's option for a program that is compiled quickly.
constexpr const char* kQuickly = " -cl-opt-disable";

/// The compiler's options for any program with these defines.
std::string optionsFor(const OpenedDevice& device, const std::string& defines) {
  // -w: clang warns about vectors wider than the processor's, and prints the number of warnings to standard
  // error.
  return fmt::format("-cl-std=CL1.2 -w {} -cl-kernel-arg-info -DLANES={} {}", device.arithmetic,
                     device.description.lanes, defines);
}

/// Builds a program, quickly if the device says so and PoCL hasn't kept it optimized.
Program build(const OpenedDevice& device, const std::string& source, std::string options) {
  if (device.pocl_cache.empty()) return buildProgram(device, source, options);
  std::string description = describeProgram(device, source, options);
  bool is_listed = isListed(device.pocl_cache, description);
  const bool quickly = compilesQuickly(device) && !is_listed;
  if (quickly) {
    options += kQuickly;
    description = describeProgram(device, source, options);
    is_listed = isListed(device.pocl_cache, description);
  }
  Program program = buildProgram(device, source, options);
  if (!is_listed) program.unlisted = std::move(description);
  program.is_quick = quickly;
  return program;
}

/// The kernel `name` of the program with this key and these defines. A program that isn't there yet is built
/// from what source() returns. user_text: that it contains.
template <class Source>
Kernel makeKernelOf(OpenedDevice& device, const std::string& key, const char* name,
                    const std::string& defines, const std::string& user_text, Source&& source) {
  const std::lock_guard lock(device.programs_mutex);
  try {
    const std::string options = optionsFor(device, defines);
    auto place = device.programs.find(options + key);
    if (place == device.programs.end()) {
      const TraceSpan span("build program", {{"kernel", name}, {"defines", defines}});
      // The compiler itself counts errors on standard error.
      std::optional<QuietStderr> quiet;
      if (!user_text.empty() && device.owns_stderr) quiet.emplace();
      place = device.programs.emplace(options + key, build(device, source(), options)).first;
      place->second.is_of_a_user = !user_text.empty();
    }
    const Program& program = place->second;
    const cl::Kernel kernel = callDriver([&] { return cl::Kernel(program.program, name); });
    const auto known = program.arguments.find(name);
    return {kernel, name, known == program.arguments.end() ? declaredArguments(kernel) : known->second,
            defines};
  } catch (const cl::BuildError& error) {
    if (error.err() != CL_BUILD_PROGRAM_FAILURE)
      throw deviceError(error, fmt::format("{}: kernel '{}'", device.description.name, name));
    std::string log;
    for (const auto& [where, text] : error.getBuildLog()) log += text;
    if (!user_text.empty()) throw InputError(shaderError(log, user_text));
    std::replace(log.begin(), log.end(), '\n', ' ');
    throw MachineError(fmt::format("{}: kernel '{}' does not compile: {}", device.description.name, name,
                                   log.substr(0, 1000)));
  } catch (const cl::Error& error) {
    if (error.err() == CL_KERNEL_ARG_INFO_NOT_AVAILABLE)
      throw MachineError(fmt::format(
          "{}: this OpenCL driver doesn't tell what the arguments of kernel '{}' are called, by which "
          "they are set (CL_KERNEL_ARG_INFO_NOT_AVAILABLE): try another driver or device",
          device.description.name, name));
    throw deviceError(error, fmt::format("{}: kernel '{}'", device.description.name, name));
  }
}

/// The reason why an argument can't have this value, for a message; empty if it can.
std::string argumentFault(const DeclaredArgument& declared, const KernelArgument& given) {
  if (declared.space == CL_KERNEL_ARG_ADDRESS_LOCAL) return "is in local memory, where launch() puts nothing";
  if (declared.type != given.type) return fmt::format("is a {}, not a {}", declared.type, given.type);
  const bool writes = declared.space == CL_KERNEL_ARG_ADDRESS_GLOBAL && !declared.is_const;
  if (writes && given.is_read_only) return "isn't const, but the buffer may only be read";
  return "";
}

/// The index among the kernel's arguments for each given one. Throws std::logic_error if they don't match
/// (see launch()).
std::vector<cl_uint> matchArguments(const Kernel& kernel, const std::vector<KernelArgument>& given) {
  const auto refuse = [&](std::string_view argument, const std::string& why) {
    throw std::logic_error(fmt::format("kernel '{}', argument '{}' {}", kernel.name, argument, why));
  };
  std::vector<cl_uint> places;
  for (const KernelArgument& argument : given) {
    const auto found = std::find_if(kernel.arguments.begin(), kernel.arguments.end(),
                                    [&](const DeclaredArgument& one) { return one.name == argument.name; });
    if (found == kernel.arguments.end()) refuse(argument.name, "is none of its arguments");
    const auto place = cl_uint(found - kernel.arguments.begin());
    if (std::find(places.begin(), places.end(), place) != places.end())
      refuse(argument.name, "is given twice");
    if (const std::string why = argumentFault(*found, argument); !why.empty()) refuse(argument.name, why);
    places.push_back(place);
  }
  for (cl_uint i = 0; i < kernel.arguments.size(); ++i)
    if (std::find(places.begin(), places.end(), i) == places.end())
      refuse(kernel.arguments[i].name, "is missing");
  return places;
}

/// The number of equal rows in which so many groups of work-items are launched. PoCL compiles a kernel once
/// more where a row has 65,536 work-items or more, so rows are shorter if the groups can be divided so.
std::size_t rowsOf(std::size_t groups, std::size_t group) {
  constexpr std::size_t kLongestRow = 65'535;
  for (std::size_t rows = (groups * group + kLongestRow - 1) / kLongestRow; rows <= kLongestRow; ++rows)
    if (groups % rows == 0) return rows;
  return 1;
}

}  // namespace

Kernel makeKernel(OpenedDevice& device, const std::string& file, const char* name, const std::string& defines,
                  const std::string& user_text) {
  return makeKernelOf(device, file + user_text, name, defines, user_text,
                      [&] { return kernelSource(file, user_text); });
}

Kernel makeKernelFromSource(OpenedDevice& device, const std::string& source, const char* name,
                            const std::string& defines, const std::string& user_text) {
  return makeKernelOf(device, source, name, defines, user_text, [&] { return source; });
}

bool isCompiled(const OpenedDevice& device, const std::string& file, const std::string& defines,
                const std::string& user_text) {
  if (device.pocl_cache.empty()) return true;
  const std::string source = kernelSource(file, user_text), options = optionsFor(device, defines);
  const auto is_kept = [&](const std::string& with) {
    return isListed(device.pocl_cache, describeProgram(device, source, with));
  };
  return is_kept(options) || (compilesQuickly(device) && is_kept(options + kQuickly));
}

bool compilesQuickly(const OpenedDevice& device) { return device.compiles_quickly || !device.optimizes; }

bool hasQuickPrograms(OpenedDevice& device) {
  const std::lock_guard lock(device.programs_mutex);
  return std::any_of(device.programs.begin(), device.programs.end(),
                     [](const auto& one) { return one.second.is_quick; });
}

void dropPassingPrograms(OpenedDevice& device) {
  const std::lock_guard lock(device.programs_mutex);
  std::erase_if(device.programs,
                [](const auto& one) { return one.second.is_quick || one.second.is_of_a_user; });
  device.ready.clear();
}

void listCompiled(OpenedDevice& device) {
  const std::lock_guard lock(device.programs_mutex);
  std::vector<std::string> compiled;
  for (auto& [key, program] : device.programs)
    if (!program.unlisted.empty()) compiled.push_back(std::exchange(program.unlisted, ""));
  if (!compiled.empty()) addToList(device.pocl_cache, compiled);
}

void launch(OpenedDevice& device, Kernel& kernel, const std::vector<KernelArgument>& arguments,
            const WorkItems& work) {
  const std::vector<cl_uint> places = matchArguments(kernel, arguments);
  if (work.items == 0) return;
  std::string what = fmt::format("{}: kernel '{}'", device.description.name, kernel.name);
  try {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      try {
        callDriver(
            [&] { kernel.kernel.setArg(places[i], arguments[i].value.size(), arguments[i].value.data()); });
      } catch (const cl::Error&) {
        what += fmt::format(", argument '{}'", arguments[i].name);
        throw;
      }
    }
    const std::size_t most = callDriver([&] {
      return std::min(kernel.kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device.device),
                      device.device.getInfo<CL_DEVICE_MAX_WORK_ITEM_SIZES>().front());
    });
    std::size_t group = work.group;
    while (group > std::max<std::size_t>(most, 1)) group /= 2;
    queueCommand(device, kernel.name.c_str(),
                 {{"work_items", std::int64_t(work.items)},
                  {"group", std::int64_t(group)},
                  {"defines", kernel.defines}},
                 [&](cl::Event* event) {
                   const std::size_t rows = rowsOf(work.items / group, group);
                   device.queue.enqueueNDRangeKernel(kernel.kernel, cl::NullRange,
                                                     cl::NDRange(work.items / rows, rows),
                                                     cl::NDRange(group, 1), nullptr, event);
                 });
  } catch (const cl::Error& error) {
    throw deviceError(error, what);
  }
  const std::lock_guard lock(device.notes_mutex);
  device.running_kernel = kernel.name;
}

}  // namespace luciole
