#pragma once

#include <cmath>

#include "luciole/gbuffer.hpp"

namespace luciole {

/// Allocates the groups of planes that `planes` asks for, and position, normal and diffuse, and fills them
/// with background (see GBuffer). Reuses the memory of groups that exist. tiles_x and tiles_y must be set.
/// Throws as allocateArray does.
void allocatePlanes(PlaneSet planes, GBuffer& gbuffer);

/// Frees all groups. The G-buffer keeps its sizes and places.
void freePlanes(GBuffer& gbuffer);

inline bool isFinite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Writes the three components of a pixel. `place` is GBuffer::index, `stride` GBuffer::pixels.
inline void storePixel(const glm::vec3& value, std::size_t place, std::size_t stride, Plane& group) {
  group[place] = value.x;
  group[stride + place] = value.y;
  group[2 * stride + place] = value.z;
}

}  // namespace luciole
