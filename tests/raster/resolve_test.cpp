#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "raster/coverage.hpp"
#include "raster/raster_scenes.hpp"

namespace luciole::test {
namespace {

Texture texture(int width, int height, std::vector<glm::u16vec4> texels) {
  MipLevel level{width, height, {}};
  bool alpha_varies = false;
  for (const glm::u16vec4& texel : texels) {
    for (int i = 0; i < 4; ++i) level.texels.push_back(texel[i]);
    alpha_varies |= texel.a != texels[0].a;
  }
  return {"", {level}, alpha_varies};
}
constexpr std::uint16_t kOne = 65535;

/// A scene of two rectangles at different depths, the first given first.
Scene twoRectangles(float first_z, float second_z) {
  Scene scene = rectangleScene(1e3f, 1e3f, 0.0f);
  scene.materials.push_back(doubleSided());
  scene.materials[0].diffuse = {1, 0, 0};
  scene.materials[1].diffuse = {0, 1, 0};
  scene.objects.push_back(scene.objects[0]);
  for (int i = 0; i < 2; ++i) {
    const double z = i == 0 ? first_z : second_z;
    scene.objects[i].material = i;
    scene.objects[i].object_to_world =
        glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, z)), glm::dvec3(std::abs(z)));
  }
  return scene;
}

TEST(Resolve, TheNearerSurfaceWinsAtAnyDistanceInAnyOrder) {
  Camera camera;
  camera.near = 1e-6;
  camera.far = 1e8;
  const View view = cameraView(camera, {9, 9});
  for (const float z : {-2e-6f, -1e-3f, -1.0f, -1e3f, -1e7f, -9.9e7f}) {
    // Reversed depth is near / z to within n / f = 10⁻¹⁴ of itself until close to the far plane: 10⁻⁶ apart,
    // depths are 8 floats apart, and one of them errs by 1.
    const float behind = z * (1.0f + 1e-6f);
    EXPECT_EQ(
        valueAt(draw(twoRectangles(z, behind), view).diffuse, draw(twoRectangles(z, behind), view), 4, 4),
        glm::vec3(1, 0, 0))
        << z;
    const GBuffer reversed = draw(twoRectangles(behind, z), view);
    EXPECT_EQ(valueAt(reversed.diffuse, reversed, 4, 4), glm::vec3(0, 1, 0)) << z;
  }
}

TEST(Resolve, AtEqualDepthTheFirstWins) {
  const GBuffer gbuffer = draw(twoRectangles(-3.0f, -3.0f), cameraView(frontCamera(), {90, 90}));
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 90; ++x) ASSERT_EQ(valueAt(gbuffer.diffuse, gbuffer, x, y), glm::vec3(1, 0, 0));
}

TEST(Resolve, BackFacesAreCulledUnlessDoubleSided) {
  Material single = doubleSided();
  single.double_sided = false;
  const View view = cameraView(frontCamera(), {20, 20});
  const auto seen = [&](const Material& material, bool reversed, bool mirrored) {
    Scene scene = rectangleScene(10, 10, -2, material);
    if (reversed)
      for (glm::uvec3& t : scene.meshes[0].triangles) std::swap(t.y, t.z);
    if (mirrored) scene.objects[0].object_to_world = glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, 1));
    RasterCounts counts;
    const GBuffer gbuffer = draw(scene, view, Shading::kPhong, {}, &counts);
    EXPECT_EQ(counts.back_facing, isCovered(gbuffer, 10, 10) ? 0u : 2u);
    return isCovered(gbuffer, 10, 10);
  };
  EXPECT_TRUE(seen(single, false, false));
  EXPECT_FALSE(seen(single, true, false));
  // A mirror turns the winding, and what faced the viewer still does.
  EXPECT_TRUE(seen(single, false, true));
  EXPECT_FALSE(seen(single, true, true));
  EXPECT_TRUE(seen(doubleSided(), true, false));
  EXPECT_TRUE(seen(doubleSided(), true, true));
}

