#pragma once

#include <glm/glm.hpp>

namespace luciole {

/// What the frames of a motion cost: sums over the last ones, of which older ones weigh less.
struct FrameCosts {
  double weight = 0, pixels = 0, milliseconds = 0;
  double pixels_squared = 0, pixels_milliseconds = 0;
};

/// Adds a frame of so many pixels that took so long from request to picture.
void addFrame(const glm::ivec2& size, double milliseconds, FrameCosts& costs);

/// The size of the next frame of a motion, of the shape of `wanted`: the largest that lets a frame take 1/25
/// s. Where not even small ones do, since most of their time is for triangles, one whose pixels take a
/// quarter of it. Without frames half of `wanted`.
glm::ivec2 frameSize(const FrameCosts& costs, const glm::ivec2& wanted);

}  // namespace luciole
