#include "base/array_memory.hpp"

#include <sys/mman.h>

#include <new>

#include "base/machine_memory.hpp"

namespace luciole {
namespace {

constexpr std::size_t kCacheLine = 128, kLargePage = std::size_t(2) << 20, kAskedFor = std::size_t(32) << 20;

struct Block {
  std::size_t bytes;
  std::align_val_t alignment;
};

/// From half a large page on, whole large pages.
Block blockFor(std::size_t bytes) {
  if (bytes < kLargePage / 2) return {bytes, std::align_val_t(kCacheLine)};
  return {(bytes + kLargePage - 1) / kLargePage * kLargePage, std::align_val_t(kLargePage)};
}

}  // namespace

void* allocateArray(std::size_t bytes) {
  const Block block = blockFor(bytes);
  if (block.bytes < bytes) throw std::bad_alloc();  // rounding up went beyond the largest size
  // What the system hands out may be more than it can keep. Memory this large takes longer to fill than
  // asking.
  if (bytes >= kAskedFor) requireMemory(double(bytes), "an array");
  void* memory = ::operator new(block.bytes, block.alignment);
#ifdef MADV_HUGEPAGE
  // A hint: where the system doesn't take it, pages are small.
  if (block.alignment == std::align_val_t(kLargePage)) madvise(memory, block.bytes, MADV_HUGEPAGE);
#endif
  return memory;
}

void freeArray(void* memory, std::size_t bytes) { ::operator delete(memory, blockFor(bytes).alignment); }

}  // namespace luciole
