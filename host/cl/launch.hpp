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

/// What kernels call a type of the host. For types that they don't have, such as std::size_t, nothing
/// compiles.
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
constexpr std::string_view kernelTypeName<float>() {
  return "float";
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
constexpr std::string_view kernelTypeName<BoundTexel>() {
  return "BoundTexel";
}
template <>
constexpr std::string_view kernelTypeName<ShadeFrame>() {
  return "ShadeFrame";
}

/// An argument for launch(): the name that it has in the kernel's source, and its value.
struct KernelArgument {
  template <class T>
  KernelArgument(std::string_view name_, const T& value_) : name(name_), type(kernelTypeName<T>()) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto as_bytes = std::as_bytes(std::span(&value_, 1));
    value.assign(as_bytes.begin(), as_bytes.end());
  }

  /// A buffer that isn't there yet is a null pointer: the kernel may not look at it.
  template <class T>
  KernelArgument(std::string_view name_, const Buffer<T>& buffer)
      : name(name_),
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
  std::vector<std::byte> value;  ///< or a buffer's cl_mem
};

/// What a kernel's source says of an argument.
struct DeclaredArgument {
  std::string name, type;
  cl_kernel_arg_address_qualifier space;
  bool is_const;  ///< what it points to
};

/// A kernel, which knows its name and its arguments.
struct Kernel {
  cl::Kernel kernel;
  std::string name;
  std::vector<DeclaredArgument> arguments;
};

/// The kernel `name` of kernels/`file`, compiled for the device with LANES and the given -D options. A
/// program is built once a device. Throws MachineError with the compiler's first message, and where the
/// platform doesn't tell the kernel's arguments.
Kernel makeKernel(Device& device, const std::string& file, const char* name, const std::string& defines);

/// The same for any source text whose includes are in place (see expandKernelSource).
Kernel makeKernelFromSource(Device& device, const std::string& source, const char* name,
                            const std::string& defines);

/// How many work-items, in groups of how many: a power of two that divides them. Groups must mean nothing to
/// the kernel: they are smaller where the device takes no larger ones.
struct WorkItems {
  std::size_t items;
  std::size_t group = 1;
};

/// Queues a kernel with its arguments, in any order:
///     launch(device, kernel, {{"position", gbuffer.position}, {"plane_stride", stride}}, {.items = 64,
///     .group = 16});
/// The buffers may go before it has run. Throws std::logic_error where an argument of the kernel is missing,
/// another is given, one is given twice or is of another type than in the kernel's source, and where the
/// kernel may write to a buffer that is to be read only; MachineError where the device refuses an argument or
/// the launch. Both name the kernel and the argument.
void launch(Device& device, Kernel& kernel, const std::vector<KernelArgument>& arguments,
            const WorkItems& work);

}  // namespace luciole
