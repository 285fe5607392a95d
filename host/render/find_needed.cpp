#include "render/find_needed.hpp"

namespace luciole {

std::vector<std::uint32_t> findNeeded(Device& device, const std::string& defines,
                                      const FindNeededArguments& arguments) {
  std::vector<std::uint32_t> needed(arguments.bin_count, kNotNeeded);
  const std::size_t bytes = needed.size() * sizeof(cl_uint);
  const cl::Buffer result = updateBuffer(device, needed.data(), bytes);
  Kernel kernel = makeKernel(device, "find_needed.cl", "find_needed", defines);
  kernel.setArg(0, static_cast<cl_uint>(arguments.plane_stride));
  kernel.setArg(1, arguments.position);
  kernel.setArg(2, arguments.normal);
  kernel.setArg(3, arguments.lift);
  kernel.setArg(4, arguments.lights);
  kernel.setArg(5, static_cast<cl_uint>(arguments.light_count));
  kernel.setArg(6, arguments.lists.starts);
  kernel.setArg(7, arguments.lists.list);
  kernel.setArg(8, arguments.shadow_maps);
  kernel.setArg(9, arguments.shadow_faces);
  kernel.setArg(10, result);
  launch(device, kernel, arguments.plane_stride / kTilePixels, 1);
  readBuffer(device, result, needed.data(), bytes);
  return needed;
}

}  // namespace luciole
