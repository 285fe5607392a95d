#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace luciole {

/// A file that appears at its path whole or not at all: it has no name until it is put in place (where the
/// file system can't do that, a hidden one beside it), so however the program ends, nothing is left of it.
/// Symbolic links stay, and what they lead to is replaced. "-" is standard output, and that and whatever else
/// is no regular file (a device, a FIFO) get what is written at once, from front to end.
class OutputFile {
 public:
  /// Waits for the reader of a FIFO. Throws InputError (no such folder, read-only folder) or MachineError.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Whether pieces must come in their order.
  bool isStream() const { return is_stream_; }

  /// Throws MachineError: the disk is full, or an offset that a stream has passed already.
  void writeAt(std::uint64_t offset, std::span<const std::byte> bytes);

  /// The last call: gives the file its name, in place of any that was there.
  void putInPlace();

 private:
  std::string name() const { return path_ == "-" ? "standard output" : path_; }

  std::string path_;
  std::string place_;      ///< where its links lead
  std::string beside_;     ///< its name until it is in place
  bool has_name_ = false;  ///< whether there is a file of that name
  bool is_stream_ = false;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;  ///< bytes that a stream has got
};

/// Throws MachineError where a picture of `bytes` bytes might become a file larger than this process may
/// write. Some encoders then lose pixels without a word or end the program; none needs twice the bytes of the
/// pixels.
void checkSizeLimit(std::uint64_t bytes, const std::string& name);

/// Whether writing to the path goes straight through: standard output ("-"), or what is there and is neither
/// a regular file nor a folder.
bool leadsToStream(const std::string& path);

/// Where a file of this path lies or would lie: at the end of its symbolic links. Throws InputError where
/// they go round in circles.
std::string followLinks(const std::string& path);

/// The folder a file lies in, "." for a bare name.
std::string folderOf(const std::string& path);

/// The reason of the last system call to fail.
std::string systemReason();

}  // namespace luciole
