#pragma once

#include <glm/glm.hpp>
#include <string>

#include "cl/device.hpp"
#include "luciole/scene.hpp"
#include "render/render.hpp"

namespace luciole {

/// The terms of a pixel's colour as text: its surface; the contribution of each light, the brightest first,
/// by the reference in double precision and with shadow rays, with the sum so far; fog; and beside the sum
/// the device's colour, with the bits of the whole picture. Throws InputError for a pixel outside of the
/// picture and for Gouraud shading, which lights no pixels.
std::string probeText(OpenedDevice& device, const Scene& scene, RenderSettings settings,
                      const glm::ivec2& pixel);

}  // namespace luciole
