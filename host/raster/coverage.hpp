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

/// Depth and label of a bin's pixels, row by row.
struct BinPixels {
  alignas(64) std::array<float, kBinSize * kBinSize> depth;          ///< reversed; 0: nothing
  alignas(64) std::array<std::uint32_t, kBinSize * kBinSize> label;  ///< the triangle's number, or its slopes
};

/// The input of the test for holes of alpha-masked and blended triangles.
struct HoleTest {
  const Scene& scene;
  const std::vector<PlacedObject>& objects;
  const ViewPlane& plane;
  /// The sample that is drawn, for blended surfaces. Empty for a depth map: then blended surfaces are masked.
  std::optional<SampleNumber> sample;
};

/// Draws a bin's triangles: the nearer wins, and at equal depth the one with the lower number. Labels are the
/// triangles' numbers, or kNoTriangle. Samples outside the crop are undefined. `covering` has an entry for
/// each triangle, which is set to 1 if the triangle covers a sample, visible or not.
void drawBin(std::span<const RasterTriangle> triangles, const Bins& bins, int bin, const HoleTest& holes,
             std::span<std::uint8_t> covering, BinPixels& pixels);

/// The same for a depth map, whose labels are slopes (packSlopes) of what was drawn, or 0.
void drawBinDepth(std::span<const RasterTriangle> triangles, const Bins& bins, int bin, const HoleTest& holes,
                  BinPixels& pixels);

/// A triangle's steps of reversed depth a pixel, right (high half) and down, each rounded to a float's upper
/// 16 bits: within 2⁻⁸ of its value.
std::uint32_t packSlopes(float dx, float dy);

}  // namespace luciole
