#pragma once

#include "luciole/scene.hpp"

namespace luciole {

/// Whether a material has a normal map.
bool hasNormalMaps(const Scene& scene);

/// addTangents() for one mesh and the triangles for which `wanted` is true.
void addTangents(const std::vector<bool>& wanted, Mesh& mesh, bool across_seams = false);

}  // namespace luciole
