#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <stdexcept>

#include "kernels/shared.h"
#include "luciole/gbuffer.hpp"
#include "luciole/model.hpp"
#include "luciole/scene.hpp"
#include "reference/models.hpp"
#include "single_precision.hpp"

// What float may make of the lighting equation: for each pixel an interval that holds both the exact value
// and every value that shading in float may come to. Each factor of the equation is monotone in one quantity
// (a distance or a cosine) and not negative; so the error of that quantity, counted in roundings, gives the
// factor's interval, edges such as a spot's cutoff included, and intervals multiply and add end by end.
namespace luciole::test {

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

/// cosⁿ, by pow_one_plus within (|log2 cosⁿ|·5.6 + 3) units, and 0 below 2^-63.5 (a spot's: 2^-125.5).
inline Interval powerInterval(double cosine, double error, double exponent) {
  const Interval power =
      growing(cosine, error, [&](double c) { return std::pow(std::clamp(c, 0.0, 1.0), exponent); });
  const double log2 = -std::log2(std::clamp(cosine - error, 1e-300, 1.0));
  const Interval result = power.widened(std::min((exponent * log2 * 6 + 4) * kUnit, 1.0));
  return {std::max(result.low - 0x1p-63, 0.0), result.high};
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

/// A cosine that the kernels take from the chord between two unit vectors.
struct ChordCosine {
  double cosine, error;
};

/// delta: the error of the chord's vector; see PhongKernels.
inline ChordCosine chordCosine(double cosine, double delta) {
  delta = std::min(delta, 2.0);
  const double t = std::max(1 - cosine, 0.0);
  return {cosine, std::sqrt(2 * t) * delta + delta * delta + 5 * kUnit * t};
}

/// N·H; see PhongKernels for the constants.
inline ChordCosine halfCosine(const glm::dvec3& normal, const WayToLight& way, const glm::dvec3& to_eye) {
  const glm::dvec3 sum = way.unit + to_eye;
  const double length = std::max(glm::length(sum), 1e-12);
  return chordCosine(glm::dot(normal, sum / length), (way.error + 8 * kUnit) / length + 8 * kUnit);
}

/// (N·H)ⁿ; see PhongKernels for the constants.
inline Interval blinnInterval(const glm::dvec3& normal, const WayToLight& way, const glm::dvec3& to_eye,
                              double exponent) {
  const glm::dvec3 sum = way.unit + to_eye;
  const double length = std::max(glm::length(sum), 1e-12), cosine = glm::dot(normal, sum / length);
  const double square = cosine > 0 ? cosine * cosine : 0, sine2 = 1 - square;
  const double delta = std::min((way.error + 12 * kUnit) / length, 1.0);
  const double along = std::min((way.error + 24 * kUnit) / length, 1.0);
  const double error =
      2 * std::sqrt(sine2) * delta + delta * delta + along * along + (2 * along + 11 * kUnit) * sine2;
  return powerInterval(square, error, exponent / 2);
}

/// R·V
inline ChordCosine mirrorCosine(const glm::dvec3& normal, const WayToLight& way, const glm::dvec3& to_eye) {
  return chordCosine(glm::dot(2 * glm::dot(normal, way.unit) * normal - way.unit, to_eye),
                     way.error + 24 * kUnit);
}

/// The toon model's steps of a lobe or a cosine, by ToonKernels within 3 units of 1, and of 0 none.
inline Interval toonInterval(Interval x, double (*steps)(double)) {
  const Interval exact{steps(x.low), steps(x.high)};
  return {std::max(exact.low - 3 * kUnit, 0.0), exact.high > 0 ? exact.high + 3 * kUnit : 0.0};
}

/// The Cook-Torrance model, each factor monotone in one cosine. For a cosine x, q = α² + (1 − α²)·x² and
/// likewise with N·H: α² has 4 roundings with a division's, 1 − α² one more, x² and the sum 3, of positive
/// terms: 8. Its root is within 3 ulp: 4 + 6, and 1 for the sum with x. Together, with 16 for the square of
/// D's, 4 for α²·N·L and its product, 3 products, a division's 5, 2 for what F splits: 60.
inline Interval cookTorranceInterval(const glm::dvec3& normal, const WayToLight& way,
                                     const glm::dvec3& to_eye, double shininess, double f0) {
  const double alpha2 = 2 / (shininess + 2);
  const auto squared = [&](double x) { return alpha2 + (1 - alpha2) * x * x; };
  const auto smith = [&](double x) { return x + std::sqrt(squared(std::clamp(x, 0.0, 1.0))); };
  const auto positive = [](double x) { return std::clamp(x, 0.0, 1.0); };
  const ChordCosine half = halfCosine(normal, way, to_eye);
  const Interval facets = growing(half.cosine, half.error, [&](double x) {
    const double c = positive(x), spread = alpha2 * c * c + (1 - c * c);
    return alpha2 / (spread * spread);
  });
  const Interval light = growing(glm::dot(normal, way.unit), way.error + 6 * kUnit,
                                 [&](double x) { return positive(x) / smith(positive(x)); });
  const Interval eye =
      shrinking(glm::dot(normal, to_eye), 12 * kUnit, [&](double x) { return 1 / smith(positive(x)); });
  // V·H is |L + V|/2, whose vector has L's error, V's 5 units and 2 for the sum; the squares' sum, the root
  // and the difference round 8 times more.
  const Interval fresnel = shrinking(glm::length(way.unit + to_eye) / 2, way.error + 16 * kUnit,
                                     [&](double x) { return std::pow(1 - positive(x), 5); });
  const double f90 = std::min(50 * f0, 1.0);
  const Interval color = Interval{1 - fresnel.high, 1 - fresnel.low} * f0 + fresnel * f90;
  return (facets * light * eye * color).widened(60 * kUnit);
}

/// A number of the kernels' and what it may be off by.
struct Rounded {
  double value, error;

  double least() const { return std::max(std::abs(value) - error, 0.0); }
  double most() const { return std::abs(value) + error; }
};

/// Ward's highlight. x, y: the parts of h = L + V along two axes across the normal. (1 + T)·e^-P falls with
/// both and grows with h·N, for P ≥ T. What rounds in kernels/shade/ward.clh: 1/(h·N)² 2 times, 1 more with
/// N·L; 1 + T 6 times of a brushed surface, by its squares' 2, 1/(h·N)²'s 2, a product and the sum; e^-P 3
/// times; 1/(αx αy) 3 times, and 3 products: 18. Of any other surface 1 + T has 1 more and 1/α² 2 less. P has
/// 6 of the scaled squares, 3 of 1/(h·N)² and its product, and 0.3 of log2(e): 10.
inline Interval wardInterval(const glm::dvec3& normal, const WayToLight& way, const glm::dvec3& to_eye,
                             Rounded x, Rounded y, glm::dvec2 alpha) {
  const double n_dot_l = glm::dot(normal, way.unit), n_dot_v = glm::dot(normal, to_eye);
  const Interval light =
      growing(n_dot_l, way.error + 6 * kUnit, [](double cosine) { return std::max(cosine, 0.0); });
  const Interval height = growing(std::max(n_dot_l, 0.0) + std::max(n_dot_v, 0.0), way.error + 20 * kUnit,
                                  [](double h) { return std::max(h, kLeastWardHeight); });
  const auto spread = [&](double at_x, double at_y, double at_height, double sign) {
    const double power =
        (std::pow(at_x / alpha.x, 2) + std::pow(at_y / alpha.y, 2)) / (at_height * at_height);
    const double rest = std::exp(-power) * (1 + sign * std::min((18 + 10 * power) * kUnit, 1.0));
    // The kernel's 0 below 2⁻⁶³, and what double loses below 2⁻¹⁰²².
    return std::max(rest + (sign < 0 ? -0x1p-63 : 0x1p-1000), 0.0) *
           (1 + (at_x * at_x + at_y * at_y) / (at_height * at_height));
  };
  const Interval inverse{1 / (height.high * height.high), 1 / (height.low * height.low)};
  const Interval lobe{spread(x.most(), y.most(), height.low, -1),
                      spread(x.least(), y.least(), height.high, 1)};
  return light * inverse * lobe * (1 / (alpha.x * alpha.y));
}

/// The vector h − (h·N)·N has L's error, V's 5 units, 2 of the sum and 2 of the difference. Along N is left
/// what h·N and N's length are off by.
inline Interval wardInterval(const glm::dvec3& normal, const WayToLight& way, const glm::dvec3& to_eye,
                             double shininess) {
  const glm::dvec3 sum = way.unit + to_eye;
  const double across = glm::length(sum - glm::dot(normal, sum) * normal);
  return wardInterval(normal, way, to_eye, {across, way.error + 12 * kUnit}, {0, way.error + 40 * kUnit},
                      glm::dvec2(std::sqrt(2 / (shininess + 2))));
}

/// h·X has L's error, V's 5 units, 2 of the sum, 6 of the product and 8 of X's length.
inline Interval wardAnisotropicInterval(const glm::dvec3& normal, const WayToLight& way,
                                        const glm::dvec3& to_eye, const glm::dvec3& tangent,
                                        const glm::dvec3& bitangent, const glm::dvec2& alpha) {
  const glm::dvec3 sum = way.unit + to_eye;
  const double error = way.error + 24 * kUnit;
  return wardInterval(normal, way, to_eye, {glm::dot(sum, tangent), error}, {glm::dot(sum, bitangent), error},
                      alpha);
}

/// The Oren-Nayar model's diffuse part, A·x + B·max(L·V − x·v, 0)·x/max(x, v) with x = N·L and v = N·V. The
/// directions' errors are those of the cosines. A and B round 6 times each, and 8 roundings join all.
inline Interval orenNayarInterval(const glm::dvec3& normal, const WayToLight& way, const glm::dvec3& to_eye,
                                  double shininess) {
  const auto positive = [](double x) { return std::max(x, 0.0); };
  const Interval x = growing(glm::dot(normal, way.unit), way.error + 6 * kUnit, positive),
                 v = growing(glm::dot(normal, to_eye), 12 * kUnit, [](double c) { return c; });
  const double together = glm::dot(way.unit, to_eye), error = way.error + 16 * kUnit;
  const Interval product{std::min(x.low * v.low, x.high * v.low), std::max(x.low * v.high, x.high * v.high)};
  const Interval s{positive(together - error - product.high), positive(together + error - product.low)};
  const Interval share{x.low < v.high ? x.low / v.high
                       : x.low > 0    ? 1.0
                                      : 0.0,
                       x.high < v.low ? x.high / v.low : 1.0};
  const double sigma2 = 1 / (shininess + 2);
  const double a = 1 - 0.5 * sigma2 / (sigma2 + 0.33), b = 0.45 * sigma2 / (sigma2 + 0.09);
  return (x * a + s * share * b).widened(14 * kUnit);
}

/// Intervals of reflectedLight(): channel f0 of the specular colour.
struct ReflectedInterval {
  Interval diffuse, specular;
};
inline ReflectedInterval reflectedInterval(Model model, const glm::dvec3& normal, const WayToLight& way,
                                           const glm::dvec3& to_eye, double shininess, double f0) {
  const Interval cosine =
      growing(glm::dot(normal, way.unit), way.error + 6 * kUnit, [](double x) { return std::max(x, 0.0); });
  const auto lobe = [&](ChordCosine of) { return powerInterval(of.cosine, of.error, shininess); };
  switch (model) {
    case Model::kPhong:
      return {cosine, lobe(mirrorCosine(normal, way, to_eye)) * f0};
    case Model::kBlinnPhong:
      return {cosine, blinnInterval(normal, way, to_eye, shininess) * f0};
    case Model::kToon:
      return {toonInterval(cosine, toonTone),
              toonInterval(lobe(mirrorCosine(normal, way, to_eye)), toonHighlight) * f0};
    case Model::kCookTorrance:
      return {cosine, cookTorranceInterval(normal, way, to_eye, shininess, f0)};
    case Model::kOrenNayar:
      return {orenNayarInterval(normal, way, to_eye, shininess),
              lobe(mirrorCosine(normal, way, to_eye)) * f0};
    case Model::kWard:
      return {cosine, wardInterval(normal, way, to_eye, shininess) * f0};
  }
  throw std::logic_error("a model without an interval");
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

/// The interval of channel `c` of what the eye sees at `place`, a covered pixel, without shadows. model: of
/// surfaces that choose none.
inline Interval shadeInterval(const Scene& scene, const GBuffer& gbuffer, std::size_t place, int c,
                              Model model) {
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
      const double cosine = glm::dot(normal, way.unit), error = way.error + 6 * kUnit;
      Interval reflected{0, 0};
      if (cosine + error > 0) {
        const Model own = modelOfNumber(gbuffer.model.empty() ? 0 : gbuffer.model[place], model);
        const auto [tone, glint] = reflectedInterval(
            own, normal, way, to_eye, gbuffer.specular[place + 3 * n], triple(gbuffer.specular)[c]);
        const Interval highlight = glint * double(light.specular[c]);
        reflected = tone * (double(light.diffuse[c]) * diffuse) +
                    Interval{cosine - error > 0 ? highlight.low : 0, highlight.high};
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
