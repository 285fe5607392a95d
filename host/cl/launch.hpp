#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "cl/buffer.hpp"
#include "cl/device.hpp"
#include "kernels/shared.h"

namespace luciole {

/// The name in kernels of a type of the host. It doesn't compile for types that kernels don't have, such as
/// std::size_t.
template <class T>
constexpr std::string_view kernelTypeName() = delete;
template <>
constexpr std::string_view kernelTypeName<int>() {
  return "int";
}
template <>
constexpr std::string_view kernelTypeName<uint>() {
  return "uint";
}
template <>
constexpr std::string_view kernelTypeName<unsigned char>() {
  return "uchar";
}
template <>
constexpr std::string_view kernelTypeName<float>() {
  return "float";
}
template <>
constexpr std::string_view kernelTypeName<double>() {
  return "double";
}
template <>
constexpr std::string_view kernelTypeName<float4>() {
  return "float4";
}
template <>
constexpr std::string_view kernelTypeName<ListEntry>() {
  return "ListEntry";
}
template <>
constexpr std::string_view kernelTypeName<ShadeLight>() {
  return "ShadeLight";
}
template <>
constexpr std::string_view kernelTypeName<ShadowMap>() {
  return "ShadowMap";
}
template <>
constexpr std::string_view kernelTypeName<ShadowFace>() {
  return "ShadowFace";
}
template <>
constexpr std::string_view kernelTypeName<ShadowTexel>() {
  return "ShadowTexel";
}
template <>
constexpr std::string_view kernelTypeName<BeamLight>() {
  return "BeamLight";
}
template <>
constexpr std::string_view kernelTypeName<TilePairs>() {
  return "TilePairs";
}
template <>
constexpr std::string_view kernelTypeName<HoleTriangle>() {
  return "HoleTriangle";
}
template <>
constexpr std::string_view kernelTypeName<ShadeFrame>() {
  return "ShadeFrame";
}
template <>
constexpr std::string_view kernelTypeName<ScreenFrame>() {
  return "ScreenFrame";
}
template <>
constexpr std::string_view kernelTypeName<CullFrame>() {
  return "CullFrame";
}
template <>
constexpr std::string_view kernelTypeName<SurfaceFrame>() {
  return "SurfaceFrame";
}
template <>
constexpr std::string_view kernelTypeName<BeamFrame>() {
  return "BeamFrame";
}
template <>
constexpr std::string_view kernelTypeName<ShadeTilesFrame>() {
  return "ShadeTilesFrame";
}
template <>
constexpr std::string_view kernelTypeName<ClusterFrame>() {
  return "ClusterFrame";
}

/// An argument for launch(): the name that it has in the kernel's source, and its value.
struct KernelArgument {
  template <class T>
  KernelArgument(std::string_view argument_name, const T& argument_value)
      : name(argument_name), type(kernelTypeName<T>()) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto as_bytes = std::as_bytes(std::span(&argument_value, 1));
    value.assign(as_bytes.begin(), as_bytes.end());
  }

  /// A buffer without memory is passed as a null pointer, which the kernel may not access.
  template <class T>
  KernelArgument(std::string_view argument_name, const Buffer<T>& buffer)
      : name(argument_name),
        type(std::string(kernelTypeName<std::remove_const_t<T>>()) + "*"),
        is_buffer(true),
        is_read_only(std::is_const_v<T>) {
    const cl_mem handle = buffer.memory.handle();
    const auto as_bytes = std::as_bytes(std::span(&handle, 1));
    value.assign(as_bytes.begin(), as_bytes.end());
  }

  std::string_view name;
  std::string type;  ///< as clGetKernelArgInfo names it: float*
  bool is_buffer = false, is_read_only = false;
  std::vector<std::byte> value;  ///< its bytes; of a buffer, those of its cl_mem
};

/// A kernel with its name, its arguments in order, and the -D options that it was compiled with.
struct Kernel {
  cl::Kernel kernel;
  std::string name;
  std::vector<DeclaredArgument> arguments;
  std::string defines;
};

/// The kernel `name` of kernels/`file`, compiled with the device's LANES and the -D options in `defines`. A
/// program is built only once for a device and the same options. Any thread may call it. Throws MachineError
/// with the first 1000 characters of the compiler's log if it doesn't compile, if memory is short, and if the
/// platform doesn't tell the kernel's arguments; std::logic_error for a file that isn't there. user_text: see
/// kernelSource(), of shaderProgram(); InputError if it is why the program doesn't compile.
Kernel makeKernel(OpenedDevice& device, const std::string& file, const char* name, const std::string& defines,
                  const std::string& user_text = {});

/// The same for any source text whose includes are in place (see expandKernelSource). user_text: that it
/// contains.
Kernel makeKernelFromSource(OpenedDevice& device, const std::string& source, const char* name,
                            const std::string& defines, const std::string& user_text = {});

/// Whether makeKernel() would find this program's machine code on disk, as far as is known. Of platforms
/// other than PoCL it isn't known, and taken so. Throws cl::Error.
bool isCompiled(const OpenedDevice& device, const std::string& file, const std::string& defines,
                const std::string& user_text = {});

/// Whether a program that PoCL hasn't kept is compiled without optimization.
bool compilesQuickly(const OpenedDevice& device);

/// Whether any program of the device was compiled quickly.
bool hasQuickPrograms(OpenedDevice& device);

/// Forgets programs that were compiled quickly, and those with texts of users: they are compiled again, or
/// come from PoCL's cache, optimized if they are there so. No kernel may run.
void dropPassingPrograms(OpenedDevice& device);

/// Call it when all kernels of the device's programs have run: notes that PoCL has their machine code now.
void listCompiled(OpenedDevice& device);

/// The size of a launch. A kernel's result may not depend on `group`, because it is halved until the device
/// takes it.
struct WorkItems {
  std::size_t items;
  std::size_t group = 1;  ///< work-items in a group: a power of two that divides `items`
};

/// Queues a kernel with its arguments, in any order:
///     launch(device, kernel, {{"position", gbuffer.position}, {"plane_stride", stride}}, {.items = 64,
///     .group = 16});
/// Work-items are launched in equal rows, so a kernel counts them by work_item() of kernels/lanes.clh.
/// It doesn't wait for the kernel. Buffers may be destroyed before it has run: OpenCL keeps their memory.
/// 0 work-items launch nothing. Throws
/// - std::logic_error if an argument of the kernel is missing, is given twice, isn't one of its arguments or
///   has another type than in its source, and if the kernel may write to a Buffer of const elements;
/// - MachineError if the device refuses an argument or the launch.
/// Both messages name the kernel and the argument.
void launch(OpenedDevice& device, Kernel& kernel, const std::vector<KernelArgument>& arguments,
            const WorkItems& work);

}  // namespace luciole
