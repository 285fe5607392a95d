#pragma once

#include <cstdint>
#include <vector>

#include "luciole/model.hpp"
#include "luciole/scene.hpp"
#include "raster/view.hpp"

namespace luciole {

/// Distance in metres from which the fog leaves less than half an 8-bit sRGB step of any colour up to
/// `brightest` (linear, > 0). Infinite if the fog never does. Steps are taken at their finest, near black:
/// half a step is 1/2 · 1/255 / 12.92.
double fogLimit(const Fog& fog, double brightest);

/// The objects worth rasterizing, as ascending indices into Scene::objects: all but those that lie wholly
/// where the fog, after `exposure` stops, brings their colour to within half an 8-bit step of the background.
/// An object's colour is taken as 1, or as more if the lights that reach the object, by `model`, and the
/// scene's brightest emission can make it brighter. If the background differs from the fog's own colour by
/// more than half a step, all objects count, because even a wholly fogged one hides the background.
std::vector<std::uint32_t> objectsInSight(const Scene& scene, const View& view, float exposure, Model model);

}  // namespace luciole
