#pragma once

#include <cstdint>
#include <vector>

#include "raster/view.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Distance in metres from which the fog leaves less of any colour up to `brightest` than half an 8-bit sRGB
/// step at its finest (1/2 · 1/255 / 12.92); infinite without fog. At full brightness such a step is wider.
double fogLimit(const Fog& fog, double brightest);

/// The objects worth rasterizing: all but those wholly beyond fogLimit, for surfaces lit up to 1, or as
/// bright as the brightest emission of the scene's materials, after `exposure` stops. Where the background is
/// not the fog's own colour every object counts, because even a wholly fogged one hides the background.
std::vector<std::uint32_t> objectsInSight(const Scene& scene, const View& view, float exposure);

}  // namespace luciole
