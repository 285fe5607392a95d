#pragma once

#include <cstdint>

#include "scene/scene.hpp"

namespace luciole {

/// A number that changes with every field of the scene, the contents of its textures and meshes included: two
/// scenes of one digest are the same one. The same on every machine.
std::uint64_t sceneDigest(const Scene& scene);

}  // namespace luciole
