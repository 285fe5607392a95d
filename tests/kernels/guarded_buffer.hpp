#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cl/buffer.hpp"

namespace luciole::test {

/// A buffer on the device between two runs of guard words, each at least as long as the buffer. A kernel that
/// writes past either end changes them; one that reads there finds NaN. The content, too, is NaN until it is
/// written.
class GuardedBuffer {
 public:
  GuardedBuffer(OpenedDevice& device, std::size_t bytes)
      : guard_bytes_((bytes / kStep + 1) * kStep),
        words_((2 * guard_bytes_ + (bytes / kStep + 1) * kStep) / sizeof(std::uint32_t)) {
    std::vector<std::uint32_t> words(words_, kGuard);
    whole_ = cl::Buffer(device.context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR,
                        words.size() * sizeof(std::uint32_t), words.data());
    // OpenCL has no empty buffers; a word of the second guard is what a kernel may then have.
    const cl_buffer_region region{guard_bytes_, std::max(bytes, std::size_t(1))};
    part_ = whole_.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region);
    end_ = guard_bytes_ + bytes;
  }
  GuardedBuffer(OpenedDevice& device, std::span<const std::byte> content)
      : GuardedBuffer(device, content.size()) {
    if (!content.empty()) device.queue.enqueueWriteBuffer(part_, CL_TRUE, 0, content.size(), content.data());
  }

  /// For launch(). It belongs to this.
  template <class Element>
  Buffer<Element> as() const {
    return {{part_, {}}, (end_ - guard_bytes_) / sizeof(Element)};
  }

  /// Whether all that was launched before left the guard words alone.
  bool intact(OpenedDevice& device) const {
    std::vector<std::uint8_t> bytes(words_ * sizeof(std::uint32_t));
    device.queue.enqueueReadBuffer(whole_, CL_TRUE, 0, bytes.size(), bytes.data());
    const auto isGuard = [](std::uint8_t byte) { return byte == 0xff; };
    return std::all_of(bytes.begin(), bytes.begin() + guard_bytes_, isGuard) &&
           std::all_of(bytes.begin() + end_, bytes.end(), isGuard);
  }

 private:
  /// A part of a buffer begins at a multiple of CL_DEVICE_MEM_BASE_ADDR_ALIGN, which is a divisor of this.
  static constexpr std::size_t kStep = 4096;
  static constexpr std::uint32_t kGuard = 0xffffffff;  // as a float NaN

  std::size_t guard_bytes_;  ///< of the run in front, and where the buffer begins
  std::size_t words_;        ///< of all three
  std::size_t end_;          ///< of the buffer, in bytes
  cl::Buffer whole_, part_;
};

}  // namespace luciole::test
