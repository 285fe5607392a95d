#include "base/cleanup.hpp"

#include <unistd.h>

#include <utility>

namespace luciole {
namespace {

Cleanups of_program;
Cleanups* cleanups_used = &of_program;

}  // namespace

Cleanups& cleanups() { return *cleanups_used; }

void shareCleanups(Cleanups& others) { cleanups_used = &others; }

std::unique_lock<std::recursive_mutex> holdSignals() { return std::unique_lock(cleanups().mutex); }

Cleanup::Cleanup(std::function<void()> undo) {
  const auto lock = holdSignals();
  cleanups().all.push_front(std::move(undo));
  place_ = cleanups().all.begin();
}

Cleanup::~Cleanup() {
  const auto lock = holdSignals();
  cleanups().all.erase(place_);
}

void removeHiddenFiles() noexcept {
  for (const std::atomic<const char*>& place : cleanups().hidden_files)
    if (const char* const name = place.load()) unlink(name);
}

void cleanUp() {
  cleanups().mutex.lock();
  removeHiddenFiles();
  for (const auto& undo : cleanups().all) undo();
}

}  // namespace luciole
