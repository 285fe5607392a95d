#include "render/classify.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/machine_memory.hpp"
#include "cl/launch.hpp"

namespace luciole {

PairBits classify(Device& device, const std::string& defines, const Lookups& lookups,
                  const Buffer<const BoundTexel>& texels, std::size_t texel_count) {
  const std::size_t tiles = lookups.plane_stride / kTilePixels;
  const std::size_t entries = lookups.lists.tiles > 0 ? lookups.lists.entries : tiles * lookups.light_count;
  requireMemory(double(entries) * (kPairWords * sizeof(uint)), "the exact shadows of all pixels");
  if (entries > 0xffffffffu / kPairWords)
    throw MachineError(
        "exact shadows of 2^28 or more pairs of a tile and a light: use fewer lights or a smaller picture");
  PairBits result(std::max<std::size_t>(entries, 1) * kPairWords);
  const Buffer<uint> bits = borrowedForOutput(device, result);
  Kernel kernel = makeKernel(device, "classify.cl", "classify", defines);
  std::vector<KernelArgument> arguments = lookupArguments(lookups);
  arguments.insert(arguments.end(), {{"texels", texels}, {"texel_count", uint(texel_count)}, {"bits", bits}});
  launch(device, kernel, arguments, {.items = tiles});
  download(device, bits, result);
  return result;
}

}  // namespace luciole
