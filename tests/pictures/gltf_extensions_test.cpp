// What extensions of glTF change in a picture, on the device and in the reference.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "pictures/shot.hpp"
#include "scene/gltf/gltf_file.hpp"

namespace luciole::test {
namespace {

/// A square from −1 to 1 in the xy plane, seen head on so that it fills a square picture, in bright light and
/// ambient. Texture coordinates are 0 to 1 from the top left corner, those of the second set half as large.
class GltfExtensions : public testing::Test {
 protected:
  GltfExtensions() {
    file.root["meshes"] = {
        {{"primitives",
          {{{"attributes",
             {{"POSITION",
               file.addAccessor<float>("VEC3", kFloat, 3, {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0})},
              {"TEXCOORD_0", file.addAccessor<float>("VEC2", kFloat, 2, {0, 1, 1, 1, 1, 0, 0, 0})},
              {"TEXCOORD_1", file.addAccessor<float>("VEC2", kFloat, 2, {0, 0.5, 0.5, 0.5, 0.5, 0, 0, 0})}}},
            {"indices", file.addAccessor<std::uint8_t>("SCALAR", kUnsignedByte, 1, {0, 1, 2, 0, 2, 3})},
            {"material", 0}}}}}};
    file.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33071}}};
    file.root["images"] = {{{"uri", "quadrants.exr"}}};
    // Four colours, each of 32 x 32 texels, so that the middle of a quarter picture is far from any edge.
    Image quadrants{64, 64, {"R", "G", "B"}, {}};
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        for (const float value : colors[std::size_t(x / 32 + y / 32 * 2)]) quadrants.pixels.push_back(value);
    writeImage(quadrants, folder / "quadrants.exr", {});
  }

  json& material() { return file.root["materials"][0]; }
  json& base() { return material()["pbrMetallicRoughness"]["baseColorTexture"]; }

  /// `members`: of the scene, beside.
  Shot shoot(const std::string& members = "") {
    file.root["buffers"] = {{{"byteLength", file.data.size()}, {"uri", "data.bin"}}};
    std::ofstream(folder / "data.bin", std::ios::binary) << file.data;
    std::ofstream(folder / "a.gltf") << file.root.dump();
    std::ofstream(folder / "scene.json")
        << R"({"camera": {"eye": [0,0,4], "target": [0,0,0], "orthographic": 1},
        "ambient": 0.5, "objects": [{"mesh": "a.gltf"}],
        "lights": [{"type": "directional", "direction": [0,0,-1]}])"
        << members << "}";
    return test::shoot(loadScene(folder / "scene.json"), {32, 32});
  }

  /// Black, and the colours of the picture's left and right upper, and left and right lower quarter. 0 and 1
  /// have codes of their own, so they are kept exactly.
  const std::vector<std::vector<float>> colors{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}};
  const TemporaryFolder folder;
  GltfFile file;
};

glm::vec3 vectorOf(const std::vector<float>& color) { return {color[0], color[1], color[2]}; }

TEST_F(GltfExtensions, UnlitShowsItsColourToTheBitWhateverTheLight) {
  material() = {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.75, 1}}}},
                {"emissiveFactor", {1, 1, 1}},
                {"extensions", {{"KHR_materials_unlit", json::object()}}}};
  const Shot shot = shoot();
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) ASSERT_EQ(colorAt(shot.image, x, y), glm::vec3(0.5f, 0.25f, 0.75f));
  const Image reference = referenceShade(shot.scene, shot.gbuffer, {});
  EXPECT_EQ(colorAt(reference, 16, 16), glm::vec3(0.5f, 0.25f, 0.75f));
}

