#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "raster/geometry.hpp"
#include "raster/triangle_runs.hpp"
#include "scene/scene.hpp"

namespace luciole {

/// Runs of triangles to draw, with the objects that they belong to.
struct PlacedRuns {
  const TriangleRuns& runs;
  std::span<const std::uint32_t> chosen;  ///< ascending indices into runs.runs
  std::vector<PlacedObject> objects;      ///< each once, in order
  std::vector<std::uint32_t> object_of;   ///< one a chosen run: index into `objects`

  const PlacedObject& object(std::size_t i) const { return objects[object_of[i]]; }
};

/// Takes what `runs` and `chosen` refer to, which must outlive the result. Triangles are numbered through the
/// objects, see placeObjects, which may throw.
PlacedRuns placeRuns(const Scene& scene, const TriangleRuns& runs, std::span<const std::uint32_t> chosen,
                     const glm::dmat4& world_to_view);

}  // namespace luciole
