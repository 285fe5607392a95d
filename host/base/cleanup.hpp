#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <list>
#include <mutex>

// Cleaning up what would outlive the process, such as files under hidden names, when a signal ends it.
namespace luciole {

/// The registry. The module that reads pictures (image/module.hpp) has a copy of this code and shares the
/// program's registry by shareCleanups().
struct Cleanups {
  std::recursive_mutex mutex;
  std::list<std::function<void()>> all;
  /// Names of incomplete files. More of them at once than this would be left behind.
  std::array<std::atomic<const char*>, 64> hidden_files{};
};
Cleanups& cleanups();
void shareCleanups(Cleanups& others);

/// While the lock is held no signal ends the process. For sequences of steps that must not be interrupted.
[[nodiscard]] std::unique_lock<std::recursive_mutex> holdSignals();

/// As long as this lives, cleanUp() calls `undo`.
class Cleanup {
 public:
  explicit Cleanup(std::function<void()> undo);
  ~Cleanup();
  Cleanup(const Cleanup&) = delete;
  Cleanup& operator=(const Cleanup&) = delete;

 private:
  std::list<std::function<void()>>::iterator place_;
};

/// Removes the hidden files, for a process that ends at once. A signal handler may call it.
void removeHiddenFiles() noexcept;

/// Removes the hidden files and calls all `undo` functions, the last registered first, before the process
/// ends. Never releases the lock: from then on holdSignals() and Cleanup() block for ever.
void cleanUp();

}  // namespace luciole
