#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "raster/bins.hpp"
#include "raster/opacity.hpp"
#include "raster/setup.hpp"
#include "raster/surface.hpp"

namespace luciole {

/// What the samples of a bin see, row by row.
struct BinPixels {
  alignas(64) std::array<float, kBinSize * kBinSize> depth;             ///< reversed; 0: nothing
  alignas(64) std::array<std::uint32_t, kBinSize * kBinSize> triangle;  ///< or kNoTriangle
};

/// What it takes to look for holes in triangles.
struct HoleTest {
  const Scene& scene;
  const Geometry& geometry;
  const ViewPlane& plane;
};

/// Draws a bin's triangles: the nearer wins, and at equal depth the one with the lower number. Samples beyond
/// the crop are drawn too, at whim. `covering` has one entry a triangle, which is set to 1 where the triangle
/// covers a sample, seen or not.
void drawBin(std::span<const RasterTriangle> triangles, const Bins& bins, int bin, const HoleTest& holes,
             std::span<std::uint8_t> covering, BinPixels& pixels);

/// The same for depth alone.
void drawBinDepth(std::span<const RasterTriangle> triangles, const Bins& bins, int bin, const HoleTest& holes,
                  BinPixels& pixels);

}  // namespace luciole
