#pragma once

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
};
Cleanups& cleanups();
void useCleanups(Cleanups& others);

/// While one is held no signal ends the process: for what takes several steps.
[[nodiscard]] std::unique_lock<std::recursive_mutex> undisturbed();

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

/// Undoes all, what was registered last first, before the process ends. From then on whoever comes to
/// undisturbed() or registers something waits for good.
void cleanUp();

}  // namespace luciole
