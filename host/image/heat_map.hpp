#pragma once

#include <vector>

#include "image/compare.hpp"
#include "image/image.hpp"

namespace luciole {

/// A picture to look at, linear R G B as any: each pixel's largest difference in false colours (viridis) on a
/// logarithmic scale of the whole decades that hold them, three to six, what is smaller as the lowest. Equal
/// pixels are black, those not compared dark grey, those where one picture alone is not finite red. Small
/// pictures are enlarged by a whole factor, and under the picture is a scale bar, with labels where DejaVu Sans
/// is installed.
Image errorMap(const ImageDifference& difference);

/// How many lights each pixel goes through, row-major, as a picture of the same make, on a logarithmic scale
/// from 1 to the next power of ten that holds the largest. Pixels with none are black.
Image listMap(int width, int height, const std::vector<float>& list_lengths);

}  // namespace luciole
