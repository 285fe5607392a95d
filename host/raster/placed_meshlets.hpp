#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "raster/geometry.hpp"
#include "raster/meshlets.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Runs of triangles to draw, with the objects that they belong to.
struct PlacedMeshlets {
  const Meshlets& meshlets;
  std::span<const std::uint32_t> chosen;  ///< ascending indices into meshlets.items
  std::vector<PlacedObject> objects;      ///< each once, in order
  std::vector<std::uint32_t> object_of;   ///< one a chosen meshlet: index into `objects`

  const PlacedObject& object(std::size_t i) const { return objects[object_of[i]]; }
};

/// Takes what `meshlets` and `chosen` refer to, which must outlive the result. Triangles are numbered through
/// the objects, see placeObjects, which may throw.
PlacedMeshlets placeMeshlets(const Scene& scene, const Meshlets& meshlets,
                             std::span<const std::uint32_t> chosen, const glm::dmat4& world_to_view);

}  // namespace luciole
