#include "culling/cull.hpp"

#include "base/error.hpp"

namespace luciole {
namespace {

constexpr const char* kFile = "cull.cl";

cl_uint asUint(std::size_t value) { return static_cast<cl_uint>(value); }

/// Sets what counting and filling have in common; returns the number of the argument that follows.
cl_uint setCommonArguments(Kernel& kernel, const CullArguments& arguments) {
  cl_uint i = 0;
  kernel.setArg(i++, arguments.position);
  kernel.setArg(i++, arguments.normal);
  kernel.setArg(i++, asUint(arguments.plane_stride));
  kernel.setArg(i++, cl_uint(arguments.shift));
  kernel.setArg(i++, arguments.tree);
  kernel.setArg(i++, asUint(arguments.tree_stride));
  kernel.setArg(i++, arguments.lights);
  kernel.setArg(i++, asUint(arguments.light_count));
  kernel.setArg(i++, cl_uint(arguments.tests));
  return i;
}

}  // namespace

LightLists cull(Device& device, const CullArguments& arguments) {
  LightLists lists;
  lists.tiles = arguments.plane_stride / kTilePixels;
  const std::size_t found_bytes = lists.tiles * kFoundPerTile * sizeof(ListEntry);
  const cl::Buffer found = deviceBuffer(device, found_bytes);
  lists.starts = deviceBuffer(device, (lists.tiles + 1) * sizeof(cl_uint));

  Kernel count_lights = makeKernel(device, kFile, "count_lights", "");
  cl_uint i = setCommonArguments(count_lights, arguments);
  count_lights.setArg(i++, found);
  count_lights.setArg(i++, lists.starts);
  launch(device, count_lights, lists.tiles, 1);

  Kernel scan_lists = makeKernel(device, kFile, "scan_lists", "");
  scan_lists.setArg(0, asUint(lists.tiles));
  scan_lists.setArg(1, lists.starts);
  launch(device, scan_lists, 1, 1);

  cl_uint entries = 0;
  readBuffer(device, lists.starts, &entries, sizeof entries, lists.tiles * sizeof(cl_uint));
  lists.entries = entries;
  if (entries == 0xffffffffu)
    throw MachineError(
        "the light lists have more than 4294967294 entries: use fewer lights or a smaller picture");
  lists.list = deviceBuffer(device, lists.entries * sizeof(ListEntry));
  lists.bytes = found_bytes + (lists.tiles + 1) * sizeof(cl_uint) + lists.entries * sizeof(ListEntry);

  Kernel fill_lists = makeKernel(device, kFile, "fill_lists", "");
  i = setCommonArguments(fill_lists, arguments);
  fill_lists.setArg(i++, found);
  fill_lists.setArg(i++, lists.starts);
  fill_lists.setArg(i++, lists.list);
  launch(device, fill_lists, lists.tiles, 1);
  finish(device);
  return lists;
}

}  // namespace luciole
