#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "kernels/shared.h"
#include "raster/gbuffer.hpp"
#include "scene/scene.hpp"

// What float may make of the lighting equation: for each pixel an interval that holds both the exact value
// and every value that shading in float may come to. Each factor of the equation is monotone in one quantity
// (a distance or a cosine) and not negative; so the error of that quantity, counted in roundings, gives the
// factor's interval, edges such as a spot's cutoff included, and intervals multiply and add end by end.
namespace luciole::test {

inline constexpr double kUnit = 0x1p-24;  ///< the relative error of one rounding

struct Interval {
  double low = 0, high = 0;

  Interval widened(double relative) const { return {low * (1 - relative), high * (1 + relative)}; }
};
inline Interval operator*(Interval a, Interval b) { return {a.low * b.low, a.high * b.high}; }
inline Interval operator*(Interval a, double b) { return {a.low * b, a.high * b}; }
inline Interval operator+(Interval a, Interval b) { return {a.low + b.low, a.high + b.high}; }

/// The interval of a function that grows, for x ± error.
template <class Function>
Interval growing(double x, double error, Function function) {
  return {function(x - error), function(x + error)};
}
template <class Function>
Interval shrinking(double x, double error, Function function) {
  return {function(x + error), function(x - error)};
}

/// The way to a light in view space; `error`: of the unit vector, as a length.
struct WayToLight {
  glm::dvec3 unit;
  double distance = 0, distance_error = 0, error = 0;
};

inline WayToLight wayToLight(const Light& light, const glm::dmat4& to_view, const glm::dvec3& position) {
  if (light.kind == LightKind::kDirectional)
    return {-(glm::dmat3(to_view) * light.direction), 0, 0, 2 * kUnit};
  const glm::dvec3 place(to_view * glm::dvec4(light.position, 1));
  const double distance = glm::length(place - position);
  // The light's place and the difference round; d² rounds 3 times more; the reciprocal root is within 3 ulp,
  // 6 roundings.
  return {(place - position) / distance, distance, kUnit * (glm::length(place) + 3 * distance),
          kUnit * (glm::length(place) / distance + 10)};
}

inline Interval windowInterval(const Light& light, const WayToLight& way) {
  // The ratio has 1/range²'s rounding, a product's, and its square's; the difference one more: 8.
  Interval fade = shrinking(way.distance, way.distance_error,
                            [&](double d) { return 1 - std::pow(std::max(d, 0.0) / light.range, 4); });
  fade = {std::max(fade.low - 8 * kUnit, 0.0), std::max(fade.high + 8 * kUnit, 0.0)};
  return light.window == RangeWindow::kSmooth ? (fade * fade).widened(kUnit) : fade;
}

inline Interval attenuationInterval(const Light& light, const WayToLight& way) {
  // See FalloffKernels.AttenuationIsOpenGLs.
  return shrinking(way.distance, way.distance_error,
                   [&](double d) {
                     return 1 / (light.attenuation.x + light.attenuation.y * d + light.attenuation.z * d * d);
                   })
      .widened(20 * kUnit);
}

/// cosⁿ, by pow_one_minus_half within (|log2 cosⁿ|·4.8 + 3) units, and 0 below 2^-125.5.
inline Interval powerInterval(double cosine, double error, double exponent) {
  const Interval power =
      growing(cosine, error, [&](double c) { return std::pow(std::clamp(c, 0.0, 1.0), exponent); });
  const double log2 = -std::log2(std::clamp(cosine - error, 1e-300, 1.0));
  const Interval result = power.widened(std::min((exponent * log2 * 5 + 4) * kUnit, 1.0));
  return {std::max(result.low - 0x1p-125, 0.0), result.high};
}

inline Interval spotInterval(const Light& light, const glm::dmat4& to_view, const WayToLight& way) {
  const double cosine = glm::dot(-way.unit, glm::dmat3(to_view) * light.direction);
  const double error = way.error + 8 * kUnit;  // the axis, the product and the edge round
  const double edge = std::cos(light.cutoff);
  Interval strength{1, 1};
  if (light.falloff == SpotFalloff::kExponent) {
    strength = powerInterval(cosine, error, light.exponent);
  } else {
    strength = growing(cosine, error, [&](double c) {
      const double ramp = std::clamp((c - edge) / (std::cos(light.inner_cone) - edge), 0.0, 1.0);
      return ramp * ramp;
    });
  }
  if (cosine - error < edge) strength.low = 0;
  if (cosine + error < edge) strength.high = 0;
  return strength.widened(8 * kUnit);
}

/// See PhongKernels for the constants.
inline Interval lobeInterval(const glm::dvec3& normal, const WayToLight& way, const glm::dvec3& to_eye,
                             double shininess, bool blinn) {
  double cosine, delta;
  if (blinn) {
    const glm::dvec3 sum = way.unit + to_eye;
    const double length = std::max(glm::length(sum), 1e-12);
    cosine = glm::dot(normal, sum / length);
    delta = (way.error + 8 * kUnit) / length + 8 * kUnit;
  } else {
    cosine = glm::dot(2 * glm::dot(normal, way.unit) * normal - way.unit, to_eye);
    delta = way.error + 24 * kUnit;
  }
  delta = std::min(delta, 2.0);
  const double t = std::max(1 - cosine, 0.0);
  return powerInterval(cosine, std::sqrt(2 * t) * delta + delta * delta + 5 * kUnit * t, shininess);
}

inline Interval fogInterval(const Fog& fog, double density, double distance) {
  const double error = (fog.radial ? 10 * kUnit : 0) * distance;
  if (fog.mode == FogMode::kNone) return {1, 1};
  if (fog.mode == FogMode::kLinear) {
    const double length = double(fog.end) - fog.start;
    const double rounding = (error + 4 * kUnit * std::abs(fog.end - distance)) / length;
    return growing((fog.end - distance) / length, rounding,
                   [](double share) { return std::clamp(share, 0.0, 1.0); });
  }
  const double depth = density * distance;
  const double exponent = fog.mode == FogMode::kExp ? depth : depth * depth;
  // log2(e), two products and for exp2 the square round, the distance's error doubled by it.
  const Interval share = shrinking(exponent, exponent * 24 * kUnit, [](double x) { return std::exp(-x); });
  const Interval result = share.widened(4 * kUnit);
  return {std::max(result.low - 0x1p-125, 0.0), std::min(result.high, 1 + 4 * kUnit)};
}

/// The interval of channel `c` of what the eye sees at `place`, a covered pixel, without shadows.
inline Interval shadeInterval(const Scene& scene, const GBuffer& gbuffer, std::size_t place, int c,
                              bool blinn) {
  const std::size_t n = gbuffer.pixels();
  const auto triple = [&](const Plane& group) {
    return glm::dvec3(group[place], group[place + n], group[place + 2 * n]);
  };
  const glm::dvec3 position = triple(gbuffer.position), normal = glm::normalize(triple(gbuffer.normal));
  const glm::dvec3 to_eye = gbuffer.camera.orthographic ? glm::dvec3(0, 0, 1) : -glm::normalize(position);
  const glm::dmat4 to_view = glm::inverse(gbuffer.camera.camera_to_world);
  const double emission = triple(gbuffer.emission)[c], diffuse = triple(gbuffer.diffuse)[c];
  Interval seen{emission, emission};
  if (!scene.lighting) {
    seen = seen + Interval{diffuse, diffuse};
  } else {
    const double ambient = scene.ambient[c] * triple(gbuffer.ambient)[c];
    seen = seen + Interval{ambient, ambient};
    for (const Light& light : scene.lights) {
      const WayToLight way = wayToLight(light, to_view, position);
      Interval strength{1, 1};
      if (light.kind != LightKind::kDirectional)
        strength = windowInterval(light, way) * attenuationInterval(light, way);
      if (light.kind == LightKind::kSpot) strength = strength * spotInterval(light, to_view, way);
      if (strength.high == 0) continue;
      const Interval cosine = growing(glm::dot(normal, way.unit), way.error + 6 * kUnit,
                                      [](double x) { return std::max(x, 0.0); });
      Interval reflected = cosine * (double(light.diffuse[c]) * diffuse);
      if (cosine.high > 0) {
        const Interval lobe = lobeInterval(normal, way, to_eye, gbuffer.specular[place + 3 * n], blinn);
        const Interval highlight = lobe * (double(light.specular[c]) * triple(gbuffer.specular)[c]);
        reflected = reflected + Interval{cosine.low > 0 ? highlight.low : 0, highlight.high};
      }
      const double light_ambient = double(light.ambient[c]) * triple(gbuffer.ambient)[c];
      seen = seen + strength * (reflected + Interval{light_ambient, light_ambient});
    }
  }
  // Sums of positive terms: one rounding a light, but no more than kernels/long_sum.clh states, and a dozen
  // for the products with the light and the material.
  seen = seen.widened((std::min(double(scene.lights.size()), double(kSumBlock) + 4) + 12) * kUnit);
  const double distance = scene.fog.radial ? glm::length(position) : -position.z;
  const Interval share = fogInterval(scene.fog, scene.fog.density[c], distance);
  const Interval fogged{std::max(1 - share.high - kUnit, 0.0), 1 - share.low + kUnit};
  if (scene.fog.mode == FogMode::kNone) return seen;
  return (seen * share + fogged * double(scene.fog.color[c])).widened(4 * kUnit);
}

}  // namespace luciole::test
