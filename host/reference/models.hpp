#pragma once

#include <glm/glm.hpp>

#include "scene/model.hpp"

// What each model reflects of one light, from the papers and independently of kernels/.
namespace luciole {

/// Unit vectors at a point: the normal, the way to the light, the way to the eye.
struct Directions {
  glm::dvec3 normal{0.0}, to_light{0.0}, to_eye{0.0};
};

/// Factors of a light's diffuse and specular colour; the first is to be multiplied by the surface's diffuse
/// colour.
struct Reflected {
  double diffuse = 0;
  glm::dvec3 specular{0.0};
};

/// Of a light that the surface faces: N·L > 0. specular: the surface's colour; shininess: n ≥ 0.
Reflected reflectedLight(Model model, const Directions& directions, const glm::dvec3& specular,
                         double shininess);

/// The toon model's steps: tones for a cosine of diffuse light, and the highlight for Phong's lobe in [0, 1].
double toonTone(double cosine);
double toonHighlight(double lobe);

/// The Cook-Torrance model's specular part, for a specular colour's channel f0.
double cookTorrance(const Directions& directions, double f0, double shininess);

}  // namespace luciole
