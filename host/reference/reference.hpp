#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"
#include "luciole/model.hpp"
#include "luciole/scene.hpp"
#include "reference/ray_shadows.hpp"

// The lighting equations in double precision, written from the specification and the papers and independently
// of kernels/, so that pictures are compared with code that they don't share. World space throughout, metres.
namespace luciole {

/// A point on a surface and how it reflects.
struct SurfacePoint {
  glm::dvec3 position{0.0};  ///< world, metres
  glm::dvec3 normal{0.0};    ///< unit, world
  /// The normal before a map bent it, unit: what stands behind it lights nothing; or 0.
  glm::dvec3 unbent_normal{0.0};
  glm::dvec3 ambient{0.0}, diffuse{0.0}, specular{0.0}, emission{0.0};
  double shininess = 0.0;
  glm::dvec3 tangent{0.0};  ///< unit, world, across the normal: for models from files
};

/// Returns the visible share of a light, in [0, 1], at the point that is lit.
using Visibility = std::function<double(const Light& light)>;

/// Radiance that leaves the point towards the eye, before fog, by all lights of the scene: O(lights).
/// visibility is called for lights marked `shadow` that the point faces; without it nothing casts a shadow.
glm::dvec3 referenceRadiance(const Scene& scene, const Camera& camera, const SurfacePoint& point, Model model,
                             const Visibility& visibility = {});

/// The radiance that the eye sees of `radiance`, which leaves `position`, through the fog.
glm::dvec3 referenceFog(const Fog& fog, const Camera& camera, const glm::dvec3& position,
                        const glm::dvec3& radiance);

struct ReferenceSettings {
  Model model = Model::kPhong;
  bool fog = true;                        ///< false for vertices: fog is applied to their colours in pixels
  const RayScene* shadow_rays = nullptr;  ///< of this scene, by buildShadowRays; null: nothing casts a shadow
  int shadow_samples = 64;  ///< rays from a pixel to a light that has a size; one to a light without
  /// Changes the surfaces of G-buffers of a scene before they are lit, if set. surface_planes: groups that
  /// these have for it, besides those of which light is made.
  std::function<void(GBuffer& gbuffer)> change_surfaces = {};
  PlaneSet surface_planes = {};
  /// Called now and then with the number of pixels that are done, if set.
  std::function<void(std::size_t done, std::size_t pixels)> on_progress = {};
};

/// All pixels of a picture of this size, row by row from the top left.
std::vector<glm::ivec2> allPixels(const glm::ivec2& size);

/// Shades some pixels of a G-buffer, counted from its top left. Returns the linear R G B of each. The result
/// depends neither on threads nor on the other pixels asked for. Throws as validateScene(), or for a pixel
/// outside.
std::vector<glm::dvec3> referencePixels(const Scene& scene, const GBuffer& gbuffer,
                                        std::span<const glm::ivec2> pixels,
                                        const ReferenceSettings& settings);

/// The contribution of a light to the radiance that leaves a point.
struct LightTerm {
  std::size_t light = 0;    ///< of Scene::lights
  double n_dot_l = 0;       ///< the cosine between the normal and the direction to the light
  double falloff = 0;       ///< by attenuation, range and spot: a factor of all that follows
  double visibility = 0;    ///< in [0, 1], a factor of diffuse and specular already; 0 if the light is behind
  glm::dvec3 ambient{0.0};  ///< the light's own ambient light
  glm::dvec3 diffuse{0.0}, specular{0.0};

  glm::dvec3 sum() const { return (ambient + diffuse + specular) * falloff; }
};

/// All terms of a pixel's colour.
struct PixelTerms {
  SurfacePoint point;
  Model model = Model::kPhong;
  glm::dvec3 own{0.0};  ///< the scene's ambient light that it reflects; without lighting its diffuse colour
  std::vector<LightTerm> lights;  ///< those that reach the point, in the scene's order
  glm::dvec3 fog_share{1.0};      ///< transmittance of the fog, per channel; the rest is the fog's colour
  glm::dvec3 color{0.0};          ///< as referencePixels() has it
};

/// The terms of a pixel, counted from the G-buffer's top left; nothing for the background. O(lights) time
/// and, of lights that reach it, memory.
std::optional<PixelTerms> referenceTerms(const Scene& scene, const GBuffer& gbuffer, const glm::ivec2& pixel,
                                         const ReferenceSettings& settings);

/// The same, but calls `take` with each term instead of keeping it in PixelTerms::lights: no memory.
std::optional<PixelTerms> referenceTerms(const Scene& scene, const GBuffer& gbuffer, const glm::ivec2& pixel,
                                         const ReferenceSettings& settings,
                                         const std::function<void(const LightTerm&)>& take);

/// A colour's channel as pictures store it: rounded to float, at most the largest finite one.
float pictureValue(double channel);

/// All pixels of a G-buffer, as a picture with channels R G B. Throws as validateGBuffer() and
/// validateScene().
Image referenceShade(const Scene& scene, const GBuffer& gbuffer, const ReferenceSettings& settings);

}  // namespace luciole
