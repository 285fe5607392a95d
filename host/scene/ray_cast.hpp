#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "scene/scene.hpp"

struct RTCSceneTy;  // Embree's

namespace luciole {

/// A scene's triangles, ready for rays: Embree in its robust mode, where no ray slips between two triangles
/// that share an edge. Float precision, relative to `origin`. Alpha masks count as solid.
struct RayScene {
  glm::dvec3 origin{0.0};  ///< world position of its zero
  std::shared_ptr<RTCSceneTy> scene;
};

RayScene buildRayScene(const Scene& scene, const glm::dvec3& origin);

struct RayHit {
  double distance;         ///< metres
  bool front;              ///< the triangle's front was met
  std::uint32_t triangle;  ///< counted through all objects in order
};
/// The nearest triangle that the ray meets; `direction` is unit, both are in world space.
std::optional<RayHit> castRay(const RayScene& scene, const glm::dvec3& from, const glm::dvec3& direction);

}  // namespace luciole
