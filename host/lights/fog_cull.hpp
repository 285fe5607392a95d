#pragma once

#include <cstdint>
#include <vector>

#include "luciole/model.hpp"
#include "luciole/scene.hpp"
#include "raster/view.hpp"

namespace luciole {

/// The distance in metres beyond which fog reduces any colour up to `brightest` (linear, > 0) to less than
/// half an 8-bit sRGB step. Infinite if there is none. Steps are taken at their finest, near black: half a
/// step is 1/2 · 1/255 / 12.92.
double fogLimit(const Fog& fog, double brightest);

/// The objects that the fog doesn't hide, as ascending indices into Scene::objects. An object is hidden if
/// fog brings the colour of all of it, after `exposure` stops, to within half an 8-bit step of the
/// background. Its colour is taken as 1, or more if the lights that reach it, by `model`, and the scene's
/// brightest emission can make it brighter. No object is hidden if the background differs from the fog's
/// colour by more than half a step, because even a wholly fogged object then differs from it.
std::vector<std::uint32_t> objectsInSight(const Scene& scene, const View& view, float exposure, Model model);

}  // namespace luciole
