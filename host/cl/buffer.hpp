#pragma once

#include <cstddef>
#include <memory>
#include <ranges>
#include <span>
#include <type_traits>

#include "base/index_range.hpp"
#include "cl/device.hpp"

// The one place where memory of a device is made and copied, and where its bytes are counted
// (Device::traffic). All functions throw MachineError where the device fails, also where it has too little
// memory.
namespace luciole {

/// An OpenCL buffer, not yet of any type. Copies are the same buffer.
struct DeviceMemory {
  cl::Buffer handle;
  std::shared_ptr<const void> loan;  ///< of the host's array, where the buffer lies in one
};

/// An array of T that kernels work on; of const T where they only read it. Copies are the same array.
/// - An owned one has memory of its own, which lasts as long as a copy or a queued kernel refers to it.
/// - A borrowed one lies in the host's array where device and host share memory, so that nothing is copied.
///   As long as there is a copy, that array must stay where it is, and the host may not change it. The last
///   copy waits for everything queued before it goes. So it is enough that the array was there first, also
///   when something is thrown. Where memory isn't shared, it is an owned one that starts as a copy.
template <class T>
struct Buffer {
  DeviceMemory memory;
  std::size_t count = 0;  ///< elements

  /// A kernel may always promise to write nothing.
  operator Buffer<const T>() const requires(!std::is_const_v<T>) { return {memory, count}; }
};

/// What the functions below do, in bytes. OpenCL has no empty buffers: those of 0 bytes get some.
namespace bytes {
DeviceMemory make(Device& device, std::size_t size);
DeviceMemory borrow(Device& device, const void* array, std::size_t size);
DeviceMemory borrowForOutput(Device& device, void* array, std::size_t size);
/// `whole`: the host's array that the buffer is a copy of. range: of bytes.
void write(Device& device, const DeviceMemory& memory, const void* whole, const IndexRange& range);
void read(Device& device, const DeviceMemory& memory, std::size_t offset, void* array, std::size_t size);
void copy(Device& device, const DeviceMemory& from, const DeviceMemory& to, std::size_t size);
void fill(Device& device, const DeviceMemory& memory, const void* element, std::size_t element_size,
          std::size_t size);
}  // namespace bytes

/// An array of the host's, by reference or as a span: none that is gone when a buffer is used.
template <class Array>
concept HostArray = std::ranges::contiguous_range<Array> && std::ranges::borrowed_range<Array>;

template <HostArray Array>
using ElementOf = std::remove_reference_t<std::ranges::range_reference_t<Array>>;

/// An owned buffer, its content undefined.
template <class T>
Buffer<T> makeBuffer(Device& device, std::size_t count) {
  return {bytes::make(device, count * sizeof(T)), count};
}

/// The values of an array, to read.
template <HostArray Array>
Buffer<const ElementOf<Array>> borrowed(Device& device, Array&& array) {
  const std::span values(array);
  return {bytes::borrow(device, values.data(), values.size_bytes()), values.size()};
}

/// A buffer whose content download() brings to the array; what it starts as is undefined. The array is
/// undefined until then.
template <HostArray Array>
Buffer<ElementOf<Array>> borrowedForOutput(Device& device, Array&& array) {
  const std::span values(array);
  return {bytes::borrowForOutput(device, values.data(), values.size_bytes()), values.size()};
}

/// Makes an owned buffer, or none yet, hold `count` elements at the least. Where it has to grow its content
/// is lost.
template <class T>
void reserve(Device& device, std::size_t count, Buffer<T>& buffer) {
  if (buffer.memory.handle() && buffer.count >= count) return;
  buffer = {};  // first, so that both need not fit
  buffer = makeBuffer<T>(device, count);
}

/// Brings a buffer up to date with an array, which since the last time changed in the ranges `changed` and
/// perhaps grew. Where memory is shared it is borrowed from the array: giveBack() it before that changes
/// again. Otherwise it is owned, keeps its memory where that is large enough, and only the ranges are copied,
/// those at once that follow each other. May hold more elements than the array.
template <class T, HostArray Array>
void refresh(Device& device, Array&& array, std::span<const IndexRange> changed, Buffer<const T>& buffer) {
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

/// Drops a borrowed buffer, so that the host may change its array; an owned one stays as it is. refresh()
/// follows.
template <class T>
void giveBack(Buffer<T>& buffer) {
  if (buffer.memory.loan) buffer = {};
}

/// Writes `value` to every element.
template <class T>
void fill(Device& device, const Buffer<T>& buffer, const std::type_identity_t<T>& value) {
  bytes::fill(device, buffer.memory, &value, sizeof(T), buffer.count * sizeof(T));
}

/// The elements from `first` on, as many as `out` has, once everything queued is done. A borrowed buffer's
/// are there already where memory is shared and `out` is what it was borrowed from.
template <class T>
void download(Device& device, const Buffer<T>& buffer,
              std::span<std::remove_const_t<std::type_identity_t<T>>> out, std::size_t first = 0) {
  bytes::read(device, buffer.memory, first * sizeof(T), out.data(), out.size_bytes());
}

}  // namespace luciole
