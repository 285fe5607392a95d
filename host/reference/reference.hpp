#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gbuffer/gbuffer.hpp"
#include "image/image.hpp"
#include "reference/ray_shadows.hpp"
#include "scene/model.hpp"
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

/// The share of a light that reaches the point which is being lit, in [0, 1].
using Visibility = std::function<double(const Light& light)>;

/// Radiance that leaves the point towards the eye, before fog: every light of the scene, no culling. Lights
/// marked `shadow` are asked for their visibility where it matters; without one nothing casts a shadow.
glm::dvec3 referenceRadiance(const Scene& scene, const Camera& camera, const SurfacePoint& point, Model model,
                             const Visibility& visibility = {});

/// What the eye sees of `radiance` through the scene's fog.
glm::dvec3 referenceFog(const Fog& fog, const Camera& camera, const glm::dvec3& position,
                        const glm::dvec3& radiance);

struct ReferenceSettings {
  Model model = Model::kPhong;
  bool fog = true;                        ///< false for vertices, whose colours meet the fog as pixels
  const RayScene* shadow_rays = nullptr;  ///< of this scene, by buildShadowRays; null: nothing casts a shadow
  int shadow_samples = 64;  ///< rays from a pixel to a light that has a size; one to a light without
  /// Called now and then, if set.
  std::function<void(std::size_t done, std::size_t pixels)> on_progress = {};
};

/// Every pixel of a picture, row by row.
std::vector<glm::ivec2> allPixels(const glm::ivec2& size);

/// Some pixels of a G-buffer shaded so, linear R G B each; (x, y) counted from its top left. On all cores;
/// the result depends neither on their number nor on which other pixels are asked for.
std::vector<glm::dvec3> referencePixels(const Scene& scene, const GBuffer& gbuffer,
                                        std::span<const glm::ivec2> pixels,
                                        const ReferenceSettings& settings);

/// A colour's channel as pictures keep it: in float, the largest where it is more.
float pictureValue(double channel);

/// The whole of it: channels R G B.
Image referenceShade(const Scene& scene, const GBuffer& gbuffer, const ReferenceSettings& settings);

}  // namespace luciole
