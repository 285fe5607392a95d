#pragma once

#include <cstdint>
#include <vector>

#include "luciole/image.hpp"

namespace luciole {

/// Gives pixels that show nothing the mean of those of their 8 neighbours that do, and so on outwards,
/// `times` times: so filters and smaller copies of a map don't mix in what lies between its charts. shows: 1
/// or 0 for each pixel, row by row. O(pixels · times), in parallel.
void dilate(Image& image, std::vector<std::uint8_t> shows, int times);

}  // namespace luciole
