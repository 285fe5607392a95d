#include "luciole/primitives.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace luciole {
namespace {

std::uint32_t addVertex(Mesh& mesh, const glm::dvec3& position, const glm::dvec3& normal,
                        const glm::dvec2& uv) {
  mesh.positions.emplace_back(position);
  mesh.normals.emplace_back(normal);
  mesh.uvs.emplace_back(uv);
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

/// The point at `step` of `steps` around the unit circle, from (0, −1) towards (−1, 0). On a shape around the
/// y axis, with (x, z) on this circle, a texture's middle faces +z and its u grows to the right. Step 0 and
/// step `steps` have the same bits; quarters are exact.
glm::dvec2 circle(int step, int steps) {
  const int s = step % steps;
  if (s == 0) return {0, -1};
  if (4 * s == steps) return {-1, 0};
  if (2 * s == steps) return {0, 1};
  if (4 * s == 3 * steps) return {1, 0};
  const double angle = 2 * std::numbers::pi * s / steps;
  return {-std::sin(angle), -std::cos(angle)};
}

/// Two triangles; a b c d counter-clockwise.
void addQuad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.emplace_back(a, b, c);
  mesh.triangles.emplace_back(a, c, d);
}

/// Adds a rectangle of n × n squares. `right` and `down` are its sides, as seen by a viewer that the normal
/// points at.
void addRectangle(Mesh& mesh, const glm::dvec3& top_left, const glm::dvec3& right, const glm::dvec3& down,
                  int n) {
  const glm::dvec3 normal = glm::normalize(glm::cross(down, right));
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto row = static_cast<std::uint32_t>(n + 1);
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) {
      const glm::dvec2 uv{double(x) / n, double(y) / n};
      addVertex(mesh, top_left + uv.x * right + uv.y * down, normal, uv);
    }
  }
  for (std::uint32_t y = 0; y + 1 < row; ++y) {
    for (std::uint32_t x = 0; x + 1 < row; ++x) {
      const std::uint32_t i = first + y * row + x;
      addQuad(mesh, i, i + row, i + row + 1, i + 1);
    }
  }
}

void addBox(Mesh& mesh, int n) {
  const glm::dvec3 x{1, 0, 0};
  const glm::dvec3 y{0, 1, 0};
  const glm::dvec3 z{0, 0, 1};
  const glm::dvec3 c{0.5};
  addRectangle(mesh, -c + y + z, x, -y, n);       // +z
  addRectangle(mesh, -c + x + y, -x, -y, n);      // −z
  addRectangle(mesh, -c + x + y + z, -z, -y, n);  // +x
  addRectangle(mesh, -c + y, z, -y, n);           // −x
  addRectangle(mesh, -c + y, x, z, n);            // +y
  addRectangle(mesh, -c + z, x, -z, n);           // −y
}

void addSphere(Mesh& mesh, int around) {
  const int rings = std::max(2, around / 2);
  const auto row = static_cast<std::uint32_t>(around + 1);
  for (int ring = 0; ring <= rings; ++ring) {
    const glm::dvec2 arc = circle(ring, 2 * rings);  // from the top down: (−sin, −cos) of the angle to +y
    const double radius = -arc.x;
    for (int step = 0; step <= around; ++step) {
      const glm::dvec2 c = circle(step, around);
      const glm::dvec3 place{radius * c.x, -arc.y, radius * c.y};
      addVertex(mesh, place, place, {double(step) / around, double(ring) / rings});
    }
  }
  for (int ring = 0; ring < rings; ++ring) {
    for (int step = 0; step < around; ++step) {
      const std::uint32_t i = static_cast<std::uint32_t>(ring) * row + static_cast<std::uint32_t>(step);
      if (ring == 0) {
        mesh.triangles.emplace_back(i, i + row, i + row + 1);
      } else if (ring == rings - 1) {
        mesh.triangles.emplace_back(i, i + row, i + 1);
      } else {
        addQuad(mesh, i, i + row, i + row + 1, i + 1);
      }
    }
  }
}

/// A disc of radius 1 at height y, facing up or down.
void addCap(Mesh& mesh, double y, bool up, int around) {
  const glm::dvec3 normal{0, up ? 1 : -1, 0};
  const double down_in_texture = up ? 0.5 : -0.5;
  const std::uint32_t center = addVertex(mesh, {0, y, 0}, normal, {0.5, 0.5});
  for (int step = 0; step < around; ++step) {
    const glm::dvec2 c = circle(step, around);
    addVertex(mesh, {c.x, y, c.y}, normal, {0.5 + 0.5 * c.x, 0.5 + down_in_texture * c.y});
  }
  for (int step = 0; step < around; ++step) {
    const std::uint32_t a = center + 1 + static_cast<std::uint32_t>(step);
    const std::uint32_t b = center + 1 + static_cast<std::uint32_t>((step + 1) % around);
    mesh.triangles.emplace_back(center, up ? a : b, up ? b : a);
  }
}

