#pragma once

#include <isa-l/igzip_lib.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

// Only png_file.cpp includes this.
namespace luciole {

/// Compresses pieces of a stream (RFC 1951), which may be done side by side: each begins at a whole byte and
/// refers to no other. One after the other they are the stream.
class Deflate {
 public:
  /// small: by zlib's most thorough level, rather than by ISA-L, some 50 times as fast.
  explicit Deflate(bool small);

  /// Appends to `out`. is_last: this piece ends the stream. Throws MachineError.
  void append(std::span<const std::uint8_t> piece, bool is_last, std::vector<std::uint8_t>& out);

 private:
  bool small_;
  std::unique_ptr<isal_zstream> stream_;  ///< ISA-L's
  std::vector<std::uint8_t> tables_;
};

}  // namespace luciole
