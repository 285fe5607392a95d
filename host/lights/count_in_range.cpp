#include "lights/count_in_range.hpp"

#include "cl/launch.hpp"
#include "kernels/shared.h"

namespace luciole {

void countInRange(OpenedDevice& device, const CountInRangeArguments& arguments) {
  Kernel kernel = makeKernel(device, "lights/count_in_range.cl", "count_in_range", "");
  const auto lanes = std::size_t(device.description.lanes);
  launch(device, kernel,
         {{"position", arguments.position},
          {"plane_stride", uint(arguments.plane_stride)},
          {"lights", arguments.lights},
          {"list_starts", arguments.lists.starts},
          {"list", arguments.lists.list},
          {"counts", arguments.counts}},
         {.items = arguments.plane_stride / lanes, .group = kTilePixels / lanes});
}

}  // namespace luciole
