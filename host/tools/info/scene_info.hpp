#pragma once

#include <cstdint>
#include <optional>

#include "luciole/scene.hpp"
#include "scene/bounds.hpp"

namespace luciole {

/// How many lights of a scene there are of each kind. Lights that are switched off aren't in a scene.
struct LightCounts {
  std::size_t point = 0, directional = 0, spot = 0;
  std::size_t casting = 0;     ///< of all kinds: those that cast shadows
  std::size_t everywhere = 0;  ///< of all kinds: those whose range is infinite
};

/// The first and the last frame with a key.
struct KeyFrames {
  double first = 0, last = 0;
};

/// Numbers about a scene.
struct SceneInfo {
  std::uint64_t triangles = 0;       ///< as drawn: an object has those of its mesh
  std::uint64_t mesh_triangles = 0;  ///< as stored: each mesh once
  std::size_t meshes = 0;            ///< that have triangles
  std::uint64_t texels = 0;          ///< of the textures as their files have them, without smaller levels
  LightCounts lights;
  Bounds bounds;  ///< at the scene's pose
  std::optional<KeyFrames> moves;
};

/// O(vertices of all objects).
SceneInfo sceneInfo(const Scene& scene);

}  // namespace luciole
