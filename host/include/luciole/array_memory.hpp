#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace luciole {

/// Allocates `bytes` bytes, aligned to at least 128 bytes, so that a row of up to 16 floats is one aligned
/// load and OpenCL can use the memory in place. From 1 MiB on it is whole huge pages of 2 MiB where the
/// system has them, which take a tenth of the time to get. The content is undefined; the caller frees it with
/// freeArray. Throws std::bad_alloc, and MachineError for 32 MiB or more if the machine, the process's
/// control group or its resource limits leave less.
void* allocateArray(std::size_t bytes);

/// Frees what allocateArray(bytes) returned; `bytes` must be the same.
void freeArray(void* memory, std::size_t bytes);

/// allocateArray for containers.
template <class T>
struct ArrayAllocator {
  using value_type = T;
  ArrayAllocator() = default;
  template <class U>
  ArrayAllocator(const ArrayAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(allocateArray(n * sizeof(T))); }
  void deallocate(T* p, std::size_t n) { freeArray(p, n * sizeof(T)); }
  bool operator==(const ArrayAllocator&) const { return true; }
};

/// An ArrayAllocator that leaves new elements uninitialized: they must be written before they are read.
/// Resizing a container doesn't spend time on clearing them.
template <class T>
struct RawArrayAllocator : ArrayAllocator<T> {
  template <class U>
  struct rebind {
    using other = RawArrayAllocator<U>;
  };
  template <class U>
  void construct(U*) noexcept {}
  template <class U, class V>
  void construct(U* place, V&& value) {
    new (place) U(std::forward<V>(value));
  }
};

/// An array that OpenCL can use in place. New elements are not cleared.
template <class T>
using RawArray = std::vector<T, RawArrayAllocator<T>>;

}  // namespace luciole
