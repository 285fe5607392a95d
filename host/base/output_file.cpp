#include "base/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "base/cleanup.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// Whether errno means that the caller named a place where no file can be, or may be written.
bool isPlaceRefused(int code) {
  return code == EACCES || code == EROFS || code == ENOENT || code == ENOTDIR || code == EPERM ||
         code == EISDIR || code == EBUSY;
}

/// Makes a file in a folder under a hidden name that no file has. `make` takes the name and returns < 0 for
/// failure, with errno; so does this.
template <class Make>
int makeHidden(const std::string& folder, std::string& name, Make make) {
  for (unsigned serial = 0;; ++serial) {
    name = fmt::format("{}/.luciole-{}-{}.tmp", folder, getpid(), serial);
    const int result = retryInterrupted([&] { return make(name.c_str()); });
    if (result >= 0 || errno != EEXIST) return result;
  }
}

}  // namespace

void checkSizeLimit(std::uint64_t bytes, const std::string& name) {
  constexpr std::uint64_t kHeader = 65536;
  rlimit limit{};
  if (getrlimit(RLIMIT_FSIZE, &limit) != 0) throw MachineError(fmt::format("{}: {}", name, systemReason()));
  if (limit.rlim_cur != RLIM_INFINITY && 2 * bytes + kHeader > limit.rlim_cur) {
    throw MachineError(fmt::format("{}: may be larger than the {} bytes this process may write to a file",
                                   name, std::uint64_t(limit.rlim_cur)));
  }
}

bool leadsToStream(const std::string& path) {
  struct stat status {};
  if (path == "-") return true;
  return stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

std::string followLinks(const std::string& path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::filesystem::path place = path;
  std::error_code error;
  for (int links = 0; std::filesystem::is_symlink(place, error); ++links) {
    if (links == kMostLinks) throw InputError(path + ": symbolic links that lead nowhere");
    place = place.parent_path() / std::filesystem::read_symlink(place, error);
  }
  return place.string();
}

std::string folderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

std::string systemReason() { return std::generic_category().message(errno); }

OutputFile::OutputFile(const std::string& path) : path_(path), is_stream_(leadsToStream(path)) {
  if (path == "-") {
    std::fflush(stdout);
    descriptor_ = STDOUT_FILENO;
    return;
  }
  if (is_stream_) {
    descriptor_ = retryInterrupted([&] { return open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC); });
    if (descriptor_ < 0) throw InputError(fmt::format("{}: can't write to it: {}", path, systemReason()));
    return;
  }
  place_ = followLinks(path);
  const std::string folder = folderOf(place_);
  descriptor_ =
      retryInterrupted([&] { return open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666); });
  if (descriptor_ >= 0) return;
  const auto lock = holdSignals();
  descriptor_ = makeHidden(folder, beside_, [](const char* name) {
    return open(name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  });
  if (descriptor_ < 0) {
    const int code = errno;
    const std::string message =
        fmt::format("{}: can't create a file in its folder: {}", path, systemReason());
    if (isPlaceRefused(code)) throw InputError(message);
    throw MachineError(message);
  }
  setHasName(true);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0 && path_ != "-") close(descriptor_);
  if (!has_name_) return;
  unlink(beside_.c_str());
  setHasName(false);
}

void OutputFile::setHasName(bool has_name) {
  has_name_ = has_name;
  const char* const name = beside_.c_str();
  for (std::atomic<const char*>& place : cleanups().hidden_files) {
    const char* before = has_name ? nullptr : name;
    if (place.compare_exchange_strong(before, has_name ? name : nullptr)) return;
  }
}

void OutputFile::writeAt(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (is_stream_ && offset != size_)
    throw MachineError(name() + ": can't go back to where something was written, expected a file");
  size_ += bytes.size();
  if (memory_) {
    memory_->append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return;
  }
  while (!bytes.empty()) {
    const ssize_t written = retryInterrupted([&] {
      return is_stream_ ? write(descriptor_, bytes.data(), bytes.size())
                        : pwrite(descriptor_, bytes.data(), bytes.size(), off_t(offset));
    });
    if (written == 0) errno = ENOSPC;
    if (written <= 0) throw MachineError(fmt::format("{}: can't write: {}", name(), systemReason()));
    bytes = bytes.subspan(std::size_t(written));
    offset += std::uint64_t(written);
  }
}

void OutputFile::putInPlace() {
  if (path_ == "-" || memory_) return;
  // Some file systems can't sync, which is no error.
  if (!is_stream_ && retryInterrupted([&] { return fsync(descriptor_); }) != 0 && errno != EINVAL &&
      errno != ENOTSUP)
    throw MachineError(fmt::format("{}: can't write: {}", path_, systemReason()));
  const auto lock = holdSignals();
  if (!is_stream_ && !has_name_) {
    const std::string nameless = fmt::format("/proc/self/fd/{}", descriptor_);
    // linkat() can't replace a file, rename() can: the file gets a hidden name first.
    if (makeHidden(folderOf(place_), beside_, [&](const char* name) {
          return linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW);
        }) != 0)
      throw MachineError(fmt::format("{}: can't put the file in place: {}", path_, systemReason()));
    setHasName(true);
  }
  const int closed = close(descriptor_);
  descriptor_ = -1;
  if (closed != 0 && errno != EINTR)  // Linux has closed it then, and fsync() above told what was lost
    throw MachineError(fmt::format("{}: can't write: {}", path_, systemReason()));
  if (is_stream_) return;
  if (retryInterrupted([&] { return std::rename(beside_.c_str(), place_.c_str()); }) != 0) {
    const int code = errno;
    const std::string message = fmt::format("{}: can't put the file in place: {}", path_, systemReason());
    if (isPlaceRefused(code)) throw InputError(message);
    throw MachineError(message);
  }
  setHasName(false);
}

}  // namespace luciole
