#pragma once

#include <string>
#include <vector>

#include "luciole/compare.hpp"
#include "luciole/image.hpp"

namespace luciole {

/// Draws each pixel's largest difference in false colours (viridis), as linear R G B. The scale is
/// logarithmic, over the three to six whole decades up to the largest difference; smaller differences have
/// its lowest colour. Equal pixels are black, those not compared dark grey, those where one picture alone is
/// not finite red. Small pictures are enlarged by a whole factor. Below the picture is a scale bar, with
/// labels where DejaVu Sans is installed.
Image errorMap(const ImageDifference& difference);

/// Draws how many lights each pixel's list has, in the same way. `list_lengths`: one a pixel, row-major. The
/// scale is logarithmic, from 1 to the power of ten at or above the largest. Pixels without lights are black.
Image listMap(int width, int height, const std::vector<float>& list_lengths);

/// Draws bounds of each pixel's error in the same way. `bounds`: one a pixel, row-major, linear. The scale is
/// the same for all pictures, so that the colours of several compare: logarithmic, from 10⁻⁵ to 10⁻¹, whose
/// ends stand for what lies beyond. Pixels without a bound are black.
Image boundMap(int width, int height, const std::vector<float>& bounds);

/// Numbers to draw, one a pixel, row-major, and what to write below them.
struct ValuePanel {
  std::string label;
  std::vector<float> values;
};

/// Draws numbers of any kind in the same way: panels of one size in rows of `columns`, with one scale and one
/// bar, from the least finite value to the largest. The scale is linear, but logarithmic where half of the
/// values would lie in its first quarter, about; with zeros, which then are black, half of the others in the
/// first twentieth. Infinite values are dark grey, NaN red. A single panel has no label.
Image valueSheet(int width, int height, const std::vector<ValuePanel>& panels, int columns,
                 const std::string& title);

}  // namespace luciole
