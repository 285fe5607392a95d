#pragma once

#include <cstdint>
#include <vector>

#include "raster/view.hpp"
#include "scene/model.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Distance in metres from which the fog leaves less of any colour up to `brightest` than half an 8-bit sRGB
/// step at its finest (1/2 · 1/255 / 12.92); infinite without fog. At full brightness such a step is wider.
double fogLimit(const Fog& fog, double brightest);

/// The objects worth rasterizing: all but those that lie wholly where the fog, after `exposure` stops, brings
/// their colour to within half an 8-bit step of the background. Colours are taken as 1 or, where they may
/// be brighter, as bright as the lights that reach the object can make it by `model`, with the scene's
/// brightest emission. Where the background is farther than half a step from the fog's own colour every
/// object counts, because even a wholly fogged one hides the background.
std::vector<std::uint32_t> objectsInSight(const Scene& scene, const View& view, float exposure, Model model);

}  // namespace luciole
