#include "shadow/maps/frustum.hpp"

#include <glm/gtc/matrix_access.hpp>
#include <numeric>
#include <utility>

#include "raster/clip_polygon.hpp"

namespace luciole {
namespace {

/// The corners of each face, in order around it.
constexpr std::array<std::array<int, 4>, 6> kFaces{
    {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}}};

/// Six planes make at most 4, 6, 9, 13, 19, 28, 42 corners of a face, see clipPolygon.
using FacePolygon = Polygon<glm::dvec3, 42>;

/// The planes of a hexahedron's faces, positive inside.
std::array<glm::dvec4, 6> facePlanes(const Corners& corners) {
  const glm::dvec3 middle = std::accumulate(corners.begin(), corners.end(), glm::dvec3(0)) / 8.0;
  std::array<glm::dvec4, 6> planes;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& face = kFaces[i];
    const glm::dvec3 normal =
        glm::cross(corners[face[1]] - corners[face[0]], corners[face[3]] - corners[face[0]]);
    const glm::dvec4 plane(normal, -glm::dot(normal, corners[face[0]]));
    planes[i] = glm::dot(plane, glm::dvec4(middle, 1)) < 0 ? -plane : plane;
  }
  return planes;
}

/// Clips the faces of `of` to the inside of `by`, and appends the corners of what is left.
void appendClippedFaces(const Corners& of, const Corners& by, std::vector<glm::dvec3>& points) {
  const auto planes = facePlanes(by);
  for (const auto& face : kFaces) {
    FacePolygon polygon{{of[face[0]], of[face[1]], of[face[2]], of[face[3]]}, 4}, kept;
    for (const glm::dvec4& plane : planes) {
      clipPolygon(
          polygon, [&](const glm::dvec3& p) { return glm::dot(plane, glm::dvec4(p, 1)); },
          edgeCrossing<glm::dvec3>, kept);
      std::swap(polygon, kept);
    }
    points.insert(points.end(), polygon.corners.begin(), polygon.corners.begin() + polygon.count);
  }
}

}  // namespace

Corners boxCorners(const Bounds& box) {
  Corners corners;
  for (int i = 0; i < 8; ++i)
    corners[i] = {(i & 1 ? box.high : box.low).x, (i & 2 ? box.high : box.low).y,
                  (i & 4 ? box.high : box.low).z};
  return corners;
}

Corners viewCorners(const View& view, double farthest) {
  // Where the far plane is infinitely far, what lies d metres ahead has z = near / d.
  const bool is_infinite = view.projection[2][3] != 0 && view.projection[2][2] == 0;
  const double far_z = is_infinite ? view.projection[3][2] / farthest : 0;
  const glm::dmat4 clip_to_world = glm::inverse(view.projection * view.world_to_view);
  Corners corners;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 p = clip_to_world * glm::dvec4(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : far_z, 1);
    corners[i] = glm::dvec3(p) / p.w;
  }
  return corners;
}

std::vector<glm::dvec3> commonCorners(const Corners& a, const Corners& b) {
  std::vector<glm::dvec3> points;
  appendClippedFaces(a, b, points);
  appendClippedFaces(b, a, points);
  return points;
}

std::array<glm::dvec4, 6> cropPlanes(const View& view) {
  const glm::dmat4 m = view.projection * view.world_to_view;
  const glm::dvec4 x = glm::row(m, 0), y = glm::row(m, 1), z = glm::row(m, 2), w = glm::row(m, 3);
  const glm::dvec2 size(view.size), first(view.crop_origin), last = first + glm::dvec2(view.crop_size);
  const auto ndcX = [&](double pixel) { return -1 + 2 * pixel / size.x; };
  const auto ndcY = [&](double pixel) { return 1 - 2 * pixel / size.y; };
  return {x - ndcX(first.x) * w, ndcX(last.x) * w - x, ndcY(first.y) * w - y, y - ndcY(last.y) * w, w - z, z};
}

}  // namespace luciole