void addCylinder(Mesh& mesh, int around) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int step = 0; step <= around; ++step) {
    const glm::dvec2 c = circle(step, around);
    const glm::dvec3 normal{c.x, 0, c.y};
    addVertex(mesh, {c.x, 1, c.y}, normal, {double(step) / around, 0});
    addVertex(mesh, {c.x, 0, c.y}, normal, {double(step) / around, 1});
  }
  for (int step = 0; step < around; ++step) {
    const std::uint32_t i = first + 2 * static_cast<std::uint32_t>(step);
    addQuad(mesh, i, i + 1, i + 3, i + 2);
  }
  addCap(mesh, 1, true, around);
  addCap(mesh, 0, false, around);
}

void addCone(Mesh& mesh, int around) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int step = 0; step <= around; ++step) {
    const glm::dvec2 c = circle(step, around);
    const glm::dvec2 middle = circle(2 * step + 1, 2 * around);  // each side has an apex with its own normal
    addVertex(mesh, {0, 1, 0}, glm::normalize(glm::dvec3(middle.x, 1, middle.y)), {(step + 0.5) / around, 0});
    addVertex(mesh, {c.x, 0, c.y}, glm::normalize(glm::dvec3(c.x, 1, c.y)), {double(step) / around, 1});
  }
  for (int step = 0; step < around; ++step) {
    const std::uint32_t i = first + 2 * static_cast<std::uint32_t>(step);
    mesh.triangles.emplace_back(i, i + 1, i + 3);
  }
  addCap(mesh, 0, false, around);
}

void addTorus(Mesh& mesh, int around, double minor_radius) {
  const int tube = std::max(3, around / 2);
  const auto row = static_cast<std::uint32_t>(around + 1);
  for (int ring = 0; ring <= tube; ++ring) {
    const glm::dvec2 arc = circle(ring, tube);  // from the inside over the top to the outside
    for (int step = 0; step <= around; ++step) {
      const glm::dvec2 c = circle(step, around);
      const glm::dvec3 normal{arc.y * c.x, -arc.x, arc.y * c.y};
      const double radius = 1 + minor_radius * arc.y;
      const glm::dvec3 place{radius * c.x, minor_radius * -arc.x, radius * c.y};
      addVertex(mesh, place, normal, {double(step) / around, double(ring) / tube});
    }
  }
  for (int ring = 0; ring < tube; ++ring) {
    for (int step = 0; step < around; ++step) {
      const std::uint32_t i = static_cast<std::uint32_t>(ring) * row + static_cast<std::uint32_t>(step);
      addQuad(mesh, i, i + row, i + row + 1, i + 1);
    }
  }
}

}  // namespace

Mesh makePrimitive(const Primitive& primitive, std::uint32_t material) {
  Mesh mesh;
  switch (primitive.kind) {
    case PrimitiveKind::kPlane:
      mesh.name = "plane";
      addRectangle(mesh, {-0.5, 0, -0.5}, {1, 0, 0}, {0, 0, 1}, primitive.segments);
      break;
    case PrimitiveKind::kBox:
      mesh.name = "box";
      addBox(mesh, primitive.segments);
      break;
    case PrimitiveKind::kSphere:
      mesh.name = "sphere";
      addSphere(mesh, primitive.segments);
      break;
    case PrimitiveKind::kCylinder:
      mesh.name = "cylinder";
      addCylinder(mesh, primitive.segments);
      break;
    case PrimitiveKind::kCone:
      mesh.name = "cone";
      addCone(mesh, primitive.segments);
      break;
    case PrimitiveKind::kTorus:
      mesh.name = "torus";
      addTorus(mesh, primitive.segments, primitive.minor_radius);
      break;
  }
  for (glm::vec2& uv : mesh.uvs) uv *= primitive.uv_scale;
  mesh.triangle_materials.assign(mesh.triangles.size(), material);
  if (primitive.lit_segments > 0) {
    Primitive divided = primitive;
    divided.segments = std::exchange(divided.lit_segments, 0);
    mesh.divided = std::make_shared<const Mesh>(makePrimitive(divided, material));
  }
  return mesh;
}

}  // namespace luciole
