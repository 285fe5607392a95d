#include "cl/kernel_cache.hpp"

#include <link.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>

namespace luciole {
namespace {

double secondsOf(const timespec& time) { return double(time.tv_sec) + 1e-9 * double(time.tv_nsec); }

double now(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return secondsOf(time);
}

/// Seconds from the machine's start to this process's: field 22 of /proc/self/stat (proc(5)). Counting starts
/// behind the ')' of field 2, the program's name in parentheses, because that may hold blanks.
double processStart() {
  std::ifstream file("/proc/self/stat");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string field;
  for (int number = 3; number <= 22; ++number) fields >> field;
  return std::stod(field) / double(sysconf(_SC_CLK_TCK));
}

}  // namespace

double millisecondsSinceStart() { return 1e3 * (now(CLOCK_BOOTTIME) - processStart()); }

std::optional<int> kernelsCompiled(const std::string& platform) {
  if (platform != "Portable Computing Language") return std::nullopt;
  // PoCL keeps each compiled kernel as a shared object and loads it from there: one that is younger than this
  // process wasn't in the cache when it started.
  struct Search {
    double process_start;
    int younger = 0;
  } search{now(CLOCK_REALTIME) - millisecondsSinceStart() / 1e3};
  dl_iterate_phdr(
      [](dl_phdr_info* object, std::size_t, void* data) {
        Search& found = *static_cast<Search*>(data);
        struct stat status {};
        if (stat(object->dlpi_name, &status) == 0 && secondsOf(status.st_mtim) > found.process_start)
          ++found.younger;
        return 0;
      },
      &search);
  return search.younger;
}

}  // namespace luciole
