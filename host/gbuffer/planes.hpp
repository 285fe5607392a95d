#pragma once

#include "gbuffer/gbuffer.hpp"

namespace luciole {

/// Gives a G-buffer, whose tiles are set, the groups of planes it needs, showing nothing.
void allocatePlanes(PlaneSet planes, GBuffer& gbuffer);

/// Writes a value of three components, at a place as by GBuffer::index.
inline void storePixel(const glm::vec3& value, std::size_t place, std::size_t stride, Plane& group) {
  group[place] = value.x;
  group[stride + place] = value.y;
  group[2 * stride + place] = value.z;
}

}  // namespace luciole
