#pragma once

#include <cstddef>
#include <new>
#include <utility>

namespace luciole {

/// Memory for arrays of so many bytes, on whole cache lines, so that a row of up to 16 float lanes is one
/// aligned load and OpenCL can use the memory in place. Where it is much, it comes in the system's larger
/// kind of pages, which take a tenth of the time to hand out. Throws std::bad_alloc, and MachineError
/// where so much is more than this process may take.
void* allocateArray(std::size_t bytes);

/// Frees what allocateArray(bytes) gave.
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

/// The same for elements that are written before they are read: resizing a container leaves them as they are.
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

}  // namespace luciole
