#include "cl/buffer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>
#include <vector>

#include "cl/command_trace.hpp"
#include "cl/device_error.hpp"
#include "cl/driver_call.hpp"
#include "luciole/array_memory.hpp"

namespace luciole {
namespace {

/// Host memory that a buffer owns. It is freed when OpenCL destroys the buffer.
struct OwnArray {
  void* memory;
  std::size_t bytes;
  explicit OwnArray(std::size_t size) : memory(allocateArray(size)), bytes(size) {}
  OwnArray(const OwnArray&) = delete;
  OwnArray& operator=(const OwnArray&) = delete;
  ~OwnArray() { freeArray(memory, bytes); }
};

void CL_CALLBACK freeOwnArray(cl_mem, void* array) { delete static_cast<OwnArray*>(array); }

/// Shared by the copies of a borrowed buffer. Its destructor waits for the queue, so that no queued command
/// uses the host's array afterwards.
struct Loan {
  cl::CommandQueue queue;

  explicit Loan(const cl::CommandQueue& lent_on) : queue(lent_on) {}
  ~Loan() {
    try {
      callDriver([&] { queue.finish(); });
    } catch (const cl::Error&) {
      // A queue that fails has stopped.
    }
  }
};

void count(OpenedDevice& device, std::uint64_t Traffic::*kind, std::size_t bytes) {
  const std::lock_guard lock(device.notes_mutex);
  device.traffic.*kind += bytes;
}

/// clCreateBuffer. Throws MachineError.
cl::Buffer create(OpenedDevice& device, cl_mem_flags flags, std::size_t size, void* array) {
  try {
    return callDriver([&] { return cl::Buffer(device.context, flags, size, array); });
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
}

/// A buffer in the host's array, for devices that share memory.
DeviceMemory inPlace(OpenedDevice& device, cl_mem_flags access, void* array, std::size_t size) {
  return {create(device, access | CL_MEM_USE_HOST_PTR, size, array), std::make_shared<Loan>(device.queue)};
}

}  // namespace

namespace bytes {

DeviceMemory make(OpenedDevice& device, std::size_t size) {
  size = std::max(size, sizeof(cl_float4));
  DeviceMemory memory;
  if (!device.shares_host_memory) {
    memory.handle = create(device, CL_MEM_READ_WRITE, size, nullptr);
  } else {
    try {
      // From allocateArray() instead of OpenCL, because it uses larger pages.
      auto array = std::make_unique<OwnArray>(size);
      memory.handle = create(device, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, size, array->memory);
      callDriver([&] { memory.handle.setDestructorCallback(freeOwnArray, array.get()); });
      static_cast<void>(array.release());  // freeOwnArray() has it now
    } catch (const std::bad_alloc&) {
      throw DeviceError(fmt::format("{}: out of memory", device.description.name), true);
    } catch (const cl::Error& error) {
      throw deviceError(error, device.description.name);
    }
  }
  count(device, &Traffic::bytes_made, size);
  return memory;
}

DeviceMemory borrow(OpenedDevice& device, const void* array, std::size_t size) {
  if (size == 0) return make(device, 0);
  void* const values = const_cast<void*>(array);
  if (device.shares_host_memory) return inPlace(device, CL_MEM_READ_ONLY, values, size);
  const TraceSpan span("upload", {{"bytes", std::int64_t(size)}});
  DeviceMemory memory{create(device, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, size, values), {}};
  count(device, &Traffic::bytes_made, size);
  count(device, &Traffic::bytes_up, size);
  return memory;
}

DeviceMemory borrowForOutput(OpenedDevice& device, void* array, std::size_t size) {
  if (size == 0 || !device.shares_host_memory) return make(device, size);
  return inPlace(device, CL_MEM_READ_WRITE, array, size);
}

void write(OpenedDevice& device, const DeviceMemory& memory, const void* whole, const IndexRange& range) {
  if (range.count == 0 || range.rows == 0) return;
  const char* const first = static_cast<const char*>(whole) + range.first;
  const std::size_t size = range.count * range.rows;
  try {
    queueCommand(device, "upload", {{"bytes", std::int64_t(size)}}, [&](cl::Event* event) {
      if (range.rows == 1) {
        device.queue.enqueueWriteBuffer(memory.handle, CL_TRUE, range.first, range.count, first, nullptr,
                                        event);
        return;
      }
      const std::array<std::size_t, 3> place{range.first % range.pitch, range.first / range.pitch, 0};
      device.queue.enqueueWriteBufferRect(memory.handle, CL_TRUE, place, place, {range.count, range.rows, 1},
                                          range.pitch, 0, range.pitch, 0, const_cast<void*>(whole), nullptr,
                                          event);
    });
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
  recordCommands(device);
  if (!device.shares_host_memory) count(device, &Traffic::bytes_up, size);
}

void read(OpenedDevice& device, const DeviceMemory& memory, std::size_t offset, void* array,
          std::size_t size) {
  if (size == 0) return;
  finish(device);  // apart from the copy, so that a kernel's error names the kernel
  try {
    if (memory.loan && memory.handle.getInfo<CL_MEM_HOST_PTR>() == array && offset == 0) {
      // The buffer lies in this very array. OpenCL guarantees its content there only after mapping.
      void* mapped = nullptr;
      queueCommand(device, "map", {{"bytes", std::int64_t(size)}}, [&](cl::Event* event) {
        mapped = device.queue.enqueueMapBuffer(memory.handle, CL_TRUE, CL_MAP_READ, 0, size, nullptr, event);
      });
      callDriver([&] { device.queue.enqueueUnmapMemObject(memory.handle, mapped); });
      finish(device);
      return;
    }
    queueCommand(device, "download", {{"bytes", std::int64_t(size)}}, [&](cl::Event* event) {
      device.queue.enqueueReadBuffer(memory.handle, CL_TRUE, offset, size, array, nullptr, event);
    });
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
  recordCommands(device);
  if (!device.shares_host_memory) count(device, &Traffic::bytes_down, size);
}

void copy(OpenedDevice& device, const DeviceMemory& from, const DeviceMemory& to, std::size_t size) {
  try {
    if (size == 0) return;
    queueCommand(device, "copy", {{"bytes", std::int64_t(size)}}, [&](cl::Event* event) {
      device.queue.enqueueCopyBuffer(from.handle, to.handle, 0, 0, size, nullptr, event);
    });
  } catch (const cl::Error& error) {
    throw deviceError(error, device.description.name);
  }
}

void fill(OpenedDevice& device, const DeviceMemory& memory, const void* element, std::size_t element_size,
          std::size_t size) {
  // Not by clEnqueueFillBuffer: Oclgrind 21.10 takes memory filled by it for uninitialized.
  const auto* const first = static_cast<const std::byte*>(element);
  std::vector<std::byte> values;
  while (values.size() < size) values.insert(values.end(), first, first + element_size);
  write(device, memory, values.data(), {0, size});
}

}  // namespace bytes
}  // namespace luciole
