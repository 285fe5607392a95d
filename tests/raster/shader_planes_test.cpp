// The planes of a G-buffer that only shaders ask for: tangents, texture coordinates and indices.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gbuffer/packed_normal.hpp"
#include "gbuffer/tangent_plane.hpp"
#include "luciole/primitives.hpp"
#include "raster/raster_scenes.hpp"
#include "raster/shading_points.hpp"
#include "raster/texture_space.hpp"
#include "scene/tangents.hpp"

namespace luciole::test {
namespace {

constexpr PlaneSet kShaderPlanes{.tangent = true, .uv = true, .object = true, .material = true};

/// The rounding of packed directions, radians (see packNormal()), and that of the float normals to which they
/// are perpendicular: three components of up to 2⁻²⁵ each.
constexpr double kPacking = 6.5e-5 + 2 * 1.8 * 0x1p-25;

/// A shape in the middle, turned and stretched, with a second object of another material beside it.
Scene shapeScene(const Primitive& primitive, const glm::dmat4& object_to_world) {
  Scene scene;
  scene.materials = {doubleSided(), doubleSided()};
  scene.meshes = {makePrimitive(primitive, 1)};
  scene.objects.resize(2);
  scene.objects[0].object_to_world = glm::translate(glm::dmat4(1.0), {0, 0, -50});
  scene.objects[1].object_to_world = object_to_world;
  addAllTangents(scene);
  return scene;
}

Camera slantedCamera() {
  Camera camera = frontCamera();
  camera.camera_to_world =
      glm::inverse(glm::lookAt(glm::dvec3(0.7, 2.1, 3.3), glm::dvec3(0.0), glm::dvec3(0.1, 1, 0)));
  return camera;
}

glm::dvec3 tangentAt(const GBuffer& gbuffer, int x, int y) {
  return unpackNormal(gbuffer.tangent[gbuffer.index(x, y)]);
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// The part of a vector in the plane of a unit normal.
glm::dvec3 inPlane(const glm::dvec3& vector, const glm::dvec3& normal) {
  return vector - normal * glm::dot(normal, vector);
}

/// Calls check(x, y, position and normal in the world) for the pixels that show the object.
template <class Check>
int forEachPixelOf(std::uint32_t object, const GBuffer& gbuffer, const Camera& camera, Check check) {
  int shown = 0;
  for (int y = 0; y < gbuffer.height; ++y)
    for (int x = 0; x < gbuffer.width; ++x) {
      if (gbuffer.object[gbuffer.index(x, y)] != object) continue;
      ++shown;
      check(x, y, glm::dvec3(camera.camera_to_world * glm::dvec4(positionAt(gbuffer, x, y), 1.0)),
            glm::dmat3(camera.camera_to_world) * glm::dvec3(valueAt(gbuffer.normal, gbuffer, x, y)));
    }
  return shown;
}

TEST(ShaderPlanes, APlaneHasItsTangentAndCoordinatesEverywhere) {
  const glm::dmat4 to_world = glm::scale(
      glm::rotate(glm::dmat4(1.0), 0.6, glm::normalize(glm::dvec3(1, 2, 3))), glm::dvec3(3.0, 1.0, 0.8));
  const Scene scene = shapeScene({.kind = PrimitiveKind::kPlane, .segments = 3}, to_world);
  const Camera camera = slantedCamera();
  for (const Shading shading : {Shading::kFlat, Shading::kPhong}) {
    const GBuffer gbuffer = draw(scene, cameraView(camera, {61, 47}), shading, kShaderPlanes);
    const int shown = forEachPixelOf(
        1, gbuffer, camera, [&](int x, int y, const glm::dvec3& position, const glm::dvec3& normal) {
          const glm::dvec3 tangent = glm::dmat3(camera.camera_to_world) * tangentAt(gbuffer, x, y);
          ASSERT_LE(angleBetween(tangent, inPlane(to_world[0], normal)), kPacking);
          // x + ½ and z + ½ (addRectangle). Positions of up to 5 m round by 5 · √3 · 2⁻²⁴, which a stretch of
          // 0.8 makes 1.25 times longer; uvs by 2⁻²⁵.
          const glm::dvec3 place(glm::inverse(to_world) * glm::dvec4(position, 1.0));
          const std::size_t i = gbuffer.index(x, y);
          ASSERT_NEAR(gbuffer.uv[i], place.x + 0.5, 5 * 1.8 * 1.25 * 0x1p-24 + 0x1p-25);
          ASSERT_NEAR(gbuffer.uv[i + gbuffer.pixels()], place.z + 0.5, 5 * 1.8 * 1.25 * 0x1p-24 + 0x1p-25);
          ASSERT_EQ(gbuffer.material[i], 1u);
        });
    EXPECT_GT(shown, 200);
  }
}

/// On a surface of revolution u goes around the y axis. Inside a quad between rings of radii r and R, a point
/// and the interpolated tangent have azimuths within a step of δ = 2π / segments of each other, weighted by
/// the corners' weights and by these times the radii: they differ by δ/4 · (R − r)/r at most. Besides, the
/// mean of two chords' directions that meet in a vertex, weighted by angles that differ by (R − r)/r at most,
/// is off by δ/4 · (R − r)/r, and tan and arc differ by δ³/24. Facets' own tangents would be off by δ/2.
void expectTangentsAroundY(const Scene& scene, double least_radius, double ring_step) {
  constexpr double kStep = 2 * std::numbers::pi / 128;
  const double tolerance = kPacking + kStep / 2 * ring_step / least_radius + kStep * kStep * kStep / 24 +
                           4 * 0x1p-24 / least_radius;
  ASSERT_LT(tolerance, kStep / 4);
  const Camera camera = slantedCamera();
  const GBuffer gbuffer = draw(scene, cameraView(camera, {90, 70}), Shading::kPhong, kShaderPlanes);
  double largest = 0;
  const int shown = forEachPixelOf(
      1, gbuffer, camera, [&](int x, int y, const glm::dvec3& position, const glm::dvec3& normal) {
        const glm::dvec2 around(position.x, position.z);
        if (glm::length(around) < least_radius) return;
        // From −z towards −x (circle() of primitives.cpp).
        const glm::dvec3 expected = inPlane({position.z, 0, -position.x}, normal);
        const glm::dvec3 tangent = glm::dmat3(camera.camera_to_world) * tangentAt(gbuffer, x, y);
        largest = std::max(largest, angleBetween(tangent, expected));
      });
  EXPECT_LE(largest, tolerance);
  EXPECT_GT(shown, 500);
}

TEST(ShaderPlanes, ASpheresTangentsGoAroundItSmoothly) {
  expectTangentsAroundY(shapeScene({.kind = PrimitiveKind::kSphere, .segments = 128}, glm::dmat4(1.0)), 0.25,
                        std::numbers::pi / 64);
}

TEST(ShaderPlanes, ATorussTangentsGoAroundItSmoothly) {
  expectTangentsAroundY(
      shapeScene({.kind = PrimitiveKind::kTorus, .segments = 128, .minor_radius = 0.25f}, glm::dmat4(1.0)),
      0.75, 0.25 * 2 * std::numbers::pi / 64);
}

TEST(ShaderPlanes, WithoutCoordinatesTangentsComeFromNormalsAlone) {
  Scene scene = shapeScene({.kind = PrimitiveKind::kSphere, .segments = 64}, glm::dmat4(1.0));
  scene.meshes[0].uvs.clear();
  scene.meshes[0].tangents.clear();
  addAllTangents(scene);
  const Camera camera = slantedCamera();
  const GBuffer gbuffer = draw(scene, cameraView(camera, {90, 70}), Shading::kPhong, kShaderPlanes);
  EXPECT_EQ(gbuffer.tangent, tangentsOf(gbuffer));
  for (const float coordinate : gbuffer.uv) EXPECT_EQ(coordinate, 0.0f);
  int near_pole = 0;
  forEachPixelOf(1, gbuffer, camera, [&](int x, int y, const glm::dvec3&, const glm::dvec3& normal) {
    const glm::dvec3 around = glm::cross(glm::dvec3(0, 1, 0), normal);
    const glm::dvec3 tangent = glm::dmat3(camera.camera_to_world) * tangentAt(gbuffer, x, y);
    near_pole += glm::length(around) < 0.05;
    // The normal's rounding turns what is left of `up`.
    ASSERT_LE(angleBetween(tangent, around), kPacking + 1.8 * 0x1p-24 / glm::length(around));
  });
  EXPECT_GT(near_pole, 0);
}

TEST(ShaderPlanes, AFloorWithoutCoordinatesHasTheWorldsZ) {
  Scene scene = shapeScene({.kind = PrimitiveKind::kPlane}, glm::dmat4(1.0));
  scene.meshes[0].uvs.clear();
  scene.meshes[0].tangents.clear();
  const Camera camera = slantedCamera();
  const GBuffer gbuffer = draw(scene, cameraView(camera, {31, 31}), Shading::kPhong, kShaderPlanes);
  const int shown =
      forEachPixelOf(1, gbuffer, camera, [&](int x, int y, const glm::dvec3&, const glm::dvec3&) {
        const glm::dvec3 tangent = glm::dmat3(camera.camera_to_world) * tangentAt(gbuffer, x, y);
        ASSERT_LE(angleBetween(tangent, {0, 0, 1}), kPacking);  // cross(x, up)
      });
  EXPECT_GT(shown, 30);
}

TEST(ShaderPlanes, BackgroundHasNoIndices) {
  const Scene scene = shapeScene({.kind = PrimitiveKind::kSphere, .segments = 16}, glm::dmat4(1.0));
  GBuffer gbuffer = draw(scene, cameraView(frontCamera(), {33, 17}), Shading::kPhong, kShaderPlanes);
  gbuffer = rasterize(scene, {}, cameraView(frontCamera(), {17, 33}), Shading::kPhong, kShaderPlanes, {},
                      nullptr, std::move(gbuffer));
  const auto all_are = [](const auto& plane, auto value) {
    return !plane.empty() && std::all_of(plane.begin(), plane.end(), [&](auto v) { return v == value; });
  };
  EXPECT_TRUE(all_are(gbuffer.object, kNoIndex) && all_are(gbuffer.material, kNoIndex));
  EXPECT_TRUE(all_are(gbuffer.tangent, 0u) && all_are(gbuffer.uv, 0.0f));
}

TEST(ShaderPlanes, AreAbsentUnlessAskedForAndChangeNoOther) {
  const Scene scene = shapeScene({.kind = PrimitiveKind::kTorus, .segments = 24}, glm::dmat4(1.0));
  const View view = cameraView(slantedCamera(), {61, 47});
  const GBuffer without = draw(scene, view), with = draw(scene, view, Shading::kPhong, kShaderPlanes);
  EXPECT_TRUE(without.tangent.empty() && without.uv.empty() && without.object.empty() &&
              without.material.empty());
  EXPECT_EQ(with.position, without.position);
  EXPECT_EQ(with.normal, without.normal);
  EXPECT_EQ(with.diffuse, without.diffuse);
}

TEST(ShaderPlanes, VerticesHaveTheirOwn) {
  const Scene scene = shapeScene({.kind = PrimitiveKind::kTorus, .segments = 12}, glm::dmat4(1.0));
  const Mesh& mesh = scene.meshes[0];
  const Camera camera = slantedCamera();
  const GBuffer vertices =
      gatherVertices(scene, allObjects(scene), cameraView(camera, {8, 8}), kShaderPlanes);
  const std::size_t count = mesh.positions.size();
  for (std::size_t i = 0; i < vertices.pixels(); ++i) {
    const bool is_there = i < 2 * count;
    ASSERT_EQ(vertices.object[i], is_there ? std::uint32_t(i / count) : kNoIndex);
    ASSERT_EQ(vertices.material[i], is_there ? 1u : kNoIndex);
    if (!is_there) continue;
    ASSERT_EQ(glm::vec2(vertices.uv[i], vertices.uv[i + vertices.pixels()]), mesh.uvs[i % count]);
    const glm::dvec3 tangent = glm::dmat3(camera.camera_to_world) * unpackNormal(vertices.tangent[i]);
    // Both the mesh's tangent and its normal are floats.
    ASSERT_LE(angleBetween(tangent, glm::dvec3(mesh.tangents[i % count])), kPacking + 2 * 1.8 * 0x1p-24);
  }
}

// Of a scene that is as its map lies, as in texture_space_test.cpp.
TEST(ShaderPlanes, AMapHasWhatACameraSees) {
  Scene scene = rectangleScene(1, 1, 0);
  scene.meshes[0].normals.assign(4, glm::normalize(glm::vec3(0.2f, 0.1f, 1.0f)));
  addAllTangents(scene);
  Camera above;
  above.orthographic = true;
  above.camera_to_world[3] = {0, 0, 2, 1};
  const GBuffer seen = draw(scene, cameraView(above, {50, 50}), Shading::kPhong, kShaderPlanes);
  const GBuffer map = rasterizeTextureSpace(scene, 0, {50, 50}, above, kShaderPlanes).gbuffer;
  EXPECT_EQ(map.object, seen.object);
  EXPECT_EQ(map.material, seen.material);
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 50; ++x) {
      ASSERT_LE(angleBetween(tangentAt(map, x, y), tangentAt(seen, x, y)), 2 * kPacking);
      for (std::size_t c = 0; c < 2; ++c) {
        const std::size_t i = map.index(x, y) + c * map.pixels();
        ASSERT_NEAR(map.uv[i], seen.uv[i], 3 * 0x1p-24);  // places are off by three roundings of 1
      }
    }
}

// Two squares side by side that continue each other, but for their texture coordinates.
TEST(ShaderPlanes, SurfacesOfOtherCoordinatesShareNoPoint) {
  Scene scene = meshScene(
      {{-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}, {0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0}},
      {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}});
  scene.meshes[0].uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {5, 1}, {6, 1}, {6, 0}, {5, 0}};
  Camera camera = frontCamera();
  camera.orthographic = true;
  camera.half_height = 1;
  camera.camera_to_world[3] = {0.01, 0, 2, 1};
  const auto points = [&](PlaneSet planes) {
    const std::vector<std::uint32_t> objects = allObjects(scene);
    const SampledView sampled = setupSamples(scene, objects, cameraView(camera, {16, 16}), Margin::kPixel, 16,
                                             Shading::kPhong, planes, {});
    RasterCounts counts;
    std::size_t further = 0;
    for (const auto& list : shareSamples(sampled, counts).further) further += list.size();
    return further;
  };
  EXPECT_EQ(points({}), 0u);
  EXPECT_EQ(points({.uv = true}), 16u);
}

}  // namespace
}  // namespace luciole::test
