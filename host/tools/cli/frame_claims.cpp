#include "tools/cli/frame_claims.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "base/output_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// The byte, behind those of all frames, on which each run has a shared lock as long as it is at work.
constexpr off_t kPresence = off_t(1) << 40;

/// Changes this open file's lock on a byte to F_RDLCK, F_WRLCK or F_UNLCK. False if another open file holds
/// one that doesn't go with it, unless it waits. On a file system without locks nobody does.
bool lockByte(int descriptor, off_t byte, short type, bool waits = false) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  while (fcntl(descriptor, waits ? F_OFD_SETLKW : F_OFD_SETLK, &lock) != 0) {
    if (errno == EINTR) continue;
    return errno != EAGAIN && errno != EACCES;
  }
  return true;
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
  while (true) {
    descriptor_ = open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw InputError(fmt::format("{}: can't be written: {}", path_, systemReason()));
    // Nobody else is at work: what is marked here is of runs that were killed.
    const bool is_ready = !lockByte(descriptor_, kPresence, F_WRLCK) || ftruncate(descriptor_, 0) == 0;
    lockByte(descriptor_, kPresence, F_RDLCK, true);
    if (is_ready && hasName(descriptor_)) break;
    const std::string reason = systemReason();
    close(descriptor_);
    if (!is_ready) throw InputError(fmt::format("{}: can't be written: {}", path_, reason));
  }
  cleanup_.emplace([this] { leave(); });
}

FrameClaims::~FrameClaims() {
  leave();
  cleanup_.reset();
  close(descriptor_);
}

void FrameClaims::leave() {
  // One that opens the file meanwhile waits for its shared lock, and then notices that the name is gone.
  if (lockByte(descriptor_, kPresence, F_WRLCK)) unlink(path_.c_str());
}

bool FrameClaims::claim(int frame) { return claimIf(frame, false); }

bool FrameClaims::await(int frame) { return claimIf(frame, true); }

bool FrameClaims::claimIf(int frame, bool waits) {
  if (!lockByte(descriptor_, frame, F_WRLCK, waits)) return false;
  // Read after it is locked: over a network what others wrote is only then sure to be seen.
  char is_done = 0;
  if (pread(descriptor_, &is_done, 1, frame) != 1 || is_done == 0) return true;
  lockByte(descriptor_, frame, F_UNLCK);
  return false;
}

void FrameClaims::finish(int frame) {
  const char is_done = 1;
  // If it can't be written, others make the frame again.
  while (pwrite(descriptor_, &is_done, 1, frame) < 0 && errno == EINTR) continue;
  lockByte(descriptor_, frame, F_UNLCK);
}

}  // namespace luciole
