#pragma once

#include <ImfThreading.h>

#include "base/threads.hpp"

namespace luciole {

/// Lets the OpenEXR library use the threads that this process may: it starts with none.
inline void useExrThreads() {
  if (Imf::globalThreadCount() == 0 && threadCount() > 1) Imf::setGlobalThreadCount(int(threadCount()));
}

}  // namespace luciole
