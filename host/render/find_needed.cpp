#include "render/find_needed.hpp"

#include "cl/launch.hpp"

namespace luciole {

std::vector<std::uint32_t> findNeeded(Device& device, const std::string& defines,
                                      const FindNeededArguments& arguments) {
  std::vector<std::uint32_t> result(arguments.bin_count);
  const Buffer<uint> needed = borrowedForOutput(device, result);
  fill(device, needed, kNotNeeded);
  Kernel kernel = makeKernel(device, "find_needed.cl", "find_needed", defines);
  launch(device, kernel,
         {{"plane_stride", uint(arguments.plane_stride)},
          {"position", arguments.position},
          {"normal", arguments.normal},
          {"lift", arguments.lift},
          {"lights", arguments.lights},
          {"light_count", uint(arguments.light_count)},
          {"list_starts", arguments.lists.starts},
          {"list", arguments.lists.list},
          {"shadow_maps", arguments.shadow_maps},
          {"shadow_faces", arguments.shadow_faces},
          {"needed", needed}},
         {.items = arguments.plane_stride / kTilePixels});
  download(device, needed, result);
  return result;
}

}  // namespace luciole
