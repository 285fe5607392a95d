#include "base/array_memory.hpp"

#include <sys/mman.h>

#include <mutex>
#include <new>

#include "base/machine_memory.hpp"

namespace luciole {
namespace {

constexpr std::size_t kCacheLine = 128, kLargePage = std::size_t(2) << 20, kAskedFor = std::size_t(32) << 20;
/// Left for smaller arrays, which nobody asks for, and for those that were given out and not touched yet.
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

/// Large pages are a hint: where the system doesn't take it, pages are small.
void* allocateBlock(const Block& block) {
  void* memory = ::operator new(block.bytes, block.alignment);
#ifdef MADV_HUGEPAGE
  if (block.alignment == std::align_val_t(kLargePage)) madvise(memory, block.bytes, MADV_HUGEPAGE);
#endif
  return memory;
}

/// Makes the system keep what it has promised.
void touchPages(void* memory, std::size_t bytes) {
  constexpr std::size_t kSmallestPage = 4096;
  for (std::size_t i = 0; i < bytes; i += kSmallestPage) static_cast<volatile char*>(memory)[i] = 0;
}

}  // namespace

void* allocateArray(std::size_t bytes) {
  const Block block = blockFor(bytes);
  if (block.bytes < bytes) throw std::bad_alloc();  // rounding up went beyond the largest size
  if (bytes < kAskedFor) return allocateBlock(block);
  // What the system hands out may be more than it can keep. Memory this large takes longer to fill than
  // asking. Where little is left, two threads must not be promised the same.
  static std::mutex asking;
  const std::lock_guard lock(asking);
  requireMemory(double(bytes + kReserve), "an array, with a reserve,");
  void* memory = allocateBlock(block);
  if (double(bytes) > memoryRoom().bytes / 4) touchPages(memory, bytes);
  return memory;
}

void freeArray(void* memory, std::size_t bytes) { ::operator delete(memory, blockFor(bytes).alignment); }

}  // namespace luciole
