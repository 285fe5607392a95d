#include "scene/lights/light_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

// Only + − × ÷ and square roots are used here: they round alike on every machine, sines and logarithms don't.

double lengthOf(const glm::dvec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

glm::dvec3 pointInBox(const LightField& field, std::uint64_t& state) {
  glm::dvec3 point;
  for (int i = 0; i < 3; ++i) point[i] = between(field.low[i], field.high[i], nextUniform(state));
  return point;
}

glm::dvec3 pointInBall(std::uint64_t& state) {
  for (;;) {
    glm::dvec3 point;
    for (int i = 0; i < 3; ++i) point[i] = 2 * nextUniform(state) - 1;
    if (point.x * point.x + point.y * point.y + point.z * point.z <= 1) return point;
  }
}

/// Marsaglia 1972, "Choosing a point from the surface of a sphere".
glm::dvec3 pointOnSphere(std::uint64_t& state) {
  for (;;) {
    const double a = 2 * nextUniform(state) - 1;
    const double b = 2 * nextUniform(state) - 1;
    const double s = a * a + b * b;
    if (s < 1) return {2 * a * std::sqrt(1 - s), 2 * b * std::sqrt(1 - s), 1 - 2 * s};
  }
}

/// The mean of two points uniform in the ball around a cluster's centre: densest at the centre, and none
/// beyond the radius. Centres are computed when needed, from a random stream of their own.
glm::dvec3 pointInCluster(const LightField& field, std::uint64_t& state) {
  constexpr std::uint64_t kCenterStream = 0x5851f42d4c957f2du;
  const double pick = nextUniform(state) * static_cast<double>(field.clusters);
  std::uint64_t center_state =
      (field.seed ^ kCenterStream) + 3 * kRandomStep * static_cast<std::uint64_t>(pick);
  const glm::dvec3 center = pointInBox(field, center_state);
  const glm::dvec3 a = pointInBall(state);
  const glm::dvec3 b = pointInBall(state);
  return center + field.radius * (0.5 * (a + b));
}

/// Chooses a piece with a probability in proportion to its size, such as a triangle by its area. `sums`: the
/// running sums of the sizes; `u`: uniform in [0,1). Never chooses a piece of size 0. O(log pieces).
std::size_t pieceAt(const std::vector<double>& sums, double u) {
  const auto above = std::upper_bound(sums.begin(), sums.end(), u * sums.back());
  // The product may be rounded up to the whole.
  const auto found = above == sums.end() ? std::lower_bound(sums.begin(), sums.end(), sums.back()) : above;
  return static_cast<std::size_t>(found - sums.begin());
}

struct WorldTriangle {
  glm::dvec3 corner, edge1, edge2;
  glm::dvec3 cross() const {
    return {edge1.y * edge2.z - edge1.z * edge2.y, edge1.z * edge2.x - edge1.x * edge2.z,
            edge1.x * edge2.y - edge1.y * edge2.x};
  }
};

WorldTriangle worldTriangle(const Scene& scene, const Object& object, std::size_t triangle) {
  const Mesh& mesh = scene.meshes[object.mesh];
  const glm::uvec3 corners = mesh.triangles[triangle];
  const auto place = [&](std::uint32_t i) {
    return glm::dvec3(object.object_to_world * glm::dvec4(mesh.positions[i], 1));
  };
  const glm::dvec3 corner = place(corners.x);
  return {corner, place(corners.y) - corner, place(corners.z) - corner};
}

struct SurfacePlaces {
  const LightField& field;
  const Scene& scene;
  std::vector<double> areas;        ///< running sum of twice the areas of all objects' triangles
  std::vector<std::size_t> firsts;  ///< index in `areas` of each object's first triangle

  SurfacePlaces(const LightField& field_of, const Scene& scene_of) : field(field_of), scene(scene_of) {
    double sum = 0;
    for (const Object& object : scene.objects) {
      firsts.push_back(areas.size());
      for (std::size_t i = 0; i < scene.meshes[object.mesh].triangles.size(); ++i)
        areas.push_back(sum += lengthOf(worldTriangle(scene, object, i).cross()));
    }
    if (!(sum > 0 && std::isfinite(sum))) {
      throw InputError(fmt::format(
          "{}: light field on surfaces: the scene's triangles have an area of {}, expected one above 0",
          scene.name.empty() ? "scene" : scene.name, sum / 2));
    }
  }

  glm::dvec3 operator()(std::uint64_t& state) const {
    const std::size_t piece = pieceAt(areas, nextUniform(state));
    const std::size_t index =
        static_cast<std::size_t>(std::upper_bound(firsts.begin(), firsts.end(), piece) - firsts.begin()) - 1;
    const Object& object = scene.objects[index];
    const WorldTriangle triangle = worldTriangle(scene, object, piece - firsts[index]);
    double u = nextUniform(state);
    double v = nextUniform(state);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const glm::dvec3 cross = triangle.cross();
    const glm::dmat3 axes(object.object_to_world);
    // Mirroring reverses the order of corners, but the front stays the front.
    const double side = glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0 ? -1 : 1;
    return triangle.corner + u * triangle.edge1 + v * triangle.edge2 +
           side * field.offset / lengthOf(cross) * cross;
  }
};

/// The spline of Catmull and Rom 1974, "A class of local interpolating splines", as chords.
struct CurvePlaces {
  const LightField& field;
  std::vector<glm::dvec3> ends;  ///< of the chords: one more than chords
  std::vector<double> lengths;   ///< running sum

  explicit CurvePlaces(const LightField& field_of) : field(field_of) {
    constexpr int kChords = 64;  // a segment
    const std::vector<glm::dvec3>& p = field.points;
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
      const glm::dvec3 before = i == 0 ? 2.0 * p[0] - p[1] : p[i - 1];
      const glm::dvec3 after = i + 2 == p.size() ? 2.0 * p[i + 1] - p[i] : p[i + 2];
      const glm::dvec3 linear = p[i + 1] - before;
      const glm::dvec3 quadratic = 2.0 * before - 5.0 * p[i] + 4.0 * p[i + 1] - after;
      const glm::dvec3 cubic = 3.0 * (p[i] - p[i + 1]) + after - before;
      for (int chord = 0; chord < kChords; ++chord) {
        const double t = double(chord) / kChords;
        ends.push_back(p[i] + 0.5 * t * (linear + t * (quadratic + t * cubic)));
      }
    }
    ends.push_back(p.back());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      lengths.push_back(sum += lengthOf(ends[i + 1] - ends[i]));
  }

  glm::dvec3 operator()(std::uint64_t& state) const {
    const double u = nextUniform(state);
    const std::size_t chord = pieceAt(lengths, u);
    const double before = chord == 0 ? 0 : lengths[chord - 1];
    const double length = lengths[chord] - before;
    const double share = length > 0 ? std::min((u * lengths.back() - before) / length, 1.0) : 0;
    // Drawn even for a radius of 0, so that changing the radius moves no light along the curve.
    const glm::dvec3 scatter = pointInBall(state);
    return ends[chord] + share * (ends[chord + 1] - ends[chord]) + field.radius * scatter;
  }
};

}  // namespace

std::function<glm::dvec3(std::uint64_t& state)> lightPlaces(const LightField& field, const Scene& scene) {
  switch (field.shape) {
    case FieldShape::kBall:
      return [&field](std::uint64_t& state) { return field.center + field.radius * pointInBall(state); };
    case FieldShape::kSphere:
      return [&field](std::uint64_t& state) { return field.center + field.radius * pointOnSphere(state); };
    case FieldShape::kSurface:
      return SurfacePlaces(field, scene);
    case FieldShape::kClusters:
      return [&field](std::uint64_t& state) { return pointInCluster(field, state); };
    case FieldShape::kCurve:
      return CurvePlaces(field);
    case FieldShape::kBox:
    case FieldShape::kList:
      break;
  }
  return [&field](std::uint64_t& state) { return pointInBox(field, state); };
}

}  // namespace luciole
