#include "culling/cull.hpp"

#include "base/error.hpp"
#include "cl/launch.hpp"

namespace luciole {
namespace {

constexpr const char* kFile = "cull.cl";

/// The arguments that counting and filling share, and `own`, those of one of them.
std::vector<KernelArgument> withCommon(const CullArguments& arguments, std::vector<KernelArgument> own) {
  own.insert(own.end(), {{"position", arguments.position},
                         {"normal", arguments.normal},
                         {"plane_stride", uint(arguments.plane_stride)},
                         {"group_log2", uint(arguments.group_log2)},
                         {"tree", arguments.tree},
                         {"tree_stride", uint(arguments.tree_stride)},
                         {"lights", arguments.lights},
                         {"light_count", uint(arguments.light_count)},
                         {"tests", uint(arguments.tests)}});
  return own;
}

}  // namespace

void cull(Device& device, const CullArguments& arguments, LightLists& lists) {
  lists.tiles = arguments.plane_stride / kTilePixels;
  reserve(device, lists.tiles * kFoundPerTile, lists.found);
  reserve(device, lists.tiles + 1, lists.starts);

  Kernel count_lights = makeKernel(device, kFile, "count_lights", "");
  launch(device, count_lights, withCommon(arguments, {{"found", lists.found}, {"counts", lists.starts}}),
         {.items = lists.tiles});

  Kernel scan_lists = makeKernel(device, kFile, "scan_lists", "");
  launch(device, scan_lists, {{"tiles", uint(lists.tiles)}, {"starts", lists.starts}}, {.items = 1});

  uint entries = 0;
  download(device, lists.starts, std::span(&entries, 1), lists.tiles);
  if (entries == 0xffffffffu)
    throw MachineError(
        "the light lists have more than 4294967294 entries: use fewer lights or a smaller picture");
  lists.entries = entries;
  reserve(device, lists.entries, lists.list);
  lists.bytes = lists.tiles * kFoundPerTile * sizeof(ListEntry) + (lists.tiles + 1) * sizeof(uint) +
                lists.entries * sizeof(ListEntry);

  Kernel fill_lists = makeKernel(device, kFile, "fill_lists", "");
  launch(device, fill_lists,
         withCommon(arguments,
                    {{"found", lists.found}, {"list_starts", lists.starts}, {"all_lists", lists.list}}),
         {.items = lists.tiles});
  finish(device);
}

}  // namespace luciole
