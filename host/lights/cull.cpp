#include "lights/cull.hpp"

#include "cl/launch.hpp"
#include "kernels/shared.h"
#include "luciole/error.hpp"

namespace luciole {
namespace {

constexpr const char* kFile = "lights/cull.cl";

/// Launches kernels/lights/cull.cl. fill: writes the lists, else counts their lengths.
void findLights(OpenedDevice& device, const CullArguments& arguments, bool fill, const LightLists& lists) {
  Kernel find_lights = makeKernel(device, kFile, "find_lights", "");
  const CullFrame frame{.plane_stride = uint(arguments.plane_stride),
                        .tree_stride = uint(arguments.tree_stride),
                        .light_count = uint(arguments.light_count),
                        .group_log2 = uint(arguments.group_log2),
                        .tests = uint(arguments.tests),
                        .fill = uint(fill)};
  launch(device, find_lights,
         {{"frame", frame},
          {"position", arguments.position},
          {"normal", arguments.normal},
          {"tree", arguments.tree},
          {"lights", arguments.lights},
          {"found", lists.found},
          {"starts", lists.starts},
          {"all_lists", lists.list}},
         {.items = lists.tiles});
}

}  // namespace

void cull(OpenedDevice& device, const CullArguments& arguments, LightLists& lists) {
  lists.tiles = arguments.plane_stride / kTilePixels;
  reserve(device, lists.tiles * kFoundPerTile, lists.found);
  reserve(device, lists.tiles + 1, lists.starts);

  findLights(device, arguments, false, lists);
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

  findLights(device, arguments, true, lists);
  finish(device);
}

}  // namespace luciole
