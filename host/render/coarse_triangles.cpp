#include "render/coarse_triangles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <vector>

#include "raster/geometry.hpp"

namespace luciole {
namespace {

constexpr std::size_t kMostTriangles = 1024;
constexpr std::size_t kMostLights = 1024;
constexpr double kMuchBrighter = 4;

/// In world space.
struct Triangle {
  std::array<glm::dvec3, 3> corners;
  glm::dvec3 normal;  ///< unit, to the front
  bool double_sided;
  double width;  ///< the longest edge
};

/// A triangle that may be one of the largest.
struct Candidate {
  double squared_width;
  const PlacedObject* object;
  std::uint32_t index;  ///< in the object's mesh

  bool operator>(const Candidate& other) const { return squared_width > other.squared_width; }
};

std::array<glm::dvec3, 3> worldCorners(const PlacedObject& object, std::uint32_t index) {
  std::array<glm::dvec3, 3> corners;
  for (int i = 0; i < 3; ++i) {
    const glm::vec3& position = object.mesh->positions[object.mesh->triangles[index][i]];
    corners[i] = glm::dvec3(object.object_to_view * glm::dvec4(position, 1));
  }
  return corners;
}

double squaredWidth(const std::array<glm::dvec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  return std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
}

/// The scene's kMostTriangles widest triangles, without those that have no area; the widest last.
std::vector<Triangle> largestTriangles(const Scene& scene) {
  const std::vector<PlacedObject> objects = placeObjects(scene, allObjects(scene), glm::dmat4(1), true);
  // The smallest is on top, and is replaced first.
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> largest;
  for (const PlacedObject& object : objects) {
    for (std::uint32_t i = 0; i < object.mesh->triangles.size(); ++i) {
      const double width = squaredWidth(worldCorners(object, i));
      if (largest.size() == kMostTriangles) {
        if (!(width > largest.top().squared_width)) continue;
        largest.pop();
      }
      largest.push({width, &object, i});
    }
  }
  std::vector<Triangle> triangles;
  for (; !largest.empty(); largest.pop()) {
    const auto& [squared_width, object, index] = largest.top();
    const std::array<glm::dvec3, 3> corners = worldCorners(*object, index);
    const glm::dvec3 cross = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double area = glm::length(cross);
    if (!(area > 0)) continue;
    triangles.push_back({corners, cross / (object->mirrored ? -area : area),
                         materialOf(scene, *object, index).double_sided, std::sqrt(squared_width)});
  }
  return triangles;
}

bool isInside(const Triangle& triangle, const glm::dvec3& point) {
  const auto side = [&](int i) {
    const glm::dvec3 &from = triangle.corners[i], &to = triangle.corners[(i + 1) % 3];
    return glm::dot(glm::cross(to - from, point - from), triangle.normal);
  };
  const double sides[] = {side(0), side(1), side(2)};
  // The corners of a mirrored triangle have the other orientation.
  return std::all_of(std::begin(sides), std::end(sides), [](double s) { return s >= 0; }) ||
         std::all_of(std::begin(sides), std::end(sides), [](double s) { return s <= 0; });
}

/// The place in the triangle's plane below a point light, or where a spot's axis meets it. Empty if that lies
/// outside the triangle or out of range.
std::optional<glm::dvec3> brightestPlace(const Light& light, const Triangle& triangle) {
  const double height = glm::dot(light.position - triangle.corners[0], triangle.normal);
  if (!(std::abs(height) < light.range)) return std::nullopt;
  glm::dvec3 place = light.position - height * triangle.normal;
  if (light.kind == LightKind::kSpot) {
    const double way = -height / glm::dot(light.direction, triangle.normal);
    if (!(way > 0 && std::isfinite(way))) return std::nullopt;
    place = light.position + way * light.direction;
  }
  if (!isInside(triangle, place)) return std::nullopt;
  return place;
}

/// The light that a place in the triangle gets, N·L included. A glTF cone doesn't fade here: all of it is as
/// bright as its middle.
double lightAt(const Light& light, const Triangle& triangle, const glm::dvec3& place) {
  const glm::dvec3 way = light.position - place;
  const double distance = glm::length(way);
  if (!(distance > 0 && distance < light.range)) return 0;
  const glm::dvec3 to_light = way / distance, k(light.attenuation);
  double share = glm::dot(triangle.normal, to_light);
  if (triangle.double_sided) share = std::abs(share);
  if (!(share > 0)) return 0;
  if (light.kind == LightKind::kSpot) {
    const double cosine = -glm::dot(to_light, light.direction);
    if (cosine < std::cos(light.cutoff)) return 0;
    share *= std::pow(std::max(cosine, 0.0), double(light.exponent));
  }
  const double fade = 1 - std::pow(distance / light.range, 4);
  return share * fade * fade / std::max(k.x + k.y * distance + k.z * distance * distance, 0x1p-100);
}

bool isLost(const Light& light, const Triangle& triangle) {
  const std::optional<glm::dvec3> place = brightestPlace(light, triangle);
  if (!place) return false;
  const double brightest = lightAt(light, triangle, *place);
  return std::all_of(std::begin(triangle.corners), std::end(triangle.corners), [&](const glm::dvec3& c) {
    return brightest > kMuchBrighter * lightAt(light, triangle, c);
  });
}

}  // namespace

double coarseTriangleWidth(const Scene& scene) {
  if (!scene.lighting) return 0;
  std::vector<const Light*> lights;
  const std::size_t step = (scene.lights.size() + kMostLights - 1) / kMostLights;
  for (std::size_t i = 0; i < scene.lights.size(); i += step)
    if (scene.lights[i].kind != LightKind::kDirectional) lights.push_back(&scene.lights[i]);
  if (lights.empty()) return 0;
  const std::vector<Triangle> triangles = largestTriangles(scene);
  const auto widest = std::find_if(triangles.rbegin(), triangles.rend(), [&](const Triangle& triangle) {
    return std::any_of(lights.begin(), lights.end(),
                       [&](const Light* light) { return isLost(*light, triangle); });
  });
  return widest == triangles.rend() ? 0 : widest->width;
}

}  // namespace luciole