TEST(Resolve, NormalsOfDoubleSidedSurfacesTurnWithTheSideSeen) {
  const float tilt = std::sqrt(0.5f);
  for (const bool reversed : {false, true}) {
    Scene scene = rectangleScene(10, 10, -2);
    if (reversed)
      for (glm::uvec3& t : scene.meshes[0].triangles) std::swap(t.y, t.z);
    for (glm::vec3& normal : scene.meshes[0].normals) normal = {tilt, 0, reversed ? -tilt : tilt};
    const View view = cameraView(frontCamera(), {20, 20});
    const GBuffer flat = draw(scene, view, Shading::kFlat);
    EXPECT_EQ(valueAt(flat.normal, flat, 10, 10), glm::vec3(0, 0, 1));
    const GBuffer phong = draw(scene, view, Shading::kPhong);
    const glm::vec3 expected(reversed ? -tilt : tilt, 0, tilt);
    EXPECT_LE(glm::length(valueAt(phong.normal, phong, 10, 10) - expected), 4 * kFloatRounding);
  }
}

TEST(Resolve, FacingIsTheTrianglesNotItsNormals) {
  // Normals that point away from the viewer on a front face stay as they are.
  Scene scene = rectangleScene(10, 10, -2);
  for (glm::vec3& normal : scene.meshes[0].normals) normal = {0, 0, -1};
  const GBuffer gbuffer = draw(scene, cameraView(frontCamera(), {20, 20}));
  EXPECT_EQ(valueAt(gbuffer.normal, gbuffer, 10, 10), glm::vec3(0, 0, -1));
}

TEST(Resolve, ZeroNormalsFallBackToTheTriangles) {
  Scene scene = rectangleScene(10, 10, -2);
  for (glm::vec3& normal : scene.meshes[0].normals) normal = glm::vec3(0.0f);
  const GBuffer gbuffer = draw(scene, cameraView(frontCamera(), {20, 20}));
  EXPECT_EQ(valueAt(gbuffer.normal, gbuffer, 10, 10), glm::vec3(0, 0, 1));
}

TEST(Resolve, MaterialsMapsAndVertexColorsMultiply) {
  Material material = doubleSided();
  material.diffuse = {0.5f, 0.25f, 1.0f};
  material.ambient = {0.25f, 0.5f, 1.0f};
  material.specular = {0.1f, 0.2f, 0.3f};
  material.emission = {2.0f, 4.0f, 8.0f};
  material.shininess = 17.0f;
  material.diffuse_map.texture = 0;
  material.emission_map.texture = 1;
  Scene scene = rectangleScene(10, 10, -2, material);
  scene.textures = {texture(1, 1, {{kOne, 0, kOne, kOne}}), texture(1, 1, {{0, kOne, kOne, kOne}})};
  scene.meshes[0].colors.assign(4, {0.5f, 0.5f, 0.25f, 1.0f});
  const GBuffer gbuffer =
      draw(scene, cameraView(frontCamera(), {20, 20}), Shading::kPhong, {true, true, true});
  // Powers of two: nothing rounds but the three weights, whose sum errs by 2 units in the last place.
  const auto expect_near = [&](const Plane& group, glm::vec3 expected) {
    EXPECT_LE(glm::length(valueAt(group, gbuffer, 9, 12) - expected),
              6 * kFloatRounding * glm::length(expected));
  };
  expect_near(gbuffer.diffuse, {0.25f, 0.0f, 0.25f});
  expect_near(gbuffer.ambient, {0.125f, 0.0f, 0.25f});
  expect_near(gbuffer.specular, material.specular);
  expect_near(gbuffer.emission, {0.0f, 4.0f, 8.0f});
  EXPECT_EQ(gbuffer.specular[3 * gbuffer.pixels() + gbuffer.index(9, 12)], 17.0f);
}

TEST(Resolve, TextureCoordinatesWithoutAreaGiveOneTexel) {
  Material material = doubleSided();
  material.diffuse_map.texture = 0;
  Scene scene = rectangleScene(10, 10, -2, material);
  scene.textures = {texture(2, 1, {{kOne, 0, 0, kOne}, {0, kOne, 0, kOne}})};
  for (glm::vec2& uv : scene.meshes[0].uvs) uv = {0.75f, 0.5f};
  const GBuffer gbuffer = draw(scene, cameraView(frontCamera(), {20, 20}));
  EXPECT_EQ(valueAt(gbuffer.diffuse, gbuffer, 3, 17), glm::vec3(0, 1, 0));
  scene.meshes[0].uvs.clear();  // a map without coordinates is left out
  const GBuffer bare = draw(scene, cameraView(frontCamera(), {20, 20}));
  EXPECT_EQ(valueAt(bare.diffuse, bare, 3, 17), glm::vec3(1, 1, 1));
}