TEST_F(GltfExtensions, UnlitIsMultipliedByVertexColoursAndItsTexture) {
  file.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      file.addAccessor<float>("VEC3", kFloat, 3, {0.5, 0.25, 1, 0.5, 0.25, 1, 0.5, 0.25, 1, 0.5, 0.25, 1});
  base()["index"] = 0;
  material()["extensions"]["KHR_materials_unlit"] = json::object();
  const Shot shot = shoot();
  const glm::vec3 tint(0.5f, 0.25f, 1);
  // Shares of corners with the same colour add up to 1 but for 2 roundings of float.
  for (const int quarter : {0, 1, 2, 3})
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(colorAt(shot.image, 8 + quarter % 2 * 16, 8 + quarter / 2 * 16)[c],
                  colors[std::size_t(quarter)][std::size_t(c)] * tint[c], 0x1p-22)
          << quarter;
  expectAsTheReference(shot);
  // What a G-buffer file would hold.
  EXPECT_EQ(shot.gbuffer.diffuse[shot.gbuffer.index(8, 8)], 0.0f);
}

TEST_F(GltfExtensions, UnlitIsFoggedAsAllElse) {
  material() = {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.75, 1}}}},
                {"extensions", {{"KHR_materials_unlit", json::object()}}}};
  const Shot shot = shoot(R"(, "fog": {"mode": "exp", "density": 0.25, "color": [1, 0, 0]})");
  expectAsTheReference(shot);
  // At 4 m. The kernel's exponential and the mix lose some 2^-20, see kernels/math.clh.
  EXPECT_NEAR(colorAt(shot.image, 16, 16).y, 0.25 * std::exp(-1.0), 1e-6);
}

TEST_F(GltfExtensions, GouraudShadedUnlitIsTheSame) {
  base()["index"] = 0;
  material()["extensions"]["KHR_materials_unlit"] = json::object();
  const Shot phong = shoot();
  const Shot gouraud = test::shoot(phong.scene, {32, 32},
                                   [](RenderSettings& settings) { settings.shading = Shading::kGouraud; });
  EXPECT_EQ(gouraud.image.pixels, phong.image.pixels);
}

TEST_F(GltfExtensions, ATransformShowsAnotherPartOfTheTexture) {
  base() = {{"index", 0}};
  material()["extensions"]["KHR_materials_unlit"] = json::object();
  // The specification's example: the lower left quadrant.
  base()["extensions"]["KHR_texture_transform"] = {
      {"offset", {0, 1}}, {"rotation", kPi / 2}, {"scale", {0.5, 0.5}}};
  Shot shot = shoot();
  for (const int at : {8, 24}) EXPECT_EQ(colorAt(shot.image, at, at), vectorOf(colors[2]));
  // A quarter turn alone, moved back into the picture: left becomes bottom.
  base()["extensions"]["KHR_texture_transform"] = {{"offset", {0, 1}}, {"rotation", kPi / 2}};
  shot = shoot();
  EXPECT_EQ(colorAt(shot.image, 8, 8), vectorOf(colors[2]));
  EXPECT_EQ(colorAt(shot.image, 24, 8), vectorOf(colors[0]));
  EXPECT_EQ(colorAt(shot.image, 8, 24), vectorOf(colors[3]));
  EXPECT_EQ(colorAt(shot.image, 24, 24), vectorOf(colors[1]));
}

TEST_F(GltfExtensions, ColourAndGlowAreLookedUpApart) {
  base() = {{"index", 0}};
  material()["pbrMetallicRoughness"]["metallicFactor"] = 0;
  material()["emissiveFactor"] = {1, 1, 1};
  material()["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
  material()["emissiveTexture"]["extensions"]["KHR_texture_transform"]["offset"] = {0.5, 0.5};
  const Shot shot = shoot();
  expectAsTheReference(shot);
  const std::size_t stride = shot.gbuffer.pixels();
  for (const int quarter : {0, 1, 2, 3}) {
    const std::size_t place = shot.gbuffer.index(8 + quarter % 2 * 16, 8 + quarter / 2 * 16);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(shot.gbuffer.diffuse[place + c * stride], colors[std::size_t(quarter)][c]);
      EXPECT_EQ(shot.gbuffer.emission[place + c * stride], colors[3][c]) << "the lower right quarter is all";
    }
  }
}

}  // namespace
}  // namespace luciole::test
