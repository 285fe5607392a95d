#pragma once

#include <optional>

namespace luciole {

/// Lets this process's work take at most `count` threads (1 or more): the host's own, by oneTBB, and those
/// that libraries start themselves, by the environment that they read: PoCL and OpenImageIO. A library that
/// has started keeps its threads, so this must come before the first call of OpenCL and the first picture
/// file that OpenImageIO reads or writes. Results don't depend on it. Beside these, a thread opens the device
/// and one compiles kernels, at the start; and libraries that OpenImageIO loads may keep idle ones (log4cplus
/// has 4). Child processes inherit the environment only.
void limitThreads(int count);

/// The count of the last limitThreads(); nothing without one.
std::optional<int> threadLimit();

/// Threads that work is spread over: threadLimit(), else as many as this process may run at once.
unsigned threadCount();

/// The number of threads that this process has now, idle ones included.
unsigned countThreads();

}  // namespace luciole
