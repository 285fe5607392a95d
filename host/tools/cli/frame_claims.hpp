#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/cleanup.hpp"

namespace luciole {

/// Divides frames among concurrent runs, so that each is rendered once: a run claims a frame before it
/// renders it. Claims are locks on the frame's byte of a hidden file beside the frames, `.PATTERN.lock`,
/// which the kernel or the file server releases however a run ends. The byte is set when the frame was made,
/// so that runs that come later see it, too. The last run to end removes the file. What killed runs left
/// counts for nothing, and goes when the next run ends.
class FrameClaims {
 public:
  /// pattern: of the frames' files, see hashPattern(), in a folder that exists. Throws InputError if the lock
  /// file can't be written.
  explicit FrameClaims(const std::string& pattern);
  ~FrameClaims();
  FrameClaims(const FrameClaims&) = delete;
  FrameClaims& operator=(const FrameClaims&) = delete;

  /// Claims a frame, until finish(). False if another run is making it, or has been done with it since this
  /// run or one beside it began. On a file system without locks no other run is seen at a frame.
  bool claim(int frame);
  /// The same, but waits while another run is making it: true then says that the other one ended before.
  bool await(int frame);
  /// A claimed frame is made, or failed: no other run shall make it.
  void finish(int frame);

 private:
  bool claimIf(int frame, bool waits);
  void leave();

  std::string path_;
  int descriptor_ = -1;
  std::optional<Cleanup> cleanup_;
};

}  // namespace luciole
