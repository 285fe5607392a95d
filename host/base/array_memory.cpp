#include "luciole/array_memory.hpp"

#include <mutex>
#include <new>

#include "base/large_pages.hpp"
#include "base/machine_memory.hpp"

namespace luciole {
namespace {

constexpr std::size_t kCacheLine = 128, kLargePage = std::size_t(2) << 20, kAskedFor = std::size_t(32) << 20;
/// Bytes kept free for smaller arrays, which are not checked, and for memory that is allocated but not
/// touched yet.
constexpr std::size_t kReserve = std::size_t(64) << 20;

struct Block {
  std::size_t bytes;
  std::align_val_t alignment;
};

/// From half a large page on, whole large pages.
Block blockFor(std::size_t bytes) {
  if (bytes < kLargePage / 2) return {bytes, std::align_val_t(kCacheLine)};
  return {(bytes + kLargePage - 1) / kLargePage * kLargePage, std::align_val_t(kLargePage)};
}

void* allocateBlock(const Block& block) {
  void* memory = ::operator new(block.bytes, block.alignment);
  if (block.alignment == std::align_val_t(kLargePage)) askForLargePages(memory, block.bytes);
  return memory;
}

/// Writes to every page, so that the system commits the memory here rather than fails later.
void touchPages(void* memory, std::size_t bytes) {
  constexpr std::size_t kSmallestPage = 4096;
  for (std::size_t i = 0; i < bytes; i += kSmallestPage) static_cast<volatile char*>(memory)[i] = 0;
}

}  // namespace

void* allocateArray(std::size_t bytes) {
  const Block block = blockFor(bytes);
  if (block.bytes < bytes) throw std::bad_alloc();  // rounding up went beyond the largest size
  if (bytes < kAskedFor) return allocateBlock(block);
  // The system may promise more memory than it has, so large arrays are checked; that takes less time than
  // filling one. Where little is left, the pages are touched under the lock, so that two threads are not
  // promised the same memory.
  static std::mutex asking;
  const std::lock_guard lock(asking);
  requireMemory(double(bytes + kReserve), "an array, with a reserve,");
  void* memory = allocateBlock(block);
  if (double(bytes) > memoryRoom().bytes / 4) touchPages(memory, bytes);
  return memory;
}

void freeArray(void* memory, std::size_t bytes) { ::operator delete(memory, blockFor(bytes).alignment); }

}  // namespace luciole