TEST(Resolve, AMapsLevelFollowsThePixelsFootprint) {
  // A texel a pixel along one axis, four along the other: level 2, which alone is white.
  for (const glm::ivec2& finest : {glm::ivec2(128, 32), glm::ivec2(32, 128)}) {
    Material material = doubleSided();
    material.diffuse_map.texture = 0;
    Scene scene = rectangleScene(16, 16, -2, material);
    Texture map;
    for (int level = 0; level < 8; ++level) {
      const glm::ivec2 size = glm::max(finest >> level, 1);
      map.levels.push_back({size.x, size.y, {}});
      map.levels.back().texels.assign(std::size_t(4) * size.x * size.y, level == 2 ? kOne : 0);
    }
    scene.textures = {map};
    const GBuffer gbuffer = draw(scene, pixelView({32, 32}));
    // The level is the logarithm of a difference of coordinates up to 1 in steps of 1/32, and 4 texels of it
    // are 1/32.
    for (int i = 0; i < 32; ++i)
      EXPECT_NEAR(valueAt(gbuffer.diffuse, gbuffer, i, 31 - i).x, 1.0f, 32 * kFloatRounding / std::log(2.0));
  }
}

/// A rectangle in front whose left half is a hole, and another behind it.
Scene holeScene(const Material& masked, const Texture& map) {
  Scene scene = rectangleScene(10, 10, -2, masked);
  scene.textures = {map};
  scene.materials.push_back(doubleSided());
  scene.meshes.push_back(scene.meshes[0]);
  scene.meshes[1].triangle_materials = {1, 1};
  scene.objects.push_back({});
  scene.objects[1].mesh = 1;
  scene.objects[1].object_to_world = glm::scale(glm::dmat4(1.0), glm::dvec3(2.0));
  return scene;
}

void expectLeftHalfOpen(const Scene& scene) {
  Camera camera = frontCamera();
  camera.fov_y = 2.0 * std::atan(5.0);  // the rectangle in front fills the picture
  const View view = cameraView(camera, {40, 40});
  const GBuffer gbuffer = draw(scene, view);
  const std::vector<ShadowTexel> map = depthOf(scene, view);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      if (x > 18 && x < 21) continue;  // filtered across the middle
      ASSERT_EQ(positionAt(gbuffer, x, y).z, x < 20 ? -4.0f : -2.0f) << x << ',' << y;
      ASSERT_EQ(map[y * 40 + x].depth > 0.75f * float(camera.near) / 2.0f, x > 20) << x << ',' << y;
    }
}

TEST(Resolve, HolesShowWhatIsBehind) {
  Material material = doubleSided();
  material.alpha_cutoff = 0.5f;
  material.diffuse_map = {0, Wrap::kClampToEdge, Wrap::kClampToEdge};
  expectLeftHalfOpen(holeScene(material, texture(2, 1, {{kOne, kOne, kOne, 0}, {kOne, kOne, kOne, kOne}})));
  material.diffuse_map = {};
  material.alpha_map = {0, Wrap::kClampToEdge, Wrap::kClampToEdge};
  expectLeftHalfOpen(holeScene(material, texture(2, 1, {{kOne, kOne, kOne, 0}, {0, 0, 0, kOne}})));
}

TEST(Resolve, AnOpacityMapWithoutAlphaCountsByItsRedCodes) {
  Material material = doubleSided();
  material.alpha_cutoff = 0.5f;
  material.alpha_map = {0, Wrap::kClampToEdge, Wrap::kClampToEdge};
  // Codes 0.4 and 0.6, which stand for the light 0.13 and 0.32.
  expectLeftHalfOpen(holeScene(material, texture(2, 1, {{26214, 0, 0, kOne}, {39321, 0, 0, kOne}})));
}

