#include "cl/kernel_cache.hpp"

#include <link.h>
#include <sys/stat.h>

#include <ctime>

#include "base/clock.hpp"
#include "cl/pocl_cache.hpp"

namespace luciole {
namespace {

double secondsOf(const timespec& time) { return double(time.tv_sec) + 1e-9 * double(time.tv_nsec); }

/// The time of day, as files have it.
double now() {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  return secondsOf(time);
}

}  // namespace

std::optional<int> kernelsCompiled(const std::string& platform) {
  if (platform != kPoclPlatform) return std::nullopt;
  // PoCL loads each compiled kernel as a shared object from its cache: one younger than the program's start
  // wasn't in the cache before.
  struct Search {
    double start;
    int younger = 0;
  } search{now() - millisecondsSinceStart() / 1e3};
  dl_iterate_phdr(
      [](dl_phdr_info* object, std::size_t, void* data) {
        Search& found = *static_cast<Search*>(data);
        struct stat status {};
        if (stat(object->dlpi_name, &status) == 0 && secondsOf(status.st_mtim) > found.start) ++found.younger;
        return 0;
      },
      &search);
  return search.younger;
}

}  // namespace luciole
