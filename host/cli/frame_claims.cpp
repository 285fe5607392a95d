#include "cli/frame_claims.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "base/error.hpp"
#include "base/output_file.hpp"

namespace luciole {
namespace {

/// Locks `count` bytes (0: all) from `first` on for this open file. Returns at once: false if another open
/// file holds a lock on any of them. On a file system without locks nobody does.
bool lockBytes(int descriptor, off_t first, off_t count) {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = first;
  lock.l_len = count;
  return fcntl(descriptor, F_OFD_SETLK, &lock) == 0 || (errno != EAGAIN && errno != EACCES);
}

/// Whether the open file still has a name: another run may have removed it when it ended.
bool hasName(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

}  // namespace

FrameClaims::FrameClaims(const std::string& pattern)
    : path_(
          fmt::format("{}/.{}.lock", folderOf(pattern), std::filesystem::path(pattern).filename().string())) {
  openFile();
}

FrameClaims::~FrameClaims() {
  // A lock on all bytes means that no other run has a claim. One that is about to claim notices that the name
  // is gone, and makes a new file.
  if (lockBytes(descriptor_, 0, 0)) unlink(path_.c_str());
  close(descriptor_);
}

void FrameClaims::openFile() {
  descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw InputError(fmt::format("{}: can't be written: {}", path_, systemReason()));
}

void FrameClaims::claim(int frame) {
  while (true) {
    if (!lockBytes(descriptor_, frame, 1))
      throw InputError(fmt::format(
          "frame {}: another run is making it, as {} says; expected each task to have a part of its own",
          frame, path_));
    if (hasName(descriptor_)) return;
    close(descriptor_);
    openFile();
  }
}

}  // namespace luciole
