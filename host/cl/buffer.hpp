#pragma once

#include <cstddef>
#include <memory>
#include <ranges>
#include <span>
#include <type_traits>

#include "base/index_range.hpp"
#include "cl/device.hpp"

// Only the functions here allocate and copy memory of a device, and count the bytes (Device::traffic). All of
// them throw MachineError if the device fails or has too little memory. Those that copy to or from the host
// wait for the copy.
namespace luciole {

/// An OpenCL buffer, not yet of any type. Copies are the same buffer.
struct DeviceMemory {
  cl::Buffer handle;
  std::shared_ptr<const void> loan;  ///< of a borrowed buffer in the host's array; else null
};

/// An array of T that kernels work on, or of const T that they only read. Copies are the same array.
/// - An owned one has memory of its own, which lasts as long as a copy or a queued kernel refers to it.
/// - A borrowed one lies in the host's array if device and host share memory, so that nothing is copied. As
///   long as a copy exists, the host's array must stay where it is and may not be changed. The last copy's
///   destructor waits for everything queued. So it is enough that the array is declared before the buffer,
///   also if something is thrown. If memory isn't shared, it is an owned one that starts as a copy.
template <class T>
struct Buffer {
  DeviceMemory memory;
  std::size_t count = 0;  ///< elements

  /// The same array for a kernel that only reads it.
  operator Buffer<const T>() const requires(!std::is_const_v<T>) { return {memory, count}; }
};

/// The functions below without types; sizes and offsets are in bytes. OpenCL has no empty buffers: those of 0
/// bytes get 16.
namespace bytes {
/// See makeBuffer().
DeviceMemory make(OpenedDevice& device, std::size_t size);
/// See borrowed().
DeviceMemory borrow(OpenedDevice& device, const void* array, std::size_t size);
/// See borrowedForOutput().
DeviceMemory borrowForOutput(OpenedDevice& device, void* array, std::size_t size);
/// Copies a range of bytes to the same place in the buffer. whole: the array that the buffer is a copy of.
void write(OpenedDevice& device, const DeviceMemory& memory, const void* whole, const IndexRange& range);
/// See download().
void read(OpenedDevice& device, const DeviceMemory& memory, std::size_t offset, void* array,
          std::size_t size);
/// Queues a copy of the first `size` bytes.
void copy(OpenedDevice& device, const DeviceMemory& from, const DeviceMemory& to, std::size_t size);
/// See fill().
void fill(OpenedDevice& device, const DeviceMemory& memory, const void* element, std::size_t element_size,
          std::size_t size);
}  // namespace bytes

/// An array of the host's, as an lvalue or a span. A temporary wouldn't outlive the call.
template <class Array>
concept HostArray = std::ranges::contiguous_range<Array> && std::ranges::borrowed_range<Array>;

template <HostArray Array>
using ElementOf = std::remove_reference_t<std::ranges::range_reference_t<Array>>;

/// An owned buffer, its content undefined.
template <class T>
Buffer<T> makeBuffer(OpenedDevice& device, std::size_t count) {
  return {bytes::make(device, count * sizeof(T)), count};
}

/// A borrowed buffer (see Buffer) of an array that kernels read.
template <HostArray Array>
Buffer<const ElementOf<Array>> borrowed(OpenedDevice& device, Array&& array) {
  const std::span values(array);
  return {bytes::borrow(device, values.data(), values.size_bytes()), values.size()};
}

/// A borrowed buffer that kernels write. It starts undefined. download() brings its content to the array,
/// which is undefined until then.
template <HostArray Array>
Buffer<ElementOf<Array>> borrowedForOutput(OpenedDevice& device, Array&& array) {
  const std::span values(array);
  return {bytes::borrowForOutput(device, values.data(), values.size_bytes()), values.size()};
}

/// Makes `buffer`, an owned one or one without memory yet, hold at least `count` elements. If it has to grow,
/// its content is lost.
template <class T>
void reserve(OpenedDevice& device, std::size_t count, Buffer<T>& buffer) {
  if (buffer.memory.handle() && buffer.count >= count) return;
  buffer = {};  // freed first, so that memory need not hold both
  buffer = makeBuffer<T>(device, count);
}

/// Brings a buffer up to date with an array that has changed in the ranges `changed` since the last time, and
/// perhaps grown.
/// - If memory is shared, the buffer is borrowed from the array: call giveBack() before the array changes
///   again.
/// - Otherwise it is owned, and keeps its memory if that is large enough; so it may hold more elements than
///   the array. Only the ranges are copied, adjacent ones by a single copy.
template <class T, HostArray Array>
void refresh(OpenedDevice& device, Array&& array, std::span<const IndexRange> changed,
             Buffer<const T>& buffer) {
  if (device.shares_host_memory) {
    buffer = borrowed(device, array);
    return;
  }
  const std::span values(array);
  if (!buffer.memory.handle() || buffer.count < values.size()) {
    const Buffer<const T> larger = makeBuffer<T>(device, values.size());
    if (buffer.memory.handle()) bytes::copy(device, buffer.memory, larger.memory, buffer.count * sizeof(T));
    buffer = larger;
  }
  const auto follows = [](const IndexRange& next, const IndexRange& range) {
    return range.rows == 1 && next.rows == 1 && next.first == range.first + range.count;
  };
  for (std::size_t i = 0; i < changed.size();) {
    IndexRange range = changed[i++];
    for (; i < changed.size() && follows(changed[i], range); ++i) range.count += changed[i].count;
    bytes::write(device, buffer.memory, values.data(),
                 {range.first * sizeof(T), range.count * sizeof(T), range.rows, range.pitch * sizeof(T)});
  }
}

/// Drops a borrowed buffer, so that the host may change its array. An owned one stays as it is. Call
/// refresh() before the buffer is used again.
template <class T>
void giveBack(Buffer<T>& buffer) {
  if (buffer.memory.loan) buffer = {};
}

/// Writes `value` to every element.
template <class T>
void fill(OpenedDevice& device, const Buffer<T>& buffer, const std::type_identity_t<T>& value) {
  bytes::fill(device, buffer.memory, &value, sizeof(T), buffer.count * sizeof(T));
}

/// Waits for everything queued, then copies as many elements as `out` has, from `first` on, to `out`. Nothing
/// is copied if `out` is the array that the buffer lies in.
template <class T>
void download(OpenedDevice& device, const Buffer<T>& buffer,
              std::span<std::remove_const_t<std::type_identity_t<T>>> out, std::size_t first = 0) {
  bytes::read(device, buffer.memory, first * sizeof(T), out.data(), out.size_bytes());
}

}  // namespace luciole
