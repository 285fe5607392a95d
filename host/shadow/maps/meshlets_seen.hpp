#pragma once

#include <cstdint>
#include <vector>

#include "luciole/scene.hpp"
#include "raster/bins.hpp"
#include "raster/meshlets.hpp"
#include "raster/view.hpp"

namespace luciole {

/// The bins of a view's crop, and the depth to which each is drawn.
struct WantedBins : BinGrid {
  std::vector<float> farthest;  ///< one a bin, row by row: as in rasterizeDepth
};

/// The meshlets that may show in any of the bins, within the light's range and at a depth that matters there:
/// ascending indices into meshlets.items. `view` is the light's. Conservative, since boxes are tested: no
/// meshlet that shows is missing, but some that don't may be included. O(groups, and meshlets of the groups
/// that show).
std::vector<std::uint32_t> meshletsSeen(const Meshlets& meshlets, const View& view, const WantedBins& bins,
                                        const Light& light);

}  // namespace luciole
