#pragma once

#include <string>

namespace luciole {

/// Claims frames, so that no two runs make the same pictures, as runs would that were given the same shard. A
/// claim holds until the run ends, in whatever way. It is a lock on the frame's byte of a hidden, empty file
/// beside the frames, `.PATTERN.lock`. The last run to end removes the file; after runs that were killed the
/// next one does.
class FrameClaims {
 public:
  /// pattern: of the frames' files, see frameFile(), in a folder that exists. Throws InputError if the lock
  /// file can't be written.
  explicit FrameClaims(const std::string& pattern);
  ~FrameClaims();
  FrameClaims(const FrameClaims&) = delete;
  FrameClaims& operator=(const FrameClaims&) = delete;

  /// Claims a frame. Throws InputError if another run holds it or the lock file can't be written. On a file
  /// system without locks every frame is free.
  void claim(int frame);

 private:
  void openFile();

  std::string path_;
  int descriptor_ = -1;
};

}  // namespace luciole
