#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "luciole/scene.hpp"

struct RTCSceneTy;  // Embree's

namespace luciole {

/// An intersection of a ray and a triangle, to be accepted or ignored by a HitFilter.
struct CandidateHit {
  glm::dvec3 from;         ///< where the ray starts, in a RayScene's own space
  std::uint32_t triangle;  ///< counted through all objects in order
  double second, third;    ///< barycentric weights of its second and third corner
};

/// Returns true to ignore a hit: the ray goes on as if the triangle weren't there. Called by many threads at
/// once.
using HitFilter = std::function<bool(const CandidateHit&)>;

/// A scene's triangles in Embree's tree, in its robust mode: no ray passes between two triangles that share
/// an edge. Its own space is world space moved by −origin, in float. Copies share the tree.
struct RayScene {
  glm::dvec3 origin{0.0};      ///< world
  std::vector<bool> mirrored;  ///< one a triangle: its object's transform mirrors it
  std::shared_ptr<const HitFilter> hit_filter;
  std::shared_ptr<RTCSceneTy> scene;
};

/// Builds the tree over all triangles of the scene at its pose. Corners are copied, so the scene needn't
/// outlive the result. Without `hit_filter` every triangle is solid, also where its material has holes.
/// Throws MachineError where Embree can't be started or has no memory for the triangles.
RayScene buildRayScene(const Scene& scene, const glm::dvec3& origin, HitFilter hit_filter = {});

struct RayHit {
  double distance;         ///< metres
  bool front;              ///< of the triangle's front
  std::uint32_t triangle;  ///< as in CandidateHit
};
/// The nearest hit of the ray; empty where it hits nothing. `from` and `direction` (unit) are in world space.
/// A ray with coordinates beyond 1.8e18 or NaN hits nothing.
std::optional<RayHit> castRay(const RayScene& scene, const glm::dvec3& from, const glm::dvec3& direction);

/// Whether a triangle lies on the ray within `distance` metres. Otherwise as castRay.
bool isBlocked(const RayScene& scene, const glm::dvec3& from, const glm::dvec3& direction, double distance);

/// The arguments of isBlocked.
struct ShadowRay {
  glm::dvec3 from;       ///< world
  glm::dvec3 direction;  ///< unit, world
  double distance;       ///< metres, ≥ 0; may be infinite
};
/// isBlocked for many rays, in packets of 16, by all threads: sets blocked[i] to 1 or 0. `blocked` has the
/// length of `rays`. The order changes only the speed: packets are fast where their rays start close together
/// and go in similar directions.
void areBlocked(const RayScene& scene, std::span<const ShadowRay> rays, std::span<std::uint8_t> blocked);

}  // namespace luciole
