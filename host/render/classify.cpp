#include "render/classify.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/machine_memory.hpp"
#include "cl/launch.hpp"

namespace luciole {

PairBits classify(Device& device, const std::string& defines, const ClassifyArguments& arguments) {
  const std::size_t tiles = arguments.plane_stride / kTilePixels;
  const std::size_t entries =
      arguments.lists.tiles > 0 ? arguments.lists.entries : tiles * arguments.light_count;
  requireMemory(double(entries) * (kPairWords * sizeof(uint)), "the exact shadows of all pixels");
  if (entries > 0xffffffffu / kPairWords)
    throw MachineError(
        "exact shadows of more than 2^28 pairs of a tile and a light: use fewer lights or a smaller picture");
  PairBits result(std::max<std::size_t>(entries, 1) * kPairWords);
  const Buffer<uint> bits = borrowedForOutput(device, result);
  Kernel kernel = makeKernel(device, "classify.cl", "classify", defines);
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
          {"texels", arguments.texels},
          {"texel_count", uint(arguments.texel_count)},
          {"bits", bits}},
         {.items = tiles});
  download(device, bits, result);
  return result;
}

}  // namespace luciole
