#pragma once

#include <vector>

#include "luciole/light.hpp"

namespace luciole {

/// Divides a sky into `count` cells, rectangles of latitude and longitude that share ∫ L^⅔ dω evenly, L the
/// luminance: lights that stand for cells of the size a(ω) miss ∫ L √a of the light or so, which for a number
/// ∫ 1/a of them is least where 1/a ∝ L^⅔. Cells without light are left out. Those that share an edge mostly
/// follow each other, and so do halves of what was divided last. Deterministic. O(texels + cells).
std::vector<SkyCell> skyCells(const Sky& sky, std::uint32_t count);

}  // namespace luciole
