#include "shadow/maps/find_needed.hpp"

#include "cl/launch.hpp"
#include "kernels/shared.h"

namespace luciole {

std::vector<std::uint32_t> findNeeded(OpenedDevice& device, const std::string& defines,
                                      const Lookups& lookups, std::size_t bin_count) {
  std::vector<std::uint32_t> result(bin_count);
  const Buffer<uint> needed = borrowedForOutput(device, result);
  fill(device, needed, kNotNeeded);
  Kernel kernel = makeKernel(device, "maps/find_needed.cl", "find_needed", defines);
  std::vector<KernelArgument> arguments = lookupArguments(lookups);
  arguments.push_back({"needed", needed});
  launch(device, kernel, arguments, {.items = lookups.plane_stride / kTilePixels});
  download(device, needed, result);
  return result;
}

}  // namespace luciole
