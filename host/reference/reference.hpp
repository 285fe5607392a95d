#pragma once

#include <glm/glm.hpp>

#include "image/image.hpp"
#include "raster/gbuffer.hpp"
#include "scene/scene.hpp"

// The lighting equations in double precision, written from the textbooks and independently of kernels/: what
// judges a picture shares no code with it. World space throughout.
namespace luciole {

/// A point on a surface and how it reflects.
struct SurfacePoint {
  glm::dvec3 position{0.0};  ///< world, metres
  glm::dvec3 normal{0.0};    ///< unit, world
  glm::dvec3 ambient{0.0}, diffuse{0.0}, specular{0.0}, emission{0.0};
  double shininess = 0.0;
};

/// Radiance that leaves the point towards the eye, before fog, without shadows: every light of the scene, no
/// culling.
glm::dvec3 referenceRadiance(const Scene& scene, const Camera& camera, const SurfacePoint& point, bool blinn);

/// What the eye sees of `radiance` through the scene's fog.
glm::dvec3 referenceFog(const Fog& fog, const Camera& camera, const glm::dvec3& position,
                        const glm::dvec3& radiance);

/// The whole G-buffer shaded so: channels R G B.
Image referenceShade(const Scene& scene, const GBuffer& gbuffer, bool blinn);

}  // namespace luciole
