#pragma once

#include <cstdint>

#include "luciole/scene.hpp"

namespace luciole {

/// A 64-bit hash of all fields of the scene, the contents of its textures and meshes included: scenes with
/// the same digest may be taken for equal. Not cryptographic. The same on every little-endian machine.
/// O(bytes of the scene).
std::uint64_t sceneDigest(const Scene& scene);

}  // namespace luciole
