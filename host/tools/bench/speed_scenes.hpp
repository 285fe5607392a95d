#pragma once

#include <cstdint>

#include "luciole/gbuffer.hpp"
#include "luciole/scene.hpp"

namespace luciole {

/// A hall of columns, arches and rubble seen from inside, every surface textured: 264,000 triangles, and 1024
/// point lights with ranges. In 1280 x 720 pixels, on average 4.2 of them reach a pixel, and 12.5 reach the
/// box around what a tile of 16 x 16 pixels shows.
Scene makeHall();

/// The inside of a sphere of radius 50.1 m around the camera, with lights of range 0.3 m spread over a sphere
/// of radius 50 m: 100,000 of them leave no place dark.
Scene makeLightSphere(std::uint64_t lights);

/// A city of a square kilometre seen from above, filled evenly with lights. Their range grows with the
/// distance between them; of 1,000,000 lights about 8 reach a pixel.
Scene makeCity(std::uint64_t lights);

/// The G-buffer that the scene's first camera sees, with the groups that its lighting needs.
GBuffer gbufferOf(const Scene& scene, glm::ivec2 size);

}  // namespace luciole
