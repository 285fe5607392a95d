#include "shade/shadow_ways.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raster/geometry.hpp"
#include "scene/bounds.hpp"
#include "scene/count_triangles.hpp"
#include "shadow/maps/shadow_sizes.hpp"
#include "shadow/maps/shadow_views.hpp"

namespace luciole {
namespace {

/// The share of the picture covered by a sphere's bounding square; world space.
double shareSeen(const View& view, const glm::dvec3& middle, double radius) {
  const glm::dvec3 at(view.world_to_view * glm::dvec4(middle, 1));
  const glm::dvec2 shift = axisInPicture(view);
  double distance = 1;
  if (isPerspective(view)) {
    if (-at.z <= -radius) return 0;
    const double beyond = glm::dot(at, at) - radius * radius;
    if (beyond <= 0 || -at.z <= radius) return 1;
    distance = -at.z;
    radius *= distance / std::sqrt(beyond);
  }
  double share = 1;
  for (int axis = 0; axis < 2; ++axis) {
    const double scale = view.projection[axis][axis] / distance;
    const double low = std::max((at[axis] - radius) * scale + shift[axis], -1.0),
                 high = std::min((at[axis] + radius) * scale + shift[axis], 1.0);
    share *= std::max(high - low, 0.0) / 2;
  }
  return share;
}

/// The share of the bounds' volume inside a sphere's bounding box.
double shareReached(const Bounds& bounds, const glm::dvec3& middle, double radius) {
  double share = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = bounds.high[axis] - bounds.low[axis];
    const double low = std::max(bounds.low[axis], middle[axis] - radius);
    const double high = std::min(bounds.high[axis], middle[axis] + radius);
    if (high < low) return 0;
    if (extent > 0) share *= (high - low) / extent;
  }
  return share;
}

}  // namespace

double shadedPoints(const Scene& scene, glm::ivec2 size, int samples, bool shared) {
  if (!shared) return samples;
  // A pixel has more points the more triangles it sees, and pixels of uneven light shade all samples.
  return std::min(double(samples), 1.3 + 4 * double(countTriangles(scene)) / (double(size.x) * size.y));
}

std::vector<ShadowWork> shadowWork(const Scene& scene, const View& view, double points_a_pixel,
                                   const ShadowLimits& limits) {
  std::vector<ShadowWork> work(scene.lights.size());
  const PlanInput input{view, ShadowMethod::kHard, glm::inverse(view.world_to_view), sceneBounds(scene)};
  if (input.bounds.low.x > input.bounds.high.x) return work;
  ShadowLimits unbounded = limits;
  unbounded.bytes = std::numeric_limits<std::size_t>::max();
  const ShadowSizes sizes = chooseSizes(scene, input, unbounded);
  const double points = points_a_pixel * view.size.x * view.size.y;
  const auto triangles = double(countTriangles(scene));
  double texels = 0;
  for (std::size_t i = 0; i < work.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!light.shadow) continue;
    const bool everywhere = light.kind == LightKind::kDirectional;
    const double reach = everywhere ? 0 : lightReach(light, input.bounds);
    work[i].points = points * (everywhere ? 1 : shareSeen(view, light.position, reach));
    work[i].triangles = triangles * (everywhere ? 1 : shareReached(input.bounds, light.position, reach));
    work[i].faces = facesOf(light);
    work[i].texels = work[i].faces * std::pow(double(sizes.sizes[i]), 2);
    texels += work[i].texels;
  }
  // Where memory lacks, all maps get coarser.
  const double most = double(limits.bytes) / sizeof(ShadowTexel);
  for (ShadowWork& each : work) each.texels *= std::min(most / std::max(texels, 1.0), 1.0);
  return work;
}

// Fitted to 40 pictures of ten scenes, from 320 × 180 to 1920 × 1080 pixels, with 1 and 16 samples: the
// shares of each sum by least squares of relative errors, then its scale so that the geometric mean of the
// errors is 1. The powers were the best of a grid. Half of all costs are within a factor of 1.3,
// and nine in ten within 2.6.
double beamMilliseconds(const ShadowWork& work, bool holes) {
  const double through_holes =
      holes ? 2.3e-7 * work.points + 4e-7 * std::sqrt(work.points * work.triangles) : 0;
  return 1.5e-6 * work.points + 1.1e-5 * std::pow(work.points, 0.4) * std::pow(work.triangles, 0.7) +
         through_holes;
}

ShadowCosts shadowCosts(double triangles, bool holes, std::span<const ShadowWork> work) {
  ShadowCosts costs{.tree = 1.9e-4 * triangles, .plan = 2.9e-5 * triangles};
  for (const ShadowWork& each : work) {
    costs.beams.push_back(beamMilliseconds(each, holes));
    costs.maps.push_back(3.5e-6 * each.points + 6.9e-5 * each.triangles + 1.9e-7 * each.texels +
                         1.6e-6 * std::pow(each.points * each.triangles, 0.6));
  }
  return costs;
}

std::vector<ShadowWay> cheapestWays(const ShadowCosts& costs, const std::vector<bool>& casts) {
  std::vector<ShadowWay> ways(casts.size(), ShadowWay::kNone);
  // The time that beams save over maps alone, with each light on its better way.
  double saved = -costs.tree;
  bool any_map = false;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (!casts[i]) continue;
    const double less = kMapsPayFrom * costs.maps[i] - costs.beams[i];
    ways[i] = less >= 0 ? ShadowWay::kBeams : ShadowWay::kMap;
    saved += std::max(less, 0.0);
    any_map |= less < 0;
  }
  if (!any_map) saved += kMapsPayFrom * costs.plan;
  if (saved < 0) std::replace(ways.begin(), ways.end(), ShadowWay::kBeams, ShadowWay::kMap);
  return ways;
}

std::vector<ShadowWay> shadowWays(const Scene& scene, const View& view, double points_a_pixel,
                                  const ShadowLimits& limits, const std::vector<bool>& casts) {
  if (std::find(casts.begin(), casts.end(), true) == casts.end())
    return std::vector<ShadowWay>(casts.size(), ShadowWay::kNone);
  const std::vector<ShadowWork> work = shadowWork(scene, view, points_a_pixel, limits);
  const bool holes = std::any_of(scene.materials.begin(), scene.materials.end(),
                                 [](const Material& material) { return material.alpha_cutoff > 0; });
  std::vector<ShadowWay> ways = cheapestWays(shadowCosts(double(countTriangles(scene)), holes, work), casts);
  // Beams take no memory for each light.
  double bytes = 0;
  for (std::size_t i = 0; i < ways.size(); ++i)
    if (ways[i] == ShadowWay::kMap)
      bytes += work[i].faces * kSmallestFace * kSmallestFace * sizeof(ShadowTexel);
  if (bytes > double(limits.bytes))
    std::replace(ways.begin(), ways.end(), ShadowWay::kMap, ShadowWay::kBeams);
  return ways;
}

}  // namespace luciole
