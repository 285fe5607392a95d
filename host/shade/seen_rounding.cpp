#include "shade/seen_rounding.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace luciole {
namespace {

constexpr double kRounding = 0x1p-24;

/// Relative error of a colour by sums and products after clustered light. There are at most four roundings of
/// 2⁻²⁴: the sums with the surface's emission and with other lights, the fog's own light, and their sum
/// (fog.clh). All terms are ≥ 0, so none exceeds the colour, except by later roundings, which a fifth 2⁻²⁴
/// covers.
constexpr double kSeenRounding = 5 * kRounding;

/// Error of a colour by rounding of the fog's transmittance, relative to the larger of 1 and the colour, and
/// to the fog's brightest channel. Where the transmittance is e⁻⁴ or more it is at most 3 + 15.23·4 < 64
/// roundings, and for the fog's own light 3 + 15.23/e < 9. Linear fog that ends soon after it starts, and
/// bright light through thick fog, may exceed this. Their bounds, computed from the actual error, then exceed
/// the light_error asked for.
constexpr double kFogRounding = 64 * kRounding;

glm::dvec3 rgb(const float4& color) { return {color.x, color.y, color.z}; }

/// Upper bound of the error of linear fog's transmittance: five roundings of a difference, its scale and
/// their product, and the effect of the distance's relative error `distance_error`.
double linearShareError(const ShadeFrame& frame, double distance, double distance_error) {
  const double left = frame.fog_end - distance, scale = frame.fog_scale, share = left * scale;
  // Fog that starts where it ends is a step, at whose edge the transmittance may be anything.
  if (!std::isfinite(share)) return std::abs(left) > distance_error * distance ? 0 : 1;
  const double error = 5 * kRounding * std::abs(share) + distance_error * distance * std::abs(scale);
  return std::clamp(share + error, 0.0, 1.0) - std::clamp(share - error, 0.0, 1.0);
}

/// The same of e^−depth. exp_lanes() is within 3 + 0.23·depth roundings up to a depth of 86.9, and 0 from
/// there on (kernels/math.clh).
double exponentialShareError(double depth, double relative_depth_error) {
  const double share = std::exp(-depth),
               error = kRounding * (3 + 0.23 * depth) + relative_depth_error * depth;
  return depth > 86 ? share : 1.001 * error * share;
}

/// Upper bound of the error of the kernels' transmittance (kernels/shade/fog.clh) between eye and surface.
/// position: view space, metres.
double fogShareError(const ShadeFrame& frame, int channel, const glm::dvec3& position) {
  // A distance is √(dot product) by way of x·rsqrt_lanes(x): 1.5 + 3 + 1 roundings. A depth is a float
  // itself.
  const double distance = frame.fog_radial ? glm::length(position) : -position.z,
               distance_error = frame.fog_radial ? 6 * kRounding : 0;
  if (frame.fog_mode == kFogLinear) return linearShareError(frame, distance, distance_error);
  const double depth = distance * rgb(frame.fog_density)[channel], depth_error = distance_error + kRounding;
  return frame.fog_mode == kFogExp ? exponentialShareError(depth, depth_error)
                                   : exponentialShareError(depth * depth, 2 * depth_error + kRounding);
}

}  // namespace

bool seesFog(const FeatureSet& features) {
  return features.has(Feature::kFogLinear) || features.has(Feature::kFogExp) ||
         features.has(Feature::kFogExp2);
}

float clusteredError(float light_error, const ShadeFrame& frame, const FeatureSet& features) {
  const glm::dvec3 fog = rgb(frame.fog_color);
  const double through_fog = seesFog(features) ? kFogRounding * (1 + std::max({fog.x, fog.y, fog.z})) : 0;
  return std::max(float(light_error - kSeenRounding - through_fog), 1e-9f);
}

void boundVisibleLight(const GBuffer& gbuffer, const ShadeFrame& frame, const FeatureSet& features,
                       const Plane& emission, const Plane& color,
                       const std::optional<glm::vec3>& vertex_error, Plane& bounds) {
  const std::size_t n = gbuffer.pixels();
  bounds.resize(3 * n);
  const glm::dvec3 fog = rgb(frame.fog_color), ambient = rgb(frame.ambient);
  const bool foggy = seesFog(features);
  tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
    const glm::dvec3 position(gbuffer.position[i], gbuffer.position[i + n], gbuffer.position[i + 2 * n]);
    const bool covered = std::isfinite(position.z);
    for (int c = 0; c < 3; ++c) {
      const std::size_t place = i + std::size_t(c) * n;
      double bound =
          (vertex_error ? double((*vertex_error)[c]) : bounds[place]) + kSeenRounding * double(color[place]);
      if (foggy && covered) {
        const double light = (emission.empty() ? 0 : double(emission[place])) +
                             (gbuffer.ambient.empty() ? 0 : ambient[c] * double(gbuffer.ambient[place]));
        bound += fogShareError(frame, c, position) * std::max(light, fog[c]);
      }
      bounds[place] = covered ? std::nextafter(float(bound), std::numeric_limits<float>::infinity()) : 0.0f;
    }
  });
}

}  // namespace luciole
