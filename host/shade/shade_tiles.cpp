#include "shade/shade_tiles.hpp"

#include <numeric>
#include <vector>

#include "cl/launch.hpp"
#include "kernels/shared.h"

namespace luciole {
namespace {

/// The fewest blocks of tiles for each thread of the device, to balance their load. PoCL gives a thread 32 at
/// a time, and fewer towards the end.
constexpr std::size_t kBlocksPerThread = 2 * 32;

std::size_t blockCount(const TileBlock& block, int tiles_x, int tiles_y) {
  const auto blocks = [](int tiles, int side) { return std::size_t((tiles + side - 1) / side); };
  return blocks(tiles_x, block.width) * blocks(tiles_y, block.height);
}

/// A stride, coprime to `count` and near its golden section, that visits all and separates neighbours.
std::size_t spreadingStride(std::size_t count) {
  auto stride = std::size_t(0.618 * double(count)) + 1;
  while (std::gcd(stride, count) > 1) ++stride;
  return stride;
}

}  // namespace

TileBlock chooseBlock(int tiles_x, int tiles_y, std::size_t threads) {
  for (const int side : {4, 2}) {
    // A single row or column of tiles is cut into pieces of it.
    const TileBlock block = tiles_y == 1   ? TileBlock{side * side, 1}
                            : tiles_x == 1 ? TileBlock{1, side * side}
                                           : TileBlock{side, side};
    if (blockCount(block, tiles_x, tiles_y) >= kBlocksPerThread * threads) return block;
  }
  return {};
}
static_assert(kBlockTiles == 4 * 4);

TileCounts shadeTiles(OpenedDevice& device, const ShadeProgram& program,
                      const ShadeTilesArguments& arguments) {
  Kernel kernel =
      makeKernel(device, "shade/shade_tiles.cl", "shade_tiles", program.defines, program.user_text);
  const GBufferBuffers& gbuffer = arguments.gbuffer;
  const std::size_t blocks = blockCount(arguments.block, arguments.tiles_x, arguments.tiles_y);
  const std::size_t runs = (blocks + kBlockRun - 1) / kBlockRun;
  std::vector<uint> counts(2 * (arguments.frame.plane_stride / kTilePixels));
  const Buffer<uint> counts_buffer = borrowedForOutput(device, counts);
  const ShadeTilesFrame frame{.shade = arguments.frame,
                              .tree_stride = uint(arguments.tree_stride),
                              .tiles_x = uint(arguments.tiles_x),
                              .tiles_y = uint(arguments.tiles_y),
                              .block_width = uint(arguments.block.width),
                              .block_height = uint(arguments.block.height),
                              .run_stride = uint(spreadingStride(runs)),
                              .pad0 = 0,
                              .pad1 = 0};
  launch(device, kernel,
         {{"frame", frame},
          {"position", gbuffer.position},
          {"normal", gbuffer.normal},
          {"diffuse", gbuffer.diffuse},
          {"specular", gbuffer.specular},
          {"ambient", gbuffer.ambient},
          {"emission", gbuffer.emission},
          {"surface_normal", gbuffer.surface_normal},
          {"model", gbuffer.model},
          {"tangent", gbuffer.tangent},
          {"tree", arguments.tree},
          {"lights", arguments.lights},
          {"luminaires", arguments.luminaires},
          {"image", arguments.image},
          {"counts", counts_buffer},
          {"faulty_pixels", arguments.faulty_pixels}},
         {.items = runs * kBlockRun});
  download(device, counts_buffer, counts);
  TileCounts sums;
  for (std::size_t tile = 0; tile < counts.size() / 2; ++tile) {
    sums.entries += counts[2 * tile];
    sums.pairs += std::uint64_t(counts[2 * tile + 1]) * std::uint64_t(device.description.lanes);
  }
  return sums;
}

}  // namespace luciole
