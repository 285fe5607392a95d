#include "shadow/maps/cascades.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "raster/geometry.hpp"
#include "shadow/maps/frustum.hpp"

namespace luciole {
namespace {

/// The ratio of the reaches of successive cascades.
constexpr double kCascadeRatio = 3.0;

/// A sphere around the part of a view from `near` to `far` metres ahead.
Sphere sphereAround(const View& view, double near, double far) {
  const Corners corners = viewCorners(view, far);
  // Corners i and i + 4 are the far and the near end of an edge.
  const double view_near = -(view.world_to_view * glm::dvec4(corners[4], 1)).z;
  const double view_far = -(view.world_to_view * glm::dvec4(corners[0], 1)).z;
  std::array<glm::dvec3, 8> part;
  for (int i = 0; i < 4; ++i) {
    const auto at = [&](double depth) {
      return glm::mix(corners[i + 4], corners[i], (depth - view_near) / (view_far - view_near));
    };
    part[i] = at(near);
    part[i + 4] = at(far);
  }
  const auto middleOf = [&](int first) {
    return 0.25 * (part[first] + part[first + 1] + part[first + 2] + part[first + 3]);
  };
  const auto farthestFrom = [&](const glm::dvec3& middle) {
    double radius = 0;
    for (const glm::dvec3& p : part) radius = std::max(radius, glm::distance(p, middle));
    return radius;
  };
  // The centre of the smallest sphere is the point of the view axis at equal distances from the near and the
  // far corners. In a wide view that is beyond the far plane; then it is the middle of the far corners. Where
  // the axis isn't in the picture's middle, the sphere is a little larger than need be.
  const glm::dvec3 a = middleOf(0), b = middleOf(4);
  const double length2 = glm::dot(b - a, b - a);
  const double near2 = glm::dot(part[0] - a, part[0] - a), far2 = glm::dot(part[4] - b, part[4] - b);
  const double share = length2 > 0 ? std::clamp(0.5 + 0.5 * (far2 - near2) / length2, 0.0, 1.0) : 0.5;
  const glm::dvec3 middle = glm::mix(a, b, share);
  return {middle, farthestFrom(middle)};
}

/// How far ahead the camera sees anything of the scene, in metres: nearest and farthest.
glm::dvec2 seenDepths(const View& camera, const Bounds& scene) {
  const Corners box = boxCorners(scene);
  double farthest = kSmallestLength;
  for (const glm::dvec3& corner : box)
    farthest = std::max(farthest, -(camera.world_to_view * glm::dvec4(corner, 1)).z);
  std::vector<glm::dvec3> points = commonCorners(viewCorners(camera, 2 * farthest), box);
  if (points.empty()) points.assign(box.begin(), box.end());  // nothing to see: any depths will do
  glm::dvec2 depths(1e300, kSmallestLength);
  for (const glm::dvec3& point : points) {
    const double depth = -(camera.world_to_view * glm::dvec4(point, 1)).z;
    depths = {std::min(depths.x, depth), std::max(depths.y, depth)};
  }
  return depths;
}

}  // namespace

std::vector<Sphere> cascadeSpheres(const View& camera, const Bounds& scene) {
  const glm::dvec2 depths = seenDepths(camera, scene);
  const Sphere all{0.5 * (scene.low + scene.high), 0.5 * glm::distance(scene.low, scene.high)};
  if (!isPerspective(camera)) {
    const Sphere seen = sphereAround(camera, depths.x, depths.y);
    return {seen.radius < all.radius ? seen : all};
  }
  // Rounded up to a power of √2, so that a moving camera rarely changes a texel's size.
  const double farthest = std::exp2(std::ceil(2 * std::log2(depths.y)) / 2);
  std::vector<Sphere> spheres;
  double near = 0;
  for (int cascade = 0; cascade < kCascades; ++cascade) {
    const double far = farthest * std::pow(kCascadeRatio, cascade + 1 - kCascades);
    const Sphere part = sphereAround(camera, near, far);
    near = far;
    if (part.radius >= all.radius) {
      spheres.push_back(all);
      break;
    }
    spheres.push_back(part);
  }
  return spheres;
}

}  // namespace luciole
