#include "scene/triangulate.hpp"

#include <cmath>
#include <numeric>

namespace luciole {
namespace {

/// Newell's normal: its length is twice the polygon's area.
glm::dvec3 polygonNormal(const std::vector<glm::dvec3>& polygon) {
  glm::dvec3 normal(0);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    // Relative to corner 0, so that a small polygon far from the origin loses no digits.
    const glm::dvec3 a = polygon[i] - polygon[0];
    const glm::dvec3 b = polygon[(i + 1) % polygon.size()] - polygon[0];
    normal += glm::cross(a, b);
  }
  return normal;
}

/// The polygon projected to its plane, seen from the side where it is counter-clockwise.
std::vector<glm::dvec2> flatten(const std::vector<glm::dvec3>& polygon, const glm::dvec3& normal) {
  const glm::dvec3 w = normal / glm::length(normal);
  const glm::dvec3 helper = std::abs(w.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(helper, w));
  const glm::dvec3 v = glm::cross(w, u);
  std::vector<glm::dvec2> flat;
  for (const glm::dvec3& corner : polygon) {
    flat.emplace_back(glm::dot(corner - polygon[0], u), glm::dot(corner - polygon[0], v));
  }
  return flat;
}

/// Twice the signed area: positive where a, b, c turn left.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether the corner at `tip` of the remaining polygon can be cut off: it turns left, and no other corner
/// lies in its triangle. Corners at the same place as one of the three are ignored, since polygons with a
/// hole repeat corners.
bool isEar(const std::vector<glm::dvec2>& flat, const std::vector<int>& rest, std::size_t tip) {
  const std::size_t n = rest.size();
  const glm::dvec2 a = flat[rest[(tip + n - 1) % n]], b = flat[rest[tip]], c = flat[rest[(tip + 1) % n]];
  if (!(turn(a, b, c) > 0)) return false;
  for (const int other : rest) {
    const glm::dvec2 p = flat[other];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

std::vector<std::array<int, 3>> triangulate(const std::vector<glm::dvec3>& polygon) {
  std::vector<int> rest(polygon.size());
  std::iota(rest.begin(), rest.end(), 0);
  std::vector<std::array<int, 3>> triangles;
  const glm::dvec3 normal = polygonNormal(polygon);
  const bool has_area = glm::length(normal) > 0;
  const std::vector<glm::dvec2> flat = has_area ? flatten(polygon, normal) : std::vector<glm::dvec2>();
  while (rest.size() > 3) {
    std::size_t tip = 1;  // so that a convex polygon becomes a fan
    if (has_area) {
      while (tip <= rest.size() && !isEar(flat, rest, tip % rest.size())) ++tip;
      if (tip > rest.size()) tip = 1;  // no ear: the polygon crosses itself
      tip %= rest.size();
    }
    const std::size_t n = rest.size();
    triangles.push_back({rest[(tip + n - 1) % n], rest[tip], rest[(tip + 1) % n]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(tip));
  }
  triangles.push_back({rest[0], rest[1], rest[2]});
  return triangles;
}

}  // namespace luciole
