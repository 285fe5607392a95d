#pragma once

#include <cstdint>
#include <vector>

#include "luciole/image.hpp"

namespace luciole {

/// Dilates a map around its charts: background pixels get the mean of their 8 neighbours that are covered,
/// and become covered, `times` times. So filters and mip levels don't mix in the background. shows: 1 for
/// covered pixels, else 0, row by row. O(pixels · times), in parallel.
void dilate(Image& image, std::vector<std::uint8_t> shows, int times);

}  // namespace luciole
