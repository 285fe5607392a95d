#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "luciole/scene.hpp"
#include "raster/geometry.hpp"
#include "raster/meshlets.hpp"

namespace luciole {

/// Meshlets to draw, with the objects that they belong to in view space.
struct PlacedMeshlets {
  const Meshlets& meshlets;
  std::span<const std::uint32_t> chosen;  ///< ascending indices into meshlets.items
  std::vector<PlacedObject> objects;      ///< those of the chosen meshlets, each once, in order
  std::vector<std::uint32_t> object_of;   ///< one a chosen meshlet: index into `objects`

  const PlacedObject& object(std::size_t i) const { return objects[object_of[i]]; }
};

/// `chosen`: ascending indices into meshlets.items. The result refers to the scene, to `meshlets` and to what
/// `chosen` points at; all must outlive it. Triangles are numbered through its objects. Throws as
/// placeObjects does.
PlacedMeshlets placeMeshlets(const Scene& scene, const Meshlets& meshlets,
                             std::span<const std::uint32_t> chosen, const glm::dmat4& world_to_view);

}  // namespace luciole
