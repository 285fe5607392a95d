#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace luciole {

/// Makes a system call again where a signal interrupted it. Returns its result, < 0 for failure.
template <class Call>
auto retryInterrupted(Call call) {
  auto result = call();
  while (result < 0 && errno == EINTR) result = call();
  return result;
}

/// A file that appears at its path whole or not at all. Until putInPlace() it has no name, so nothing is left
/// of it however the program ends. Where the file system has no files without a name, it is a hidden file
/// beside the path, which the destructor removes, or cleanUp(). Symbolic links stay; the file that they lead
/// to is replaced.
/// The path "-" is standard output. Standard output, and any path that is neither a regular file nor a folder
/// (a device, a FIFO), is a stream: bytes reach it at once and in order. So is a text in memory.
class OutputFile {
 public:
  /// Opening a FIFO waits until it has a reader. Throws InputError (no such folder, read-only folder) or
  /// MachineError.
  explicit OutputFile(const std::string& path);
  /// Appends to a text, which must outlive it.
  explicit OutputFile(std::string& memory) : is_stream_(true), memory_(&memory) {}
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Whether it is a stream: each writeAt() must continue the one before.
  bool isStream() const { return is_stream_; }

  /// For another program that writes the file. Not for streams.
  int descriptor() const { return descriptor_; }

  /// Throws MachineError where the disk is full or `offset` is not a stream's end.
  void writeAt(std::uint64_t offset, std::span<const std::byte> bytes);

  /// The last call: syncs the file and gives it its name, in place of any file there. Throws MachineError
  /// (disk full) or InputError (the name can't be given).
  void putInPlace();

 private:
  void setHasName(bool has_name);
  std::string name() const { return path_ == "-" ? "standard output" : path_; }

  std::string path_;
  std::string place_;      ///< the path with its symbolic links followed
  std::string beside_;     ///< the hidden name beside it
  bool has_name_ = false;  ///< whether the hidden name exists, which cleanUp() knows then
  bool is_stream_ = false;
  std::string* memory_ = nullptr;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;  ///< bytes written
};

/// Throws MachineError where a picture of `bytes` bytes of pixels might become a file larger than this
/// process may write (RLIMIT_FSIZE). Beyond that limit some encoders lose pixels silently and others end the
/// program. No encoder needs more than twice the bytes of the pixels and a header. `name` is for the message.
void checkSizeLimit(std::uint64_t bytes, const std::string& name);

/// Whether the path is a stream (see OutputFile): "-", or something that exists and is neither a regular file
/// nor a folder.
bool leadsToStream(const std::string& path);

/// Where a file of this path lies or would lie: at the end of its symbolic links. Throws InputError where
/// they go round in circles.
std::string followLinks(const std::string& path);

/// The folder a file lies in, "." for a bare name.
std::string folderOf(const std::string& path);

/// The message of errno: why the last system call failed.
std::string systemReason();

}  // namespace luciole
