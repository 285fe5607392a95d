#pragma once

#include <glm/glm.hpp>

#include "luciole/model.hpp"

// The reflection models in double precision, written from the papers and independently of kernels/. Each
// names its paper in models.cpp.
namespace luciole {

/// Unit vectors at a point: the normal, towards the light, towards the eye.
struct Directions {
  glm::dvec3 normal{0.0}, to_light{0.0}, to_eye{0.0};
};

/// The vector at length 1; the zero vector stays.
glm::dvec3 unitOrZero(const glm::dvec3& v);

/// Factors of a light's diffuse and specular colour. The caller multiplies the first by the surface's diffuse
/// colour; the second contains the surface's specular colour.
struct Reflected {
  double diffuse = 0;
  glm::dvec3 specular{0.0};
};

/// The reflection of a light that the surface faces, N·L > 0. specular: the surface's colour; shininess: ≥ 0;
/// cell: the solid angle, sr, of the part of a source that the light stands for, as the surface sees it: what
/// is narrower is as wide as that (kernels/shade/wide_lobe.clh), and no brighter in sum.
Reflected reflectedLight(Model model, const Directions& directions, const glm::dvec3& specular,
                         double shininess, double cell = 0);

/// The toon model's steps, in [0, 1]: the tone for the cosine N·L, and the highlight for Phong's lobe.
double toonTone(double cosine);
double toonHighlight(double lobe);

/// The Oren-Nayar model's diffuse part, N·L included, for N·L > 0. The roughness is σ² = 1/(shininess + 2).
double orenNayar(const Directions& directions, double shininess);

/// The Cook-Torrance model's specular part, N·L included. f0: a channel of the specular colour.
double cookTorrance(const Directions& directions, double f0, double shininess);

/// Ward's highlight, N·L included, for N·L > 0 (factor of the specular colour). Of brushed surfaces alpha.x
/// is the roughness along the tangent, alpha.y along the bitangent: unit, at right angles to each other and
/// the normal. h·N counts as at least kLeastWardHeight.
double ward(const Directions& directions, double shininess);
double wardAnisotropic(const Directions& directions, const glm::dvec3& tangent, const glm::dvec3& bitangent,
                       const glm::dvec2& alpha);
inline constexpr double kLeastWardHeight = 0x1p-20;

}  // namespace luciole
