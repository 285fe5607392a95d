#pragma once

#include <cstdint>
#include <string>

#include "shade/shade.hpp"

namespace luciole {

/// Tiles that a work-item takes, across and down: kBlockTiles together at most.
struct TileBlock {
  int width = 1, height = 1;
};

/// The largest blocks of which a G-buffer of that many tiles has enough for each of the device's threads.
TileBlock chooseBlock(int tiles_x, int tiles_y, std::size_t threads);

struct ShadeTilesArguments {
  const ShadeFrame& frame;
  const GBufferBuffers& gbuffer;
  int tiles_x, tiles_y;             ///< of the G-buffer
  TileBlock block;                  ///< the picture doesn't depend on it
  Buffer<const ShadeLight> lights;  ///< frame.light_count
  Buffer<const float> luminaires;   ///< see ShadeArguments
  Buffer<const float> tree;         ///< see LightTree
  std::size_t tree_stride;          ///< floats
  Buffer<float> image;              ///< out: planes r, g, b
  Buffer<uint> faulty_pixels = {};  ///< see ShadeArguments
};

/// The counts of shadeTiles().
struct TileCounts {
  std::uint64_t entries = 0;  ///< pairs of a tile and a light in reach of it
  std::uint64_t pairs = 0;    ///< pixel-light pairs that were shaded
};

/// Launches kernels/shade/shade_tiles.cl on every pixel of the G-buffer and waits for it: the same picture as
/// by cull() and shade(), without lists in memory. The program has no shadows. Throws as shade() does.
TileCounts shadeTiles(OpenedDevice& device, const ShadeProgram& program,
                      const ShadeTilesArguments& arguments);

}  // namespace luciole
