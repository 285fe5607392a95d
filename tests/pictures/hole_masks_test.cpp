#include "shadow/exact/hole_masks.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "kernels/probe.hpp"
#include "kernels/random_scene.hpp"
#include "kernels/shared.h"
#include "lighting/light_gbuffer.hpp"
#include "raster/opacity.hpp"
#include "shadow/exact/brute_shadows.hpp"

// Masks say what the host would: the shadows are those that it finds when it decides every pair that a
// triangle with holes may hide.
namespace luciole::test {
namespace {

constexpr glm::ivec2 kPictureSize{128, 96};

/// Noise in one channel: white, or in blocks of 4×4 texels.
Texture noise(Random& random, glm::ivec2 size) {
  Texture texture;
  MipLevel level{size.x, size.y, {}};
  level.texels.resize(std::size_t(size.x) * std::size_t(size.y) * 4);
  const int block = random.chance(0.5) ? 1 : 4;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const int place = y * size.x + x, block_place = y / block * block * size.x + x / block * block;
      for (int channel = 0; channel < 4; ++channel)
        level.texels[std::size_t(place) * 4 + std::size_t(channel)] =
            place == block_place ? std::uint16_t(random.below(65536))
                                 : level.texels[std::size_t(block_place) * 4 + std::size_t(channel)];
    }
  texture.levels = {level};
  texture.alpha_varies = random.chance(0.7);
  return texture;
}

void addTriangle(Random& random, const glm::dvec3& middle, double side, double uv_scale, double uv_offset,
                 std::uint32_t material, Mesh& mesh) {
  const auto first = std::uint32_t(mesh.positions.size());
  const glm::dvec2 offset(random.between(-uv_offset, uv_offset), random.between(-uv_offset, uv_offset));
  for (int i = 0; i < 3; ++i) {
    mesh.positions.push_back(glm::vec3(middle + side * random.direction()));
    mesh.normals.push_back({0, 0, 1});
    mesh.uvs.push_back(
        glm::vec2(offset + uv_scale * glm::dvec2(random.between(-1, 1), random.between(-1, 1))));
  }
  mesh.triangles.push_back(glm::uvec3(0, 1, 2) + first);
  mesh.triangle_materials.push_back(material);
}

/// Leaves of every wrap mode before a wall, and lights before the leaves. Some have coordinates far outside
/// [0, 1], or one place all over.
Scene leaves(Random& random) {
  Scene scene;
  scene.materials.resize(1);
  for (const glm::ivec2& size :
       {glm::ivec2(1, 1), glm::ivec2(3, 5), glm::ivec2(7, 2), glm::ivec2(16, 16), glm::ivec2(64, 64)})
    scene.textures.push_back(noise(random, size));
  for (int i = 0; i < 12; ++i) {
    Material material;
    material.alpha = float(random.between(0.8, 1.2));
    material.alpha_cutoff = float(random.between(0.2, 0.7));
    TextureUse use{random.below(5), Wrap(i % 3), Wrap(i / 3 % 3)};
    (scene.textures[std::size_t(use.texture)].alpha_varies ? material.diffuse_map : material.alpha_map) = use;
    scene.materials.push_back(material);
  }
  Mesh mesh;
  for (int i = 0; i < 150; ++i)
    addTriangle(random, {random.between(-4, 4), random.between(-3, 3), random.between(-4.5, -2)},
                random.between(0.05, 0.8),
                random.chance(0.1) ? 0 : std::exp(random.between(std::log(0.05), std::log(8))),
                random.chance(0.2) ? random.between(0, 2000) : 1.5, std::uint32_t(1 + i % 12), mesh);
  scene.meshes = {mesh};
  scene.objects = {{0, glm::dmat4(1), -1}};
  for (int i = 0; i < 8; ++i) {
    Light light;
    light.kind = i % 4 == 0 ? LightKind::kDirectional : LightKind::kPoint;
    light.shadow = true;
    light.position = glm::dvec3(random.between(-4, 4), random.between(-3, 3), random.between(-2, 3));
    light.direction = glm::normalize(glm::dvec3(random.between(-0.4, 0.4), random.between(-0.4, 0.4), -1));
    scene.lights.push_back(light);
  }
  scene.cameras = {Camera{}};
  scene.cameras[0].camera_to_world = glm::dmat4(1);
  return scene;
}

/// A wall at z = −5 that fills the picture.
Scene wall() {
  Scene scene;
  scene.materials.resize(1);
  Mesh mesh;
  mesh.positions = {{-20, -20, -5}, {20, -20, -5}, {20, 20, -5}, {-20, 20, -5}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.triangle_materials = {0, 0};
  scene.meshes = {mesh};
  scene.objects = {{0, glm::dmat4(1), -1}};
  return scene;
}

/// Masks that know nothing.
std::shared_ptr<const HoleMasks> ignorantMasks(const TriangleTree& tree) {
  auto masks = std::make_shared<HoleMasks>();
  masks->texels.assign(1, 0);
  masks->block_bits = tree.block_bits;
  uint count = 0;
  for (const uint bits : tree.block_bits) {
    masks->first_triangle.push_back(count);
    count += uint(std::popcount(bits >> 16));
  }
  masks->triangles.assign(count, HoleTriangle{});
  return masks;
}

struct Shadows {
  std::vector<uint> lit;
  std::uint64_t rays;
};

Shadows shadowsOn(const GBuffer& seen, const Scene& scene, const View& view, const FeatureSet& features,
                  const ShadeSettings& settings, int lanes, bool ignorant) {
  OpenedDevice& device = deviceWithLanes(lanes);
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, scene.cameras[0], view, features, settings, lighting, stats);
  if (ignorant) {
    BeamScene& beams = lighting.beams;
    beams.masks = ignorantMasks(*beams.tree);
    beams.block_bits = borrowed(device, beams.masks->block_bits);
    beams.hole_texels = borrowed(device, beams.masks->texels);
    beams.hole_triangles = borrowed(device, beams.masks->triangles);
    beams.first_hole_triangle = borrowed(device, beams.masks->first_triangle);
  }
  const LitPlanes lit = lightGBuffer(device, scene, lighting, {lighting.lights, features, seen}, stats);
  return {downloadPairs(device, lit.pairs).lit, lit.traced.pairs};
}

TEST(HoleMasks, ChangeNoBitOfWhatTheHostDecides) {
  Random random(77);
  std::uint64_t rays = 0, all_rays = 0;
  int round = 0;
  for (const int lanes : {16, 16, 16, 8, 4, 1}) {
    const Scene scene = leaves(random), seen = wall();
    const View view = cameraView(scene.cameras[0], kPictureSize);
    ShadeSettings settings;
    settings.culling = Culling::kNone;
    settings.shadows = ShadowMethod::kExact;
    const FeatureSet features = neededFeatures(scene, scene.cameras[0], materialTraits(scene), settings);
    ASSERT_TRUE(features.has(Feature::kHoles));
    const GBuffer gbuffer = rasterize(seen, allObjects(seen), view, Shading::kPhong, neededPlanes(features));
    const Shadows quick = shadowsOn(gbuffer, scene, view, features, settings, lanes, false),
                  sure = shadowsOn(gbuffer, scene, view, features, settings, lanes, true);
    ASSERT_EQ(quick.lit.size(), sure.lit.size());
    int different = 0, lit = 0;
    for (std::size_t i = 0; i < sure.lit.size(); ++i) {
      different += std::popcount(quick.lit[i] ^ sure.lit[i]);
      lit += std::popcount(sure.lit[i]);
    }
    EXPECT_EQ(different, 0) << "round " << round;
    EXPECT_GT(lit, 20000) << "round " << round;
    rays += quick.rays;
    all_rays += sure.rays;
    ++round;
  }
  EXPECT_GT(all_rays, 50000u);
  EXPECT_LT(rays, all_rays / 4);
}

// Each ray to a sample looks the texture up where it meets a leaf.
TEST(SoftExact, AgreesWithBruteForceBehindHoles) {
  Random random(78);
  Scene scene = leaves(random);
  const Scene seen = wall();
  for (Light& light : scene.lights) light.radius = light.half_angle = random.chance(0.2) ? 0 : 0.2;
  const glm::ivec2 size{48, 36};
  const View view = cameraView(scene.cameras[0], size);
  ShadeSettings settings;
  settings.culling = Culling::kNone;
  settings.shadows = ShadowMethod::kSoftExact;
  settings.soft_samples = 8;
  const FeatureSet features = neededFeatures(scene, scene.cameras[0], materialTraits(scene), settings);
  const GBuffer gbuffer = rasterize(seen, allObjects(seen), view, Shading::kPhong, neededPlanes(features));
  OpenedDevice& device = deviceWithLanes(16);
  Lighting lighting;
  Stats stats;
  prepareLighting(device, scene, scene.cameras[0], view, features, settings, lighting, stats);
  const LitPlanes lit = lightGBuffer(device, scene, lighting, {lighting.lights, features, gbuffer}, stats);
  const PairWords words = downloadPairs(device, lit.pairs);
  const std::vector<PlacedObject> objects = placeObjects(scene, allObjects(scene), glm::dmat4(1));
  std::size_t asked = 0;
  const HoleTest is_hole = [&](std::uint32_t triangle, const glm::dvec3& weights) {
    ++asked;
    return isHoleAt(scene, objects[0], triangle, weights);
  };
  const std::size_t count = lighting.lights.beam_lights.size();
  std::size_t pairs = 0, part = 0, wrong = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x)
      for (std::uint32_t light = 0; light < count; ++light) {
        const std::size_t place = gbuffer.index(x, y), tile = place / kTilePixels;
        const float share = shareOf(words, tile * count + light, place % kTilePixels);
        const glm::vec3 start = startInTree(lighting.beams, gbuffer, place);
        const BeamLight& beam = lighting.lights.beam_lights[light];
        // Behind the wall no light shines on it.
        if (beam.place.w != 0 && beam.place.z * 1.0f < -5) continue;
        ++pairs;
        part += share > 0 && share < 1;
        wrong += share != shareSeen(lighting, start, light, is_hole);
      }
  EXPECT_EQ(wrong, 0u) << "of " << pairs << " pairs";
  EXPECT_GT(part, pairs / 10);
  EXPECT_GT(asked, pairs);
}

}  // namespace
}  // namespace luciole::test
