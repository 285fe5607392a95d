#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

struct Nearest {
  int triangle = -1;
  Hit hit{1e300, {}};
};

Nearest cast(const Ray& ray, const Mesh& mesh, const glm::dmat4& to_view) {
  Nearest nearest;
  const auto corner = [&](std::uint32_t i) {
    return glm::dvec3(to_view * glm::dvec4(mesh.positions[i], 1.0));
  };
  for (int i = 0; i < int(mesh.triangles.size()); ++i) {
    const glm::uvec3 t = mesh.triangles[i];
    const auto hit = intersect(ray, corner(t.x), corner(t.y), corner(t.z));
    if (hit && hit->t < nearest.hit.t) nearest = {i, *hit};
  }
  return nearest;
}

/// A cloud of triangles in front of the camera, with vertex normals and colours of their own.
Scene triangleSoup(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 center = 4.0f * vector() + glm::vec3(0, 0, -7);
    const std::uint32_t first = std::uint32_t(positions.size());
    for (int k = 0; k < 3; ++k) positions.push_back(center + vector());
    triangles.push_back({first, first + 1, first + 2});
  }
  Scene scene = meshScene(positions, triangles);
  for (glm::vec3& normal : scene.meshes[0].normals) normal = glm::normalize(vector() + glm::vec3(0, 0, 2));
  for (std::size_t i = 0; i < positions.size(); ++i)
    scene.meshes[0].colors.push_back({0.5f + 0.5f * vector(), 1.0f});
  return scene;
}

/// Compares every pixel whose surroundings show one triangle with rays cast in double.
void expectAsCast(const Scene& scene, const Camera& camera, glm::ivec2 size) {
  const GBuffer gbuffer = draw(scene, cameraView(camera, size));
  const Mesh& mesh = scene.meshes[0];
  const glm::dmat4 to_view = glm::inverse(camera.camera_to_world) * scene.objects[0].object_to_world;
  const glm::dmat3 normal_to_view = glm::transpose(glm::inverse(glm::dmat3(to_view)));
  int compared = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const std::vector<Ray> rays = raysAround(camera, size, x, y);
      const Nearest seen = cast(rays[0], mesh, to_view);
      bool clear = true;
      for (const Ray& ray : rays) clear &= cast(ray, mesh, to_view).triangle == seen.triangle;
      if (!clear) continue;
      ASSERT_EQ(isCovered(gbuffer, x, y), seen.triangle >= 0) << x << ',' << y;
      if (seen.triangle < 0) continue;
      const glm::uvec3 t = mesh.triangles[seen.triangle];
      const glm::dvec3 point = rays[0].origin + seen.hit.t * rays[0].direction;
      const glm::dvec3& w = seen.hit.weights;
      glm::dvec3 normal = glm::normalize(normal_to_view * (w.x * glm::dvec3(mesh.normals[t.x]) +
                                                           w.y * glm::dvec3(mesh.normals[t.y]) +
                                                           w.z * glm::dvec3(mesh.normals[t.z])));
      const auto corner = [&](int i) { return glm::dvec3(to_view * glm::dvec4(mesh.positions[t[i]], 1.0)); };
      const glm::dvec3 flat = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
      const double facing = glm::dot(glm::normalize(flat), rays[0].direction);
      const bool mirrored = glm::determinant(glm::dmat3(to_view)) < 0.0;
      if ((facing > 0.0) != mirrored) normal = -normal;
      const glm::dvec3 color = w.x * glm::dvec3(mesh.colors[t.x]) + w.y * glm::dvec3(mesh.colors[t.y]) +
                               w.z * glm::dvec3(mesh.colors[t.z]);
      // Stored as float. In double both ways of intersecting take some 30 operations, whose errors are
      // relative to the positions (15 lengths of an edge) and grow with the slope under which the ray meets
      // the triangle.
      const double weights_error = 30.0 * 0x1p-53 * 15.0 / std::abs(facing);
      const double rounding = kFloatRounding * 1.01;
      ASSERT_LE(glm::length(glm::dvec3(positionAt(gbuffer, x, y)) - point),
                rounding * glm::length(point) + 4.0 * weights_error)
          << x << ',' << y;
      // The interpolated normal is at least 0.3 long and of a length at most 3 off per unit weight.
      ASSERT_LE(glm::length(glm::dvec3(valueAt(gbuffer.normal, gbuffer, x, y)) - normal),
                rounding + 40 * weights_error)
          << x << ',' << y;
      // Three weights and colours in float: six roundings of numbers up to 1.
      ASSERT_LE(glm::length(glm::dvec3(valueAt(gbuffer.diffuse, gbuffer, x, y)) - color),
                std::sqrt(3.0) * 6.0 * kFloatRounding + 4.0 * weights_error)
          << x << ',' << y;
      ++compared;
    }
  EXPECT_GT(compared, size.x * size.y / 8);
}

TEST(Accuracy, PositionsNormalsAndColorsAsRaysSeeThem) {
  for (unsigned seed = 0; seed < 4; ++seed) expectAsCast(triangleSoup(80, seed), frontCamera(), {96, 71});
}

TEST(Accuracy, ParallelViews) {
  Camera camera = frontCamera();
  camera.orthographic = true;
  camera.half_height = 3.5;
  for (unsigned seed = 4; seed < 7; ++seed) expectAsCast(triangleSoup(80, seed), camera, {96, 71});
}

