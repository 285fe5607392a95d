#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "raster/bins.hpp"
#include "raster/opacity.hpp"
#include "raster/setup.hpp"
#include "raster/surface.hpp"

namespace luciole {

/// What the samples of a bin see, row by row.
struct BinPixels {
  alignas(64) std::array<float, kBinSize * kBinSize> depth;          ///< reversed; 0: nothing
  alignas(64) std::array<std::uint32_t, kBinSize * kBinSize> label;  ///< the triangle, or its slopes
};

/// What the test for holes of alpha-masked and blended triangles needs.
struct HoleTest {
  const Scene& scene;
  const std::vector<PlacedObject>& objects;
  const ViewPlane& plane;
  /// Of each pixel, where one is drawn. None for a depth map, which knows masks alone.
  std::optional<SampleNumber> sample;
};

/// Draws a bin's triangles: the nearer wins, and at equal depth the one with the lower number. Labels are the
/// triangles' numbers, or kNoTriangle. Samples of the bin outside the crop may be drawn too; their content
/// means nothing. `covering` has one entry a triangle, which is set to 1 where the triangle covers a sample,
/// seen or not.
void drawBin(std::span<const RasterTriangle> triangles, const Bins& bins, int bin, const HoleTest& holes,
             std::span<std::uint8_t> covering, BinPixels& pixels);

/// The same for a depth map, whose labels are slopes (packSlopes) of what was drawn, or 0.
void drawBinDepth(std::span<const RasterTriangle> triangles, const Bins& bins, int bin, const HoleTest& holes,
                  BinPixels& pixels);

/// A triangle's steps of reversed depth a pixel, right (high half) and down, each rounded to a float's upper
/// 16 bits: within 2⁻⁸ of its value.
std::uint32_t packSlopes(float dx, float dy);

}  // namespace luciole
