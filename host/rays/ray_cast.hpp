#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "scene/scene.hpp"

struct RTCSceneTy;  // Embree's

namespace luciole {

/// A ray meets a triangle.
struct CandidateHit {
  glm::dvec3 from;         ///< where the ray starts, in a RayScene's own space
  std::uint32_t triangle;  ///< counted through all objects in order
  double second, third;    ///< shares of its second and third corner
};

/// Whether the ray goes on as if the triangle were not there. Called by many threads at once.
using HitFilter = std::function<bool(const CandidateHit&)>;

/// A scene's triangles, ready for rays: Embree in its robust mode, where no ray slips between two triangles
/// that share an edge. Its own space is the world moved by −origin, in floats.
struct RayScene {
  glm::dvec3 origin{0.0};      ///< world
  std::vector<bool> mirrored;  ///< triangles that their object's transform turns over
  std::shared_ptr<const HitFilter> hit_filter;
  std::shared_ptr<RTCSceneTy> scene;
};

/// Without `hit_filter` every triangle is solid, whatever its material's holes.
RayScene buildRayScene(const Scene& scene, const glm::dvec3& origin, HitFilter hit_filter = {});

struct RayHit {
  double distance;         ///< metres
  bool front;              ///< the triangle's front was met
  std::uint32_t triangle;  ///< as in CandidateHit
};
/// The nearest triangle that the ray meets; `direction` is unit, both are in world space.
std::optional<RayHit> castRay(const RayScene& scene, const glm::dvec3& from, const glm::dvec3& direction);

/// Whether something is nearer than `distance` metres on the way. Otherwise as castRay.
bool isBlocked(const RayScene& scene, const glm::dvec3& from, const glm::dvec3& direction, double distance);

/// What isBlocked asks.
struct ShadowRay {
  glm::dvec3 from;       ///< world
  glm::dvec3 direction;  ///< unit, world
  double distance;       ///< metres, ≥ 0; may be infinite
};
/// isBlocked of many rays, asked 16 at once by all threads: blocked[i] becomes 1 or 0, one a ray. Fast where
/// 16 that follow each other start close together and go much the same way; right in any order.
void areBlocked(const RayScene& scene, std::span<const ShadowRay> rays, std::span<std::uint8_t> blocked);

}  // namespace luciole
