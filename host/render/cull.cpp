#include "render/cull.hpp"

#include "error.hpp"

namespace luciole {
namespace {

constexpr const char* kFile = "cull.cl";

cl_uint asUint(std::size_t value) { return static_cast<cl_uint>(value); }

}  // namespace

LightLists cull(Device& device, const CullArguments& arguments) {
  const std::size_t tiles = arguments.plane_stride / kTilePixels;
  const cl::Buffer low = deviceBuffer(device, tiles * sizeof(cl_float4));
  const cl::Buffer high = deviceBuffer(device, tiles * sizeof(cl_float4));
  LightLists lists;
  lists.starts = deviceBuffer(device, (tiles + 1) * sizeof(cl_uint));

  cl::Kernel tile_bounds = makeKernel(device, kFile, "tile_bounds", "");
  tile_bounds.setArg(0, arguments.position);
  tile_bounds.setArg(1, asUint(arguments.plane_stride));
  tile_bounds.setArg(2, low);
  tile_bounds.setArg(3, high);
  launch(device, tile_bounds, tiles, 1);

  cl::Kernel count_lights = makeKernel(device, kFile, "count_lights", "");
  count_lights.setArg(0, low);
  count_lights.setArg(1, high);
  count_lights.setArg(2, arguments.reach);
  count_lights.setArg(3, asUint(arguments.reach_stride));
  count_lights.setArg(4, lists.starts);
  launch(device, count_lights, tiles, 1);

  cl::Kernel scan_lists = makeKernel(device, kFile, "scan_lists", "");
  scan_lists.setArg(0, asUint(tiles));
  scan_lists.setArg(1, lists.starts);
  launch(device, scan_lists, 1, 1);

  std::vector<cl_uint> starts(tiles + 1);
  readBuffer(device, lists.starts, starts.data(), starts.size() * sizeof(cl_uint));
  lists.entries = starts.back();
  if (lists.entries == 0xffffffffu)
    throw MachineError(
        "the light lists have more than 4294967294 entries: use fewer lights or a smaller picture");
  lists.list = deviceBuffer(device, lists.entries * sizeof(cl_uint));
  lists.bytes = 2 * tiles * sizeof(cl_float4) + (tiles + 1 + lists.entries) * sizeof(cl_uint);

  cl::Kernel fill_lists = makeKernel(device, kFile, "fill_lists", "");
  fill_lists.setArg(0, low);
  fill_lists.setArg(1, high);
  fill_lists.setArg(2, arguments.reach);
  fill_lists.setArg(3, asUint(arguments.reach_stride));
  fill_lists.setArg(4, lists.starts);
  fill_lists.setArg(5, lists.list);
  launch(device, fill_lists, tiles, 1);
  return lists;
}

}  // namespace luciole
