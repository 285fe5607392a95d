#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "luciole/array_memory.hpp"
#include "raster/bins.hpp"
#include "raster/coverage.hpp"
#include "raster/sample_pattern.hpp"
#include "raster/setup.hpp"

namespace luciole {

/// Depth and label of all samples of some rows of a bin: row by row, pixel by pixel, SamplePattern::stride
/// entries each.
struct StripSamples {
  int first_row = 0;              ///< in the bin
  RawArray<float> depth;          ///< reversed; 0: nothing
  RawArray<std::uint32_t> label;  ///< the triangle's number, or kNoTriangle

  /// The labels of a pixel's samples. `in_bin`: the pixel, from the bin's top left one.
  const std::uint32_t* labels(const glm::ivec2& in_bin, const SamplePattern& pattern) const {
    return label.data() +
           (std::size_t(in_bin.y - first_row) * kBinSize + in_bin.x) * std::size_t(pattern.stride);
  }
};

/// The number of rows of a bin that are drawn together: as many as fit into a core's cache, at least 1. It
/// divides kBinSize.
int stripRows(const SamplePattern& pattern);

/// Draws the triangles of stripRows() rows of a bin, from `first_row` on: at each sample the nearer wins, and
/// at equal depth the one with the lower number. The triangles are those of a view with the pattern's origin
/// and reach, and `holes.plane` is that view's. `covering`: as in drawBin().
void drawStrip(std::span<const RasterTriangle> triangles, const Bins& bins, int bin, int first_row,
               const HoleTest& holes, const SamplePattern& pattern, std::span<std::uint8_t> covering,
               StripSamples& samples);

}  // namespace luciole