TEST(Accuracy, ScaledTurnedAndMirroredObjects) {
  for (const glm::dvec3& scale :
       {glm::dvec3(0.7, 1.3, 1.0), {-0.8, 1.0, 1.2}, {-1.0, -0.6, 1.0}, {-1.1, -0.9, -1.0}}) {
    Scene scene = triangleSoup(80, 9);
    Camera camera = frontCamera();
    camera.camera_to_world = glm::rotate(glm::translate(glm::dmat4(1.0), {1, 2, 3}), 0.7, {0.6, 0.8, 0.0});
    const glm::dmat4 middle = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, 7));
    const glm::dmat4 place = glm::translate(camera.camera_to_world, glm::dvec3(0, 0, -7));
    scene.objects[0].object_to_world = glm::scale(place, scale) * middle;
    expectAsCast(scene, camera, {60, 50});
  }
}

TEST(Accuracy, ASmallTriangleFarAway) {
  // 1 mm at 1 km, filling a narrow view. Its barycentric coordinates must keep digits that a product of whole
  // positions would lose: those err by ε · (10³ m / 10⁻³ m)² = 10⁻⁴.
  Scene scene = meshScene({{-1e-3f, -1e-3f, 0}, {1e-3f, -1e-3f, 1e-4f}, {0, 1e-3f, 0}}, {{0, 1, 2}});
  scene.objects[0].object_to_world = glm::translate(glm::dmat4(1.0), glm::dvec3(3.0, 2.0, -1000.0));
  scene.meshes[0].colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  Camera camera = frontCamera();
  camera.fov_y = 2e-6;
  camera.camera_to_world = glm::translate(glm::dmat4(1.0), glm::dvec3(3.0, 2.0, 0.0));
  const glm::ivec2 size(40, 40);
  const GBuffer gbuffer = draw(scene, cameraView(camera, size));
  const Mesh& mesh = scene.meshes[0];
  int compared = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const Ray ray = pixelRay(camera, size, x + 0.5, y + 0.5);
      const glm::dvec3 far(0.0, 0.0, -1000.0);
      const auto hit = intersect({ray.origin - far, ray.direction}, mesh.positions[0], mesh.positions[1],
                                 mesh.positions[2]);
      if (!hit || std::min({hit->weights.x, hit->weights.y, hit->weights.z}) < 0.01) continue;
      // Positions of 10³ m err by ε · 10³ m, edges of 10⁻³ m thus by 10⁶ ε relative, in some 20 operations.
      EXPECT_LE(glm::length(glm::dvec3(valueAt(gbuffer.diffuse, gbuffer, x, y)) - hit->weights),
                20.0 * 1e6 * 0x1p-53 + 6.0 * kFloatRounding);
      ++compared;
    }
  EXPECT_GT(compared, 300);
}

TEST(Accuracy, PerspectiveCorrectInterpolationOnASteepFloor) {
  Scene scene = meshScene({{-4, -1, 1}, {4, -1, 1}, {0, -1, -60}}, {{0, 1, 2}});
  scene.meshes[0].colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0.5f, 1}};
  const Camera camera = frontCamera();
  const glm::ivec2 size(120, 90);
  const GBuffer gbuffer = draw(scene, cameraView(camera, size));
  const std::vector<glm::vec3>& p = scene.meshes[0].positions;
  int compared = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const auto hit = intersect(pixelRay(camera, size, x + 0.5, y + 0.5), p[0], p[1], p[2]);
      if (!hit || std::min({hit->weights.x, hit->weights.y, hit->weights.z}) < 0.01) continue;
      ++compared;
      const glm::dvec3 expected(hit->weights.y, hit->weights.z, 0.5 * hit->weights.z);
      EXPECT_LE(glm::length(glm::dvec3(valueAt(gbuffer.diffuse, gbuffer, x, y)) - expected),
                12.0 * kFloatRounding);
    }
  EXPECT_GT(compared, 1000);
}

TEST(Accuracy, TenThousandKilometresFromTheOrigin) {
  // Object and camera move together by multiples of 2⁻³ m, which doubles hold exactly at 10⁷ m: only the
  // products of the camera's turn with 10⁷ m round, by 6 · 2⁻⁵³ · 10⁷ m · √3 in all.
  const Scene scene = triangleSoup(60, 11);
  Camera camera = frontCamera();
  camera.camera_to_world = glm::rotate(glm::dmat4(1.0), 0.3, {0.0, 1.0, 0.0});
  const glm::dmat4 move = glm::translate(glm::dmat4(1.0), glm::dvec3(1e7, -1e7 + 0.125, 1e7 - 0.5));
  Scene moved = scene;
  moved.objects[0].object_to_world = move;
  Camera moved_camera = camera;
  moved_camera.camera_to_world = move * camera.camera_to_world;
  const glm::ivec2 size(96, 71);
  const GBuffer near = draw(scene, cameraView(camera, size));
  const GBuffer far = draw(moved, cameraView(moved_camera, size));
  const double shift = 6.0 * 0x1p-53 * 1e7 * std::sqrt(3.0);
  int compared = 0;
  int different = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec3 a = positionAt(near, x, y);
      const glm::dvec3 b = positionAt(far, x, y);
      if (!std::isfinite(a.z) && !std::isfinite(b.z)) continue;
      ++compared;
      // A ray meets the moved triangle farther by the shift over the slope, here at least 1/100 for all but a
      // few.
      if (!(glm::length(a - b) <= 2.0 * kFloatRounding * glm::length(a) + 100.0 * shift)) ++different;
    }
  EXPECT_GT(compared, 1000);
  // Corners may snap to the next 1/256 pixel, which hands a sample on an edge to a neighbour: one edge in 10⁵
  // samples.
  EXPECT_LE(different, 5);
}

}  // namespace
}  // namespace luciole::test
