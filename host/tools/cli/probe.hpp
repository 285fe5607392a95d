#pragma once

#include <glm/glm.hpp>
#include <string>

#include "cl/device.hpp"
#include "luciole/scene.hpp"
#include "render/render.hpp"

namespace luciole {

/// What makes a pixel of the picture of these settings, as text: its surface, what each light adds by the
/// reference, in double precision and with shadows by ray, the brightest first, and the sum so far; fog; and
/// beside the sum the colour that the device makes, whose bits are those of the whole picture. Throws
/// InputError for a pixel outside of the picture and for Gouraud shading, which lights no pixels.
std::string probeText(OpenedDevice& device, const Scene& scene, RenderSettings settings,
                      const glm::ivec2& pixel);

}  // namespace luciole
