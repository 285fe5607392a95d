#pragma once

#include "render/render.hpp"

namespace luciole {

/// See Renderer::chooseLightCounts().
double chooseLightCounts(OpenedDevice& device, Scene& scene, const RenderSettings& settings, Stats& stats,
                         KeptPicture* kept);

}  // namespace luciole