TEST(Resolve, ConstantAndVertexAlphaMultiplyTheMaps) {
  Material material = doubleSided();
  material.alpha_cutoff = 0.5f;
  const View view = cameraView(frontCamera(), {20, 20});
  const auto seen = [&](float alpha, float vertex_alpha) {
    Scene scene = rectangleScene(10, 10, -2, material);
    scene.materials[0].alpha = alpha;
    scene.meshes[0].colors.assign(4, {1, 1, 1, vertex_alpha});
    return isCovered(draw(scene, view), 10, 10);
  };
  EXPECT_TRUE(seen(1.0f, 1.0f));
  EXPECT_TRUE(seen(0.9f, 0.6f));
  EXPECT_FALSE(seen(0.6f, 0.6f));
  EXPECT_FALSE(seen(0.4f, 1.0f));
  material.alpha_cutoff = 0.0f;  // everything is opaque
  EXPECT_TRUE(seen(0.0f, 0.0f));
}

TEST(Resolve, GouraudColorsAreInterpolatedAndMapped) {
  Material material = doubleSided();
  material.diffuse_map.texture = 0;
  Scene scene = rectangleScene(10, 10, -2, material);
  scene.textures = {texture(1, 1, {{kOne, kOne, 0, kOne}})};
  // A second object, so that colours are counted through.
  scene.objects.push_back(scene.objects[0]);
  scene.objects[1].object_to_world = glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, 1.0));
  const std::vector<glm::vec3> colors{{9, 9, 9}, {9, 9, 9}, {9, 9, 9}, {9, 9, 9},
                                      {0, 0, 1}, {1, 0, 1}, {1, 2, 1}, {0, 2, 1}};
  const View view = cameraView(frontCamera(), {20, 20});
  const GBuffer gbuffer =
      rasterize(scene, allObjects(scene), view, Shading::kGouraud, {true, true, false}, colors);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      const glm::dvec3 p = positionAt(gbuffer, x, y);
      EXPECT_EQ(p.z, -1.0);
      const glm::dvec3 expected((p.x + 10.0) / 20.0, (p.y + 10.0) / 10.0, 0.0);
      // The position is off by one rounding of at most 1/20 of the colours' range, the colour by one of up
      // to 2.
      EXPECT_LE(glm::length(glm::dvec3(valueAt(gbuffer.emission, gbuffer, x, y)) - expected),
                4 * kFloatRounding);
      EXPECT_EQ(valueAt(gbuffer.diffuse, gbuffer, x, y), glm::vec3(0.0f));
      EXPECT_EQ(valueAt(gbuffer.ambient, gbuffer, x, y), glm::vec3(0.0f));
      EXPECT_EQ(valueAt(gbuffer.specular, gbuffer, x, y), glm::vec3(0.0f));
    }
}

TEST(Resolve, AnObjectsMaterialReplacesItsTriangles) {
  Scene scene = rectangleScene(10, 10, -2);
  scene.materials.push_back(doubleSided());
  scene.materials[1].diffuse = {0, 0, 1};
  scene.objects[0].material = 1;
  const GBuffer gbuffer = draw(scene, cameraView(frontCamera(), {20, 20}));
  EXPECT_EQ(valueAt(gbuffer.diffuse, gbuffer, 10, 10), glm::vec3(0, 0, 1));
}

TEST(DepthMap, HoldsReversedDepthAndCullsNothing) {
  Material single;
  Scene scene = rectangleScene(1.0f, 1.0f, -2.0f, single);
  for (glm::uvec3& t : scene.meshes[0].triangles) std::swap(t.y, t.z);
  Camera camera = frontCamera();
  camera.near = 0.5;
  camera.far = 100.0;
  camera.fov_y = M_PI / 2;
  const std::vector<ShadowTexel> map = depthOf(scene, cameraView(camera, {40, 30}));
  EXPECT_EQ(map[0].depth, 0.0f);
  EXPECT_EQ(map[0].slopes, 0u);
  // n (f − d) / (d (f − n)) at d = 2, rounded to float.
  const double expected = 0.5 * 98.0 / (2.0 * 99.5);
  EXPECT_NEAR(map[15 * 40 + 20].depth, expected, kFloatRounding * expected);
}

