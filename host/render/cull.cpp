#include "render/cull.hpp"

#include "error.hpp"

namespace luciole {
namespace {

constexpr const char* kFile = "cull.cl";

cl_uint asUint(std::size_t value) { return static_cast<cl_uint>(value); }

}  // namespace

LightLists cull(Device& device, const CullArguments& arguments) {
  const std::size_t tiles = arguments.plane_stride / kTilePixels;
  LightLists lists;
  lists.lists = tiles * kListsPerTile;
  const std::size_t bound_bytes = kBoundPlanes * lists.lists * sizeof(cl_float);
  const cl::Buffer bounds = deviceBuffer(device, bound_bytes);
  lists.starts = deviceBuffer(device, (lists.lists + 1) * sizeof(cl_uint));

  cl::Kernel count_lights = makeKernel(device, kFile, "count_lights", "");
  count_lights.setArg(0, arguments.position);
  count_lights.setArg(1, arguments.normal);
  count_lights.setArg(2, asUint(arguments.plane_stride));
  count_lights.setArg(3, cl_uint(arguments.list_shift));
  count_lights.setArg(4, arguments.tree);
  count_lights.setArg(5, asUint(arguments.tree_stride));
  count_lights.setArg(6, arguments.lights);
  count_lights.setArg(7, asUint(arguments.light_count));
  count_lights.setArg(8, cl_uint(arguments.tests));
  count_lights.setArg(9, bounds);
  count_lights.setArg(10, lists.starts);
  launch(device, count_lights, tiles, 1);

  cl::Kernel scan_lists = makeKernel(device, kFile, "scan_lists", "");
  scan_lists.setArg(0, asUint(lists.lists));
  scan_lists.setArg(1, lists.starts);
  launch(device, scan_lists, 1, 1);

  cl_uint entries = 0;
  readBuffer(device, lists.starts, &entries, sizeof entries, lists.lists * sizeof(cl_uint));
  lists.entries = entries;
  if (entries == 0xffffffffu)
    throw MachineError(
        "the light lists have more than 4294967294 entries: use fewer lights or a smaller picture");
  lists.list = deviceBuffer(device, lists.entries * sizeof(cl_uint));
  lists.bytes = bound_bytes + (lists.lists + 1 + lists.entries) * sizeof(cl_uint);

  cl::Kernel fill_lists = makeKernel(device, kFile, "fill_lists", "");
  fill_lists.setArg(0, bounds);
  fill_lists.setArg(1, arguments.tree);
  fill_lists.setArg(2, asUint(arguments.tree_stride));
  fill_lists.setArg(3, arguments.lights);
  fill_lists.setArg(4, asUint(arguments.light_count));
  fill_lists.setArg(5, cl_uint(arguments.tests));
  fill_lists.setArg(6, lists.starts);
  fill_lists.setArg(7, lists.list);
  launch(device, fill_lists, tiles, 1);
  finish(device);
  return lists;
}

}  // namespace luciole
