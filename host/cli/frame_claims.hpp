#pragma once

#include <string>

namespace luciole {

/// Which frames of a pattern this run makes, for other runs beside it to see: two that were given the same
/// part would each make the other's pictures again. A claim holds until the run ends, however it ends. It is
/// a lock on the frame's byte of a hidden, empty file beside the frames, `.PATTERN.lock`, which the last run
/// to end takes away; where runs were killed, the next one does.
class FrameClaims {
 public:
  /// pattern: the frames' files, as for frameFile(), in a folder that exists.
  explicit FrameClaims(const std::string& pattern);
  ~FrameClaims();
  FrameClaims(const FrameClaims&) = delete;
  FrameClaims& operator=(const FrameClaims&) = delete;

  /// Throws InputError where another run holds the frame, and where the folder can't be written to. Where the
  /// file system knows no locks every frame is free.
  void claim(int frame);

 private:
  void openFile();

  std::string path_;
  int descriptor_ = -1;
};

}  // namespace luciole
