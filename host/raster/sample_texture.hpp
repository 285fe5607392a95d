#pragma once

#include <glm/glm.hpp>

#include "scene/scene.hpp"

namespace luciole {

/// Trilinear lookup: linear RGB and alpha at `uv`, filtered over the footprint of a pixel, whose sides in
/// texture coordinates are duv_dx and duv_dy (any finite size; zero: the finest level). The level follows the
/// longer side, as OpenGL does. Non-finite coordinates read as 0.
glm::vec4 sampleTexture(const Texture& texture, Wrap wrap_u, Wrap wrap_v, glm::vec2 uv, glm::vec2 duv_dx,
                        glm::vec2 duv_dy);

}  // namespace luciole
