#include "raster/lift.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "luciole/primitives.hpp"
#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

Scene primitiveScene(PrimitiveKind kind, int segments, const glm::dmat4& place) {
  Scene scene;
  scene.materials.push_back(doubleSided());
  scene.meshes.push_back(makePrimitive({.kind = kind, .segments = segments}, 0));
  scene.objects.push_back({0, place, -1});
  return scene;
}

glm::dmat4 at(const glm::dvec3& place) { return glm::translate(glm::dmat4(1), place); }

GBuffer drawLifts(const Scene& scene, const Camera& camera = frontCamera()) {
  return draw(scene, cameraView(camera, {90, 80}), Shading::kPhong, {.geometric_normal = true, .lift = true});
}

template <class Visit>
void forEachCovered(const GBuffer& gbuffer, Visit visit) {
  int covered = 0;
  for (int y = 0; y < gbuffer.height; ++y)
    for (int x = 0; x < gbuffer.width; ++x) {
      const std::size_t i = gbuffer.index(x, y), n = gbuffer.pixels();
      const auto triple = [&](const Plane& plane) {
        return glm::dvec3(plane[i], plane[i + n], plane[i + 2 * n]);
      };
      if (std::isinf(gbuffer.position[i + 2 * n])) continue;
      ++covered;
      visit(triple(gbuffer.position), triple(gbuffer.normal), double(gbuffer.lift[i]));
    }
  EXPECT_GT(covered, 500);
}

/// The object's vertices in view space.
std::vector<glm::dvec3> placedVertices(const Scene& scene) {
  std::vector<glm::dvec3> vertices;
  for (const glm::vec3& position : scene.meshes[0].positions)
    vertices.push_back(glm::dvec3(scene.objects[0].object_to_world * glm::dvec4(position, 1)));
  return vertices;
}

/// The plane through a pixel's start point that its normal stands on has all of the object behind it,
/// wherever its outside is seen.
void expectObjectBehindTangentPlanes(const Scene& scene, const Camera& camera = frontCamera()) {
  const std::vector<glm::dvec3> vertices = placedVertices(scene);
  int lifted = 0;
  forEachCovered(drawLifts(scene, camera),
                 [&](const glm::dvec3& position, const glm::dvec3& normal, double lift) {
                   if (lift == 0) return;
                   ++lifted;
                   const glm::dvec3 start = position + lift * normal;
                   for (const glm::dvec3& vertex : vertices)
                     // Position, lift and normal are rounded once each; the mesh's own positions and normals
                     // too.
                     ASSERT_LE(glm::dot(vertex - start, normal), 8 * kFloatRounding * glm::length(vertex));
                 });
  EXPECT_GT(lifted, 200);
}

TEST(Lift, PutsPointsOfABallOntoPlanesThatHaveItBehindThem) {
  for (const int segments : {8, 16, 40})
    expectObjectBehindTangentPlanes(primitiveScene(PrimitiveKind::kSphere, segments, at({0.1, 0.2, -3})));
}

TEST(Lift, DoesSoForEllipsoidsMirroredAndTurned) {
  const glm::dmat4 turned = glm::rotate(at({0.1, -0.2, -4}), 0.7, glm::dvec3(1, 2, -0.5));
  for (const glm::dvec3& sides : {glm::dvec3(1.5, 0.6, 1.1), {-1.5, 0.6, 1.1}, {-0.3, -2, -1}})
    expectObjectBehindTangentPlanes(primitiveScene(PrimitiveKind::kSphere, 16, glm::scale(turned, sides)));
}

TEST(Lift, DoesSoForTrianglesThatTheNearPlaneCuts) {
  Camera camera = frontCamera();
  camera.near = 2.2;
  expectObjectBehindTangentPlanes(primitiveScene(PrimitiveKind::kSphere, 16, at({0, 0, -3})), camera);
}

TEST(Lift, OfABallIsHowFarItsSurfaceLiesAboveTheFacet) {
  // p = n, so that |p| + lift = (1 + |p|²) / 2|p|: beyond the ball's surface by
  // (1 − |p|)² / 2|p|.
  const glm::dvec3 middle(0, 0, -3);
  const GBuffer gbuffer = drawLifts(primitiveScene(PrimitiveKind::kSphere, 16, at(middle)));
  forEachCovered(gbuffer, [&](const glm::dvec3& position, const glm::dvec3&, double lift) {
    const double r = glm::distance(position, middle);
    // A point's float rounding is 3 m's at the most.
    EXPECT_NEAR(r + lift, (1 + r * r) / (2 * r), 8 * 3 * kFloatRounding);
  });
}

TEST(Lift, IsNoneOnFlatFacetsAndFlatShading) {
  const auto expectNone = [](const GBuffer& gbuffer) {
    ASSERT_EQ(gbuffer.lift.size(), gbuffer.pixels());
    EXPECT_TRUE(std::all_of(gbuffer.lift.begin(), gbuffer.lift.end(), [](float lift) { return lift == 0; }));
  };
  const glm::dmat4 place = glm::rotate(at({1e3, 2e3, -3}), 0.7, glm::dvec3(1, 2, -0.5));
  Camera camera = frontCamera();
  camera.camera_to_world = at({1e3, 2e3, 0});
  Scene box = primitiveScene(PrimitiveKind::kBox, 0, glm::scale(place, glm::dvec3(1, 3, 0.1)));
  EXPECT_FALSE(hasBentCorners(box));
  expectNone(drawLifts(box, camera));
  // Normals as files have them, with four digits.
  for (glm::vec3& normal : box.meshes[0].normals) normal += glm::vec3(4e-5f, -3e-5f, 5e-5f);
  EXPECT_FALSE(hasBentCorners(box));
  expectNone(drawLifts(box, camera));
  const Scene ball = primitiveScene(PrimitiveKind::kSphere, 16, at({0, 0, -3}));
  EXPECT_TRUE(hasBentCorners(ball));
  expectNone(draw(ball, cameraView(frontCamera(), {90, 80}), Shading::kFlat, {.lift = true}));
}

TEST(Lift, IsNoneInHollows) {
  // From within, where the side that is seen is the inner one.
  for (const auto kind : {PrimitiveKind::kSphere, PrimitiveKind::kCylinder}) {
    const GBuffer gbuffer = drawLifts(primitiveScene(kind, 16, at({0.1, -0.3, 0.2})));
    forEachCovered(gbuffer, [](const glm::dvec3&, const glm::dvec3&, double lift) { EXPECT_EQ(lift, 0); });
  }
}

TEST(Lift, StaysBelowHalfOfTheLongestSideWhateverTheNormals) {
  // Away from the facet, to its other side, and none at all.
  const glm::vec3 kinds[] = {{-1, -1, 0.01f}, {1, 1, 0.01f}, {0, 0, -1},
                             {0, 0, 0},       {0, 0, 1},     {-3e38f, 0, 3e38f}};
  for (const glm::vec3& a : kinds)
    for (const glm::vec3& b : kinds)
      for (const glm::vec3& c : kinds) {
        Scene scene = meshScene({{-1, -1, -2}, {1, -1, -2}, {0, 1, -2}}, {{0, 1, 2}});
        scene.meshes[0].normals = {a, b, c};
        forEachCovered(drawLifts(scene), [](const glm::dvec3&, const glm::dvec3&, double lift) {
          ASSERT_GE(lift, 0);
          ASSERT_LE(lift, std::sqrt(5.0) / 2 * (1 + kFloatRounding));
        });
      }
}

}  // namespace
}  // namespace luciole::test