TEST(DepthMap, HoldsTheSurfacesSlopes) {
  // Planes z = −50 + a·x + b·y under a view whose depth falls by 1 / (far − near) a metre.
  const View view = pixelView({24, 18});
  const double depth_a_metre = view.projection[2][2];
  for (const auto& [a, b] : {std::pair(0.0, 0.0), {1.0, 0.0}, {0.0, -2.5}, {-0.3, 0.7}, {-1.9, -0.001}}) {
    std::vector<glm::vec3> corners;
    for (const auto& [x, y] : {std::pair(-20, -20), {20, -20}, {20, 20}, {-20, 20}})
      corners.push_back({x, y, -50 + a * x + b * y});
    for (const ShadowTexel& texel : depthOf(meshScene(corners, {{0, 1, 2}, {0, 2, 3}}), view)) {
      const glm::dvec2 slopes = slopesOf(texel), exact = depth_a_metre * glm::dvec2(a, -b);
      // The corners' z, up to 128, rounds to float, so that over 40 m a slope is off by 128 · 2⁻²⁴ / 20.
      const double corner = depth_a_metre * 128 * kFloatRounding / 20;
      EXPECT_NEAR(slopes.x, exact.x, kSlopeRounding * std::abs(exact.x) + corner) << a << ' ' << b;
      EXPECT_NEAR(slopes.y, exact.y, kSlopeRounding * std::abs(exact.y) + corner) << a << ' ' << b;
    }
  }
}

TEST(DepthMap, PackedSlopesAreTheNearestOfEightPlaces) {
  std::mt19937 random(1);
  const auto unpack = [](std::uint32_t packed) { return slopesOf({0, packed}); };
  EXPECT_EQ(unpack(packSlopes(0.0f, 0.0f)), glm::dvec2(0));
  EXPECT_EQ(unpack(packSlopes(-1.5f, 0x1p-60f)), glm::dvec2(-1.5, 0x1p-60));
  EXPECT_EQ(unpack(packSlopes(1.99999f, -1.99999f)), glm::dvec2(2, -2));  // into the next power of two
  double largest = 0;
  for (int i = 0; i < 100000; ++i) {
    // All steps that the rasterizer makes: up to 10³⁰, both signs.
    const auto any = [&] {
      return std::ldexp(1.0f + float(random() % (1u << 23)) * 0x1p-23f, int(random() % 190) - 91) *
             (random() % 2 ? 1.0f : -1.0f);
    };
    const float dx = any(), dy = any();
    const glm::dvec2 slopes = unpack(packSlopes(dx, dy));
    ASSERT_LE(std::abs(slopes.x - dx), kSlopeRounding * std::abs(dx)) << dx;
    ASSERT_LE(std::abs(slopes.y - dy), kSlopeRounding * std::abs(dy)) << dy;
    largest = std::max(largest, std::abs(slopes.x - dx) / std::abs(dx));
  }
  EXPECT_GT(largest, 0.99 * kSlopeRounding);  // the bound is no wider than it must be
}

TEST(DepthMap, MeshletsThatDontReachTheViewChangeNothing) {
  // A grid of 40·40 cells in many meshlets; the view sees a corner of it.
  constexpr std::uint32_t kCells = 40;
  std::mt19937 random(4);
  std::vector<glm::vec3> positions;
  for (std::uint32_t y = 0; y <= kCells; ++y)
    for (std::uint32_t x = 0; x <= kCells; ++x)
      positions.push_back({float(x), float(y), -50.0f + 0.01f * float(random() % 1000)});
  const Scene scene = meshScene(positions, gridTriangles(kCells));
  const View view = pixelView({17, 13});  // x to 8.5 and y to 6.5
  const Meshlets meshlets = findMeshlets(scene);
  std::vector<std::uint32_t> near;
  for (std::uint32_t i = 0; i < meshlets.items.size(); ++i)
    if (meshlets.items[i].low.x < 9 && meshlets.items[i].low.y < 7) near.push_back(i);
  ASSERT_LT(near.size(), meshlets.items.size() / 2);
  std::vector<ShadowTexel> few(17 * 13);
  rasterizeDepth(scene, meshlets, near, view, {}, few);
  EXPECT_TRUE(std::ranges::equal(few, depthOf(scene, view), sameTexel));
}

}  // namespace
}  // namespace luciole::test
