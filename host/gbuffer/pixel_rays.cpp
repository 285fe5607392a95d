#include "gbuffer/pixel_rays.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace luciole {
namespace {

constexpr std::size_t kFewest = 16;
constexpr double kShare = 0.9;   ///< of the points
constexpr double kPixels = 1.5;  ///< how far off a point may be

/// The middle one of the quotients a / b where b isn't near 0; empty where no b is.
std::optional<double> middleRatio(std::span<const SeenPoint> points, int axis) {
  std::vector<double> ratios;
  for (const SeenPoint& seen : points)
    if (std::abs(seen.screen[axis]) > 0.05 && seen.point.z != 0)
      ratios.push_back(seen.point[axis] / std::abs(seen.point.z) / seen.screen[axis]);
  if (ratios.empty()) return {};
  const auto middle = ratios.begin() + std::ptrdiff_t(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  if (!std::isfinite(*middle) || *middle == 0) return {};
  return *middle;
}

}  // namespace

bool lieOnRays(std::span<const SeenPoint> points, glm::dvec2 picture_size, glm::dvec2 half_extent,
               glm::dvec2 shift, bool parallel) {
  if (points.size() < kFewest) return false;
  const auto on_rays = std::count_if(points.begin(), points.end(), [&](const SeenPoint& seen) {
    if (!(seen.point.z < 0)) return false;
    const glm::dvec2 screen = glm::dvec2(seen.point) / (parallel ? 1.0 : -seen.point.z) / half_extent + shift;
    const glm::dvec2 off = glm::abs(screen - seen.screen) * 0.5 * picture_size;
    return off.x < kPixels && off.y < kPixels;
  });
  return double(on_rays) >= kShare * double(points.size());
}

std::optional<RayFit> fitRays(std::span<const SeenPoint> points, const glm::dvec2& picture_size) {
  if (points.size() < kFewest) return {};
  const auto x = middleRatio(points, 0), y = middleRatio(points, 1);
  if (!x || !y) return {};
  const auto ahead =
      std::count_if(points.begin(), points.end(), [](const SeenPoint& s) { return s.point.z > 0; });
  RayFit fit{.half_extent = {std::abs(*x), std::abs(*y)},
             .signs = {*x < 0 ? -1 : 1, *y < 0 ? -1 : 1, 2 * std::size_t(ahead) > points.size() ? -1 : 1}};
  std::vector<SeenPoint> turned(points.begin(), points.end());
  double nearest = INFINITY, farthest = 0;
  for (SeenPoint& seen : turned) {
    seen.point *= fit.signs;
    nearest = std::min(nearest, std::abs(seen.point.z));
    farthest = std::max(farthest, std::abs(seen.point.z));
  }
  if (!lieOnRays(turned, picture_size, fit.half_extent, glm::dvec2(0), false)) return {};
  fit.is_deep = farthest > 1.05 * nearest;
  return fit;
}

}  // namespace luciole
