#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace luciole {

/// A file that appears at its path whole or not at all: it has no name until it is put in place (where the
/// file system can't do that, a hidden one beside it), so however the program ends, nothing is left of it.
/// "-" is standard output, which gets what is written at once.
class OutputFile {
 public:
  /// Throws InputError (no such folder, read-only folder) or MachineError.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Throws MachineError: the disk is full, or an offset that standard output has passed already.
  void writeAt(std::uint64_t offset, std::span<const std::byte> bytes);

  /// The last call: gives the file its name, in place of any that was there.
  void putInPlace();

 private:
  bool isStandardOutput() const { return path_ == "-"; }
  std::string name() const { return isStandardOutput() ? "standard output" : path_; }

  std::string path_;
  std::string beside_;     ///< its name until it is in place
  bool has_name_ = false;  ///< whether there is a file of that name
  int descriptor_;
  std::uint64_t size_ = 0;  ///< bytes that standard output has got
};

/// Throws MachineError where a picture of `bytes` bytes might become a file larger than this process may
/// write. Some encoders then lose pixels without a word or end the program; none needs twice the bytes of the
/// pixels.
void checkSizeLimit(std::uint64_t bytes, const std::string& name);

/// The folder a file lies in, "." for a bare name.
std::string folderOf(const std::string& path);

/// The reason of the last system call to fail.
std::string systemReason();

}  // namespace luciole
