#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <list>
#include <mutex>

// What would outlive the process, such as files under hidden names, and is undone if a signal ends it.
namespace luciole {

/// What is registered. The module that reads pictures (image/module.hpp) has a copy of this code, and is
/// given the program's.
struct Cleanups {
  std::recursive_mutex mutex;
  std::list<std::function<void()>> all;
  /// Names of files that are not whole yet. Those beyond are left behind by a process that ends early.
  std::array<std::atomic<const char*>, 64> hidden_files{};
};
Cleanups& cleanups();
void shareCleanups(Cleanups& others);

/// While one is held no signal ends the process: for what takes several steps.
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

/// Removes them and undoes all else, what was registered last first, before the process ends. From then on
/// whoever comes to holdSignals() or registers something waits for good.
void cleanUp();

}  // namespace luciole
