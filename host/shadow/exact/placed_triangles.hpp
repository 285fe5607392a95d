#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "luciole/scene.hpp"

namespace luciole {

/// A scene's triangles, counted through all objects in order, at its pose. The scene must outlive it.
struct PlacedTriangles {
  const Scene& scene;
  glm::dvec3 origin;                 ///< world; corners are relative to it
  double scale;                      ///< and multiplied by this
  std::vector<std::uint32_t> first;  ///< of each object its first triangle, and then the count of all
};

/// Places at most 2³² − 1 triangles.
PlacedTriangles placeTriangles(const Scene& scene, const glm::dvec3& origin, double scale);

/// The object that a triangle belongs to.
std::uint32_t objectOf(const PlacedTriangles& placed, std::uint32_t triangle);

/// The largest magnitude of a coordinate of placed corners.
inline constexpr double kLargestPlaced = 0x1p40;

/// The corners of a triangle of an object: (world − origin) · scale. One with a coordinate beyond
/// kLargestPlaced or NaN becomes the point 0; checkPlaces lets no such triangle into a scene.
std::array<glm::dvec3, 3> cornersOf(const PlacedTriangles& placed, std::uint32_t object,
                                    std::uint32_t triangle);

/// The index of its material.
std::uint32_t materialOfTriangle(const PlacedTriangles& placed, std::uint32_t object, std::uint32_t triangle);

/// Whether its material has holes.
bool hasHoles(const PlacedTriangles& placed, std::uint32_t object, std::uint32_t triangle);

}  // namespace luciole
