#pragma once

#include <cstdint>
#include <vector>

#include "raster/bins.hpp"
#include "raster/meshlets.hpp"
#include "raster/view.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// The bins of a view's crop, and what of them to draw.
struct WantedBins : BinGrid {
  std::vector<float> farthest;  ///< one a bin, row by row: as in rasterizeDepth
};

/// The meshlets that may show in any of the bins within a light's range, and not beyond what matters there:
/// ascending indices into meshlets.items. `view` is the light's.
/// By boxes: a meshlet that shows is never missing, one that doesn't may be there.
std::vector<std::uint32_t> meshletsSeen(const Meshlets& meshlets, const View& view, const WantedBins& bins,
                                        const Light& light);

}  // namespace luciole
