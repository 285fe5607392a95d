#pragma once

#include <cstdint>
#include <vector>

#include "raster/view.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Distance in metres from which the fog leaves less of any colour in [0, 1], brightened by `exposure` stops,
/// than half an 8-bit sRGB step at its finest (1/2 · 1/255 / 12.92); infinite without fog. Half such a step
/// at full brightness is wider.
double fogLimit(const Fog& fog, float exposure);

/// The objects worth rasterizing: all but those wholly beyond fogLimit. Where the background is not the fog's
/// own colour every object counts, because even a wholly fogged one hides the background.
std::vector<std::uint32_t> objectsInSight(const Scene& scene, const View& view, float exposure);

}  // namespace luciole
