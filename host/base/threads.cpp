#include "base/threads.hpp"

#include <tbb/global_control.h>

#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

namespace luciole {
namespace {

std::optional<int>& limit() {
  static std::optional<int> of_process;
  return of_process;
}

}  // namespace

void limitThreads(int count) {
  static std::optional<tbb::global_control> of_host;
  of_host.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(count));
  limit() = count;
  // PoCL up to 3.1 reads the first alone. Later ones look there first, but their driver on oneTBB reads the
  // second alone.
  for (const char* name : {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT", "OPENIMAGEIO_THREADS"})
    setenv(name, std::to_string(count).c_str(), 1);
}

std::optional<int> threadLimit() { return limit(); }

unsigned threadCount() { return limit() ? unsigned(*limit()) : std::thread::hardware_concurrency(); }

unsigned countThreads() {
  std::ifstream status("/proc/self/status");
  unsigned threads = 0;
  for (std::string field; status >> field;)
    if (field == "Threads:") status >> threads;
  return threads;
}

}  // namespace luciole
