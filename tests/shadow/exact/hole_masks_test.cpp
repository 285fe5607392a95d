#include "shadow/exact/hole_masks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "raster/opacity.hpp"
#include "shadow/exact/loose_triangles.hpp"

namespace luciole::test {
namespace {

constexpr Triangle kTriangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};

Texture texture(int width, int height, const std::function<std::uint16_t(int place, int channel)>& code) {
  MipLevel level{width, height, {}};
  for (int i = 0; i < width * height; ++i)
    for (int channel = 0; channel < 4; ++channel) level.texels.push_back(code(i, channel));
  Texture result;
  result.levels = {level};
  result.alpha_varies = true;
  return result;
}

/// A triangle with holes, whose texture repeats over two units.
Scene hollowScene(const Texture& diffuse) {
  Scene scene = looseScene({kTriangle}, 1);
  scene.meshes[0].uvs = {{0, 0}, {2, 0}, {0, 2}};
  scene.textures = {diffuse};
  scene.materials[1].diffuse_map.texture = 0;
  return scene;
}

Texture halfOpaque() {
  return texture(2, 1, [](int place, int) { return std::uint16_t(place == 0 ? 65535 : 0); });
}

HoleMasks masksOf(const Scene& scene) {
  return makeHoleMasks(scene, buildTriangleTree(scene, glm::dvec3(0)));
}

/// Whether the masks leave all to the host.
bool isLeftToTheHost(const HoleMasks& masks) {
  return masks.block_bits[0] == 0x10001 && masks.triangles.size() == 1 && masks.triangles[0].width == 0;
}

TEST(HoleMasks, TrianglesWithoutHolesAnywhereAreSolidAndThoseOfNothingElseGone) {
  const auto bits = [](std::uint16_t alpha) {
    return masksOf(hollowScene(texture(3, 2, [&](int, int) { return alpha; }))).block_bits[0];
  };
  EXPECT_EQ(bits(65535), 1u);
  EXPECT_EQ(bits(40000), 1u);
  EXPECT_EQ(bits(20000), 0u);
  EXPECT_EQ(bits(0), 0u);
  EXPECT_EQ(bits(32768), 0x10001u) << "too near the cutoff";
  Scene scene = looseScene({kTriangle}, 1);
  EXPECT_EQ(masksOf(scene).block_bits[0], 1u);
  scene.materials[1].alpha = 0.25f;
  EXPECT_EQ(masksOf(scene).block_bits[0], 0u);
  EXPECT_EQ(masksOf(hollowScene(halfOpaque())).block_bits[0], 0x10001u);
}

TEST(HoleMasks, TwoTexturesAndColorsWithAlphaAreLeftToTheHost) {
  Scene scene = hollowScene(halfOpaque());
  EXPECT_FALSE(isLeftToTheHost(masksOf(scene)));
  scene.meshes[0].colors.assign(3, glm::vec4(0.5f, 0.5f, 0.5f, 1));
  EXPECT_FALSE(isLeftToTheHost(masksOf(scene)));
  scene.meshes[0].colors[1].a = 0.5f;
  EXPECT_TRUE(isLeftToTheHost(masksOf(scene)));
  scene.meshes[0].colors.clear();
  scene.materials[1].alpha_map.texture = 0;
  EXPECT_TRUE(isLeftToTheHost(masksOf(scene)));
}

TEST(HoleMasks, TexelsThatAreNotMixedAreLeftToTheHost) {
  Scene scene = hollowScene(halfOpaque());
  scene.materials[1].diffuse_map.nearest_minified = true;
  EXPECT_FALSE(isLeftToTheHost(masksOf(scene))) << "shadows look at the finest level";
  scene.materials[1].diffuse_map.nearest_magnified = true;
  EXPECT_TRUE(isLeftToTheHost(masksOf(scene)));
}

TEST(HoleMasks, CoordinatesThatAreHugeOrNoNumbersAreLeftToTheHost) {
  Scene scene = hollowScene(halfOpaque());
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float bad : {NAN, kInfinity, -kInfinity, 1e9f, 1e38f, 40000.0f})
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 2; ++axis) {
        Scene other = scene;
        other.meshes[0].uvs[corner][axis] = bad;
        other.textures[0] =
            texture(2, 2, [](int place, int) { return std::uint16_t(place % 2 ? 65535 : 0); });
        EXPECT_TRUE(isLeftToTheHost(masksOf(other))) << bad << ", " << corner << ", " << axis;
      }
}

// Of every code, through alpha and through the colour of a grey map.
TEST(HoleMasks, ValuesBeyondTheThresholdsAreJudgedAsALookupIs) {
  for (const bool grey : {false, true})
    for (const float alpha : {1.0f, 0.75f, 2.5f})
      for (const float cutoff : {0.02f, 0.5f, 0.7f}) {
        Scene scene = hollowScene(texture(256, 256, [](int place, int) { return std::uint16_t(place); }));
        Material& material = scene.materials[1];
        if (grey) {
          scene.textures[0].alpha_varies = false;
          std::swap(material.alpha_map, material.diffuse_map);
        }
        material.alpha = alpha;
        material.alpha_cutoff = cutoff;
        const HoleMasks masks = masksOf(scene);
        ASSERT_EQ(masks.triangles.size(), 1u);
        const HoleTriangle& triangle = masks.triangles[0];
        const std::vector<PlacedObject> objects = placeObjects(scene, allObjects(scene), glm::dmat4(1));
        int judged = 0, wrong = 0;
        for (int code = 0; code < 65536; ++code) {
          const int column = code % 256, row = code / 256;
          const double u = (column + 0.5) / 512, v = (row + 0.5) / 512;
          const bool is_hole = isHoleAt(scene, objects[0], 0, {1 - u - v, u, v});
          const float value = masks.texels[std::size_t(code)];
          judged += value >= triangle.solid_from || value <= triangle.hole_to;
          wrong += (value >= triangle.solid_from && is_hole) || (value <= triangle.hole_to && !is_hole);
        }
        EXPECT_EQ(wrong, 0) << grey << ", " << alpha << ", " << cutoff;
        EXPECT_GT(judged, 60000) << grey << ", " << alpha << ", " << cutoff;
      }
}

}  // namespace
}  // namespace luciole::test
