#include "tools/assets/lathe.hpp"

#include <cmath>

namespace luciole {
namespace {

glm::dvec2 unit(const glm::dvec2& v) { return v / std::sqrt(v.x * v.x + v.y * v.y); }
glm::dvec3 unit(const glm::dvec3& v) { return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

/// The normal of the way from a to b, in the profile's plane.
glm::dvec2 normalOf(const glm::dvec2& a, const glm::dvec2& b) { return unit({b.y - a.y, a.x - b.x}); }

/// The points of one band of the surface, which share normals around the axis: a row for each of its rings.
struct Ring {
  glm::dvec2 point, normal;
};

/// Appends the band between each ring and the next.
void addBand(const std::vector<Ring>& rings, const Turn& turn, GltfTriangles& triangles) {
  const std::vector<glm::dvec2> circle = unitCircle(turn.steps);
  const auto first = static_cast<std::uint32_t>(triangles.positions.size());
  const auto columns = static_cast<std::uint32_t>(turn.last - turn.first + 1);
  for (const auto& [point, normal] : rings) {
    for (int i = turn.first; i <= turn.last; ++i) {
      const glm::dvec2 at = circle[static_cast<std::size_t>(i % turn.steps)];
      triangles.positions.emplace_back(point.x * at.x, point.y, point.x * at.y);
      triangles.normals.emplace_back(unit(glm::dvec3(normal.x * at.x, normal.y, normal.x * at.y)));
    }
  }
  for (std::uint32_t ring = 0; ring + 1 < rings.size(); ++ring) {
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t a = first + ring * columns + i, b = a + columns;
      if (rings[ring].point.x > 0) triangles.corners.emplace_back(a, b, a + 1);
      if (rings[ring + 1].point.x > 0) triangles.corners.emplace_back(a + 1, b, b + 1);
    }
  }
}

}  // namespace

std::vector<glm::dvec2> unitCircle(int steps) {
  std::vector<glm::dvec2> circle{{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  while (static_cast<int>(circle.size()) < steps) {
    std::vector<glm::dvec2> finer;
    for (std::size_t i = 0; i < circle.size(); ++i) {
      finer.push_back(circle[i]);
      finer.push_back(unit(circle[i] + circle[(i + 1) % circle.size()]));
    }
    circle = finer;
  }
  return circle;
}

void addLathe(const Profile& profile, const Turn& turn, GltfTriangles& triangles) {
  const std::vector<glm::dvec2>& points = profile.points;
  std::vector<glm::dvec2> normals;  // of the ways
  for (std::size_t i = 0; i + 1 < points.size(); ++i) normals.push_back(normalOf(points[i], points[i + 1]));
  if (!profile.smooth) {
    for (std::size_t i = 0; i < normals.size(); ++i)
      addBand({{points[i], normals[i]}, {points[i + 1], normals[i]}}, turn, triangles);
    return;
  }
  std::vector<Ring> rings;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 before = normals[i == 0 ? 0 : i - 1], after = normals[std::min(i, normals.size() - 1)];
    rings.push_back({points[i], unit(before + after)});
  }
  // At the axis a smooth surface has one normal.
  for (Ring* end : {&rings.front(), &rings.back()})
    if (end->point.x == 0) end->normal = {0, end->normal.y < 0 ? -1 : 1};
  addBand(rings, turn, triangles);
}

void addQuad(const glm::dvec3 (&corners)[4], GltfTriangles& triangles) {
  const auto first = static_cast<std::uint32_t>(triangles.positions.size());
  const glm::dvec3 normal = unit(glm::cross(corners[1] - corners[0], corners[3] - corners[0]));
  for (const glm::dvec3& corner : corners) {
    triangles.positions.emplace_back(corner);
    triangles.normals.emplace_back(normal);
  }
  triangles.corners.emplace_back(first, first + 1, first + 2);
  triangles.corners.emplace_back(first, first + 2, first + 3);
}

}  // namespace luciole
